// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/problem.h"

#include "plumbline/base/error.h"
#include "plumbline/base/ids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

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

namespace {

// Which poses show each landmark, and which landmarks each pose shows. A pose that shows a landmark
// twice is there twice.
struct Sightings {
  Sightings(std::size_t landmarks, std::size_t poses) : poses_of(landmarks), landmarks_of(poses) {}

  void Add(int landmark, int pose) {
    poses_of[Index(landmark)].push_back(pose);
    landmarks_of[Index(pose)].push_back(landmark);
  }

  std::vector<std::vector<int>> poses_of, landmarks_of;
};

}  // namespace

std::vector<std::vector<int>> SharingPoses(const BaProblem& problem, const StopCheck& stop) {
  const std::size_t poses = problem.poses.size();
  Sightings points(problem.points.size(), poses), lines(problem.lines.size(), poses);
  for (const auto& o : problem.point_observations) points.Add(o.point, o.pose);
  for (const auto& o : problem.line_observations) lines.Add(o.line, o.pose);
  std::vector<std::vector<int>> pattern(poses);
  std::vector<int> known_by(poses, -1);  // the last pose in whose row each pose is
  for (int pose = 0; pose < static_cast<int>(poses) && !IsToStop(stop); ++pose) {
    std::vector<int>& earlier = pattern[Index(pose)];
    for (const Sightings* sightings : {&points, &lines}) {
      for (const int landmark : sightings->landmarks_of[Index(pose)]) {
        for (const int other : sightings->poses_of[Index(landmark)]) {
          if (other >= pose || known_by[Index(other)] == pose) continue;
          known_by[Index(other)] = pose;
          earlier.push_back(other);
        }
      }
    }
    std::sort(earlier.begin(), earlier.end());
  }
  return pattern;
}

BaResult InitialState(const BaProblem& problem) {
  BaResult state;
  for (const auto& pose : problem.poses) state.poses.push_back(pose.cam_from_world);
  state.points = problem.points;
  state.lines = problem.lines;
  state.line_ends = problem.line_ends;
  state.point_inliers.assign(problem.point_observations.size(), true);
  state.line_inliers.assign(problem.line_observations.size(), true);
  return state;
}

BaResult NotFinite(const BaProblem& problem) {
  BaResult result = InitialState(problem);
  result.point_inliers.assign(problem.point_observations.size(), false);
  result.line_inliers.assign(problem.line_observations.size(), false);
  const double infinite = std::numeric_limits<double>::infinity();
  result.point_chi2.assign(problem.point_observations.size(), infinite);
  result.line_chi2.assign(problem.line_observations.size(), infinite);
  result.termination = BaTermination::kNotFinite;
  return result;
}

void TakePosesAndPoints(const BaResult& solved, BaProblem& problem) {
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    problem.poses[i].cam_from_world = solved.poses[i];
  }
  problem.points = solved.points;
}

}  // namespace plumbline
