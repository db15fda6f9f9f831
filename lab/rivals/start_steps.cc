// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/start_steps.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/ids.h"
#include "plumbline/base/statistics.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {

namespace {

std::vector<double> Parallaxes(std::span<const RayMatch> matches,
                               const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles;
  angles.reserve(matches.size());
  for (const RayMatch& match : matches) {
    const Eigen::Vector3d q = b_from_a * match.a.homogeneous();
    const Eigen::Vector3d b = match.b.homogeneous();
    angles.push_back(math::Atan2(q.cross(b).norm(), q.dot(b)));
  }
  return angles;
}

}  // namespace

double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a) {
  return UpperMedian(Parallaxes(matches, b_from_a));
}

double ParallaxOf(std::size_t count,
                  std::span<const RayMatch> matches,
                  const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles = Parallaxes(matches, b_from_a);
  if (angles.empty() || count == 0) return 0;
  const std::size_t rank = std::min(count, angles.size()) - 1;
  std::nth_element(angles.begin(),
                   angles.begin() + static_cast<std::ptrdiff_t>(rank),
                   angles.end(),
                   std::greater<>());
  return angles[rank];
}

std::vector<RayMatch> RayMatchesOf(const RectifiedCamera& camera,
                                   const Features& a,
                                   const Features& b,
                                   std::span<const FeatureMatch> matches) {
  const double focal = 0.5 * (camera.fx + camera.fy);
  std::vector<RayMatch> rays;
  rays.reserve(matches.size());
  for (const FeatureMatch& match : matches) {
    const PointFeature& in_a = a.points[Index(match.a)];
    const PointFeature& in_b = b.points[Index(match.b)];
    rays.push_back({camera.Unproject(in_a.px).head<2>(),
                    camera.Unproject(in_b.px).head<2>(),
                    in_a.sigma_px / focal,
                    in_b.sigma_px / focal});
  }
  return rays;
}

std::optional<InitialMap> TriangulateAndAdjustMap(const RectifiedCamera& camera,
                                                  std::vector<InitialView> views,
                                                  std::span<const FeatureTrack> point_tracks,
                                                  std::span<const FeatureTrack> line_tracks,
                                                  std::size_t min_points) {
  InitialMap map = TriangulateMap(camera, std::move(views), point_tracks, line_tracks);
  if (map.points.size() < min_points) return std::nullopt;
  AdjustMap(camera, map);
  if (map.points.size() < min_points) return std::nullopt;
  return map;
}

}  // namespace plumbline
