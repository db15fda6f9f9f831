// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/match_lines.h"
#include "plumbline/matching/line_options.h"

#include <optional>

#include <Eigen/Geometry>

namespace plumbline {

// Returns the conditions for matching lines of two images by descriptors (MatchLines), including
// the rules of the first paper, section 4, if `lines` asks for them.
//
//   b_from_a  rotation between the two cameras, if known; the rotation gate uses its angle
LineMatchOptions LineMatchingOf(const LineOptions& lines,
                                const std::optional<Eigen::Quaterniond>& b_from_a = std::nullopt);

}  // namespace plumbline
