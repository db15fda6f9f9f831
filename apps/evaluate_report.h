// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/trajectory_error.h"

#include "apps/reference_trajectory.h"
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// A comparison and its inputs.
struct Evaluation {
  std::string estimate;  // as given
  std::string name;      // name in tables and figures of several estimates
  ReferenceTrajectory reference;
  std::int64_t offset_ns = 0;             // added to the stamps of the estimate
  std::optional<std::string> aligned_by;  // the trajectory whose alignment was used
  // True if the scale of the estimate is arbitrary, and not changed by the alignment.
  bool unit_is_free = false;
  TrajectoryErrorOptions options;
  TrajectoryError error;
  // Images given to the run; nullopt if unknown.
  std::optional<std::size_t> frames_delivered;
};

// A small table for people, with units.
std::string EvaluationTable(const Evaluation& evaluation);

// Returns an evaluation as JSON. Keys: alignment, aligned_by, association, time_offset_s, window,
// frames_delivered, frames_with_pose, frames_compared, coverage, scale, scale_drift, degenerate,
// ate_m, rpe_m_per_s, roe_deg_per_s. The three errors are {count, rmse, mean, median, max, std,
// p75, p95}, or null if there is nothing to compare. Shares are in [0, 1].
std::string EvaluationJson(const Evaluation& evaluation);

// Tables of several estimates: one for each error, with a row for each estimate. The JSON is
// {"estimates": [...]}, each in the form of EvaluationJson after "estimate" and "name".
std::string EvaluationsTable(const std::vector<Evaluation>& evaluations);
std::string EvaluationsJson(const std::vector<Evaluation>& evaluations);

}  // namespace plumbline
