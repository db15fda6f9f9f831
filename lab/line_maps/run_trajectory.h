// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/trajectory_error.h"

#include <filesystem>
#include <optional>

namespace plumbline {

// Compares the final trajectory of a run with the ground truth of its sequence, aligned as in the
// run's own summary: with one camera with a free scale. nullopt without ground truth, or if the run
// has no pose. Throws InputError if a file cannot be read.
std::optional<TrajectoryError> CompareRunWithTruth(const std::filesystem::path& sequence,
                                                   const std::filesystem::path& run);

}  // namespace plumbline
