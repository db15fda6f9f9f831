// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/trajectory_error.h"

#include <filesystem>
#include <optional>

namespace plumbline {

// The final trajectory of a run beside the ground truth of its sequence, aligned as the run's own
// summary has it: with one camera with a free scale. nullopt without ground truth, or where the run
// has no pose. Throws InputError when a file cannot be read.
std::optional<TrajectoryError> CompareRunWithTruth(const std::filesystem::path& sequence,
                                                   const std::filesystem::path& run);

}  // namespace plumbline
