// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/trajectory_error.h"

#include "apps/reference_trajectory.h"
#include <cstddef>
#include <optional>
#include <string>

namespace plumbline {

// A comparison and what it was made of.
struct Evaluation {
  ReferenceTrajectory reference;
  TrajectoryErrorOptions options;
  TrajectoryError error;
  // Images that the run was given; nullopt where nothing beside the trajectories tells.
  std::optional<std::size_t> frames_delivered;
};

// A small table for people, with units.
std::string EvaluationTable(const Evaluation& evaluation);

// The same for programs. Keys: alignment, association, window, frames_delivered, frames_with_pose,
// frames_compared, coverage, scale, degenerate, ate_m, rpe_m_per_s, roe_deg_per_s; the last three
// are {count, rmse, mean, median, max}, or null where there is nothing to compare.
std::string EvaluationJson(const Evaluation& evaluation);

}  // namespace plumbline
