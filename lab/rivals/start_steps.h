// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/initial_map.h"
#include "plumbline/initialization/matching.h"
#include "plumbline/solvers/ray_match.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {

// Steps that the starts of the laboratory have in common.

// Returns the median angle [radians] between R x_a and x_b over the matches, with R = b_from_a: the
// parallax, if R is right. Returns 0 without matches.
double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a);

// Returns the largest angle that `count` of the matches have, or the smallest of all where there
// are fewer.
double ParallaxOf(std::size_t count,
                  std::span<const RayMatch> matches,
                  const Eigen::Quaterniond& b_from_a);

// Returns the matches as rays, for two-view solvers, in order.
std::vector<RayMatch> RayMatchesOf(const RectifiedCamera& camera,
                                   const Features& a,
                                   const Features& b,
                                   std::span<const FeatureMatch> matches);

// Calls TriangulateMap and AdjustMap; returns nullopt if fewer than `min_points` points remain.
std::optional<InitialMap> TriangulateAndAdjustMap(const RectifiedCamera& camera,
                                                  std::vector<InitialView> views,
                                                  std::span<const FeatureTrack> point_tracks,
                                                  std::span<const FeatureTrack> line_tracks,
                                                  std::size_t min_points);

}  // namespace plumbline
