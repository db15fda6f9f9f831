// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/scale_of_map.h"

#include "plumbline/base/median.h"
#include "plumbline/geometry/plucker.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

// Returns the factor by which depths have changed, as the median over points; nullopt if there are
// too few of them.
std::optional<double> ScaleAround(const std::vector<std::pair<double, double>>& depths) {
  constexpr std::size_t kFew = 10;
  std::vector<double> ratios;
  for (const auto& [before, after] : depths) {
    if (before > 0 && after > 0) ratios.push_back(after / before);
  }
  if (ratios.size() < kFew) return std::nullopt;
  return UpperMedian(ratios);
}

// Scales all lengths of a solution about the fixed point `centre`.
void ScaleAbout(const Eigen::Vector3d& centre, double scale, BaResult& result) {
  for (Rigid3& pose : result.poses) {
    pose.translation = scale * pose.translation + (scale - 1) * (pose.rotation * centre);
  }
  for (Eigen::Vector3d& point : result.points) point = scale * point + (1 - scale) * centre;
  for (OrthonormalLine& line : result.lines) {
    PluckerLine scaled = ToPlucker(line);
    scaled.moment = scale * scaled.moment + (1 - scale) * centre.cross(scaled.direction);
    line = ToOrthonormal(scaled);
  }
  for (Segment3& ends : result.line_ends) {
    ends.start = scale * ends.start + (1 - scale) * centre;
    ends.end = scale * ends.end + (1 - scale) * centre;
  }
}

void Move(const Rigid3& new_from_old, BaResult& result) {
  const Rigid3 old_from_new = Inverse(new_from_old);
  for (Rigid3& pose : result.poses) pose = pose * old_from_new;
  for (Eigen::Vector3d& point : result.points) point = new_from_old * point;
  for (OrthonormalLine& line : result.lines) {
    line = ToOrthonormal(Transform(new_from_old, ToPlucker(line)));
  }
  for (Segment3& ends : result.line_ends) {
    ends = {new_from_old * ends.start, new_from_old * ends.end};
  }
}

}  // namespace

std::vector<double> ScalesOf(const BaProblem& problem, const BaResult& result) {
  std::vector<double> scales(problem.poses.size(), 1);
  if (problem.camera.baseline > 0) return scales;
  std::vector<std::vector<std::pair<double, double>>> depths(problem.poses.size());
  for (const auto& o : problem.point_observations) {
    const auto pose = static_cast<std::size_t>(o.pose);
    const auto point = static_cast<std::size_t>(o.point);
    depths[pose].emplace_back((problem.poses[pose].cam_from_world * problem.points[point]).z(),
                              (result.poses[pose] * result.points[point]).z());
  }
  std::optional<double> last;
  for (std::size_t k = 0; k < scales.size() && !last; ++k) last = ScaleAround(depths[k]);
  for (std::size_t k = 0; k < scales.size() && last; ++k) {
    scales[k] = ScaleAround(depths[k]).value_or(*last);
    last = scales[k];
  }
  return scales;
}

void FixScaleToOldestKeyFrame(const BaProblem& problem, BaResult& result) {
  if (problem.poses.empty() || problem.camera.baseline > 0) return;
  const auto fixed = std::count_if(
      problem.poses.begin(), problem.poses.end(), [](const auto& pose) { return pose.fixed; });
  if (fixed > 1) return;
  const Eigen::Vector3d centre = Inverse(problem.poses.front().cam_from_world).translation;
  ScaleAbout(centre, 1 / ScalesOf(problem, result).front(), result);
}

void KeepPlaceOf(std::size_t pose, const BaProblem& problem, BaResult& result) {
  if (problem.camera.baseline > 0) return;
  const double scale = 1 / ScalesOf(problem, result)[pose];
  Move(Inverse(problem.poses[pose].cam_from_world) * result.poses[pose], result);
  ScaleAbout(Inverse(result.poses[pose]).translation, scale, result);
}

}  // namespace plumbline
