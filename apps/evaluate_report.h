// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/line_map_error.h"
#include "plumbline/eval/trajectory_error.h"

#include "apps/reference_trajectory.h"
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace plumbline {

// Where the estimated lines are put.
enum class LineAlignment {
  kTrajectory,  // by the alignment of the trajectory
  kPoses,       // and then turned and moved for the poses to agree, AlignPoses
};
constexpr auto EnumNames(std::type_identity<LineAlignment>) {
  return std::array{std::pair{LineAlignment::kTrajectory, "trajectory"},
                    std::pair{LineAlignment::kPoses, "poses"}};
}

// A comparison and what it was made of.
struct Evaluation {
  ReferenceTrajectory reference;
  TrajectoryErrorOptions options;
  TrajectoryError error;
  // Images that the run was given; nullopt where nothing beside the trajectories tells.
  std::optional<std::size_t> frames_delivered;
  LineAlignment line_alignment = LineAlignment::kPoses;
  LineMapErrorOptions line_options;
  std::optional<LineMapError> lines;  // nullopt where no lines were compared
};

// A small table for people, with units.
std::string EvaluationTable(const Evaluation& evaluation);

// The same for programs. Keys: alignment, association, window, frames_delivered, frames_with_pose,
// frames_compared, coverage, scale, degenerate, ate_m, rpe_m_per_s, roe_deg_per_s, line_map. The
// three errors are {count, rmse, mean, median, max}, or null where there is nothing to compare;
// line_map is null without lines. Shares are in [0, 1].
std::string EvaluationJson(const Evaluation& evaluation);

}  // namespace plumbline
