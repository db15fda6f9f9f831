// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/metrics.h"

#include <filesystem>
#include <span>
#include <string>

namespace plumbline {

// Adds the shares of errors within their 90 % intervals of a run (metrics inside_*): of each kind
// (ConsistencyKind), and the least and largest of a class with at least 200 samples. Features are
// held against true poses in rendered worlds, against the run's own in recordings, whose truth is
// not known to a tenth of a pixel. If that is impossible, the reasons.
void AddConsistencyFigures(const std::filesystem::path& sequence,
                           const std::filesystem::path& run,
                           RunFigures& figures);

// Returns true if one of these metrics is one of AddConsistencyFigures.
bool AsksForConsistency(std::span<const std::string> metrics);

}  // namespace plumbline
