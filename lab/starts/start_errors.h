// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_record.h"
#include "lab/starts/true_depth.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/initialization/initializer.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Limits of the errors of a map, and its least parallax.
struct StartLimits {
  double rotation_deg = 0.5;
  double direction_deg = 5;
  double depth = 0.1;       // relative inverse depth, median
  double parallax_deg = 0;  // true, median; a map with less is wrong whatever its errors
};

// Returns the median angle between the rays of two cameras to the same points, degrees, over the
// points visible in both; 0 if the second one sees less than a tenth of them, or less than ten.
//
//   points     in the frame of camera a
//   camera     that of both
double MedianParallaxDeg(const std::vector<Eigen::Vector3d>& points,
                         const Rigid3& b_from_a,
                         const RectifiedCamera& camera);

// Compares a map with the true motion of its newest view relative to its first one, and with the
// true depths at the first.
//
//   true_newest_from_first  nullopt: unknown. Without translation no direction is right (180)
//   depth                   of the first view; nullptr: unknown
//
// Depths are compared if at least ten points have a true one.
StartErrors CompareInitialMap(const InitialMap& map,
                              const std::optional<Rigid3>& true_newest_from_first,
                              const TrueDepth* depth,
                              const RectifiedCamera& camera);

// Returns the names of exceeded limits: "rotation direction depth parallax"; empty: the map is
// right, as far as the truth is known.
std::string ExceededLimits(const StartMap& map, const StartLimits& limits);

}  // namespace plumbline
