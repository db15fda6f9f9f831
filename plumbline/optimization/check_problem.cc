// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/check_problem.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

bool IsFinite(const Rigid3& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

bool IsFinite(const PointMeasurement& m) {
  const bool disparity =
      !m.disparity || (std::isfinite(m.disparity->px) && std::isfinite(m.disparity->sigma_px));
  return disparity && m.px.allFinite() && std::isfinite(m.sigma_px);
}

bool IsFinite(const LineMeasurement& m) {
  return m.segment.start.allFinite() && m.segment.end.allFinite() && m.covariance.allFinite();
}

void CheckIndices(int pose, int landmark, std::size_t poses, std::size_t landmarks) {
  PLUMBLINE_CHECK(pose >= 0 && static_cast<std::size_t>(pose) < poses,
                  "pose index of an observation out of range");
  PLUMBLINE_CHECK(landmark >= 0 && static_cast<std::size_t>(landmark) < landmarks,
                  "landmark index of an observation out of range");
}

}  // namespace

void CheckIndices(const BaProblem& problem) {
  PLUMBLINE_CHECK(problem.line_ends.empty() || problem.line_ends.size() == problem.lines.size(),
                  "ends for all lines or for none");
  for (const auto& o : problem.point_observations) {
    CheckIndices(o.pose, o.point, problem.poses.size(), problem.points.size());
  }
  for (const auto& o : problem.line_observations) {
    CheckIndices(o.pose, o.line, problem.poses.size(), problem.lines.size());
  }
  for (const auto& o : problem.parallel_lines) {
    CheckIndices(o.axis, o.line, problem.axes.size(), problem.lines.size());
    PLUMBLINE_CHECK(o.sigma > 0, "sigma of a parallel line must be positive");
  }
}

bool IsFinite(const BaProblem& problem) {
  const auto all = [](const auto& items, auto&& finite) {
    return std::all_of(items.begin(), items.end(), finite);
  };
  return all(problem.poses, [](const auto& x) { return IsFinite(x.cam_from_world); }) &&
         all(problem.points, [](const auto& x) { return x.allFinite(); }) &&
         all(problem.lines,
             [](const auto& x) { return x.U.coeffs().allFinite() && x.w.allFinite(); }) &&
         all(problem.line_ends,
             [](const auto& x) { return x.start.allFinite() && x.end.allFinite(); }) &&
         all(problem.point_observations, [](const auto& x) { return IsFinite(x.measurement); }) &&
         all(problem.line_observations, [](const auto& x) { return IsFinite(x.measurement); }) &&
         all(problem.axes, [](const auto& x) { return x.allFinite(); }) &&
         all(problem.parallel_lines, [](const auto& x) { return std::isfinite(x.sigma); });
}

}  // namespace plumbline
