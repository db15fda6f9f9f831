// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/landmarks.h"

#include <cstddef>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// The point that feature i of one stereo or RGB-D frame shows, in the world. nullopt without
// disparity, or when the depth is known to worse than max_relative_sigma (standard deviation /
// depth).
std::optional<PointModel> PointFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i,
                                         double max_relative_sigma);

// Covariance, in the world, of the place of PointFromFrame: what the deviations of the pixel and of
// the disparity leave open with the pose taken as known. The feature must have a disparity.
Eigen::Matrix3d PointCovarianceFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i);

// The line that line feature i of one stereo or RGB-D frame shows, in the world, with its
// information. nullopt without right line, when it runs along the rows (no depth), or when the
// depth of an end is known to worse than max_relative_sigma.
std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma);

// The disparity of the scene that a stereo or RGB-D frame shows: the median of its points and ends
// of lines, with half of it as deviation. nullopt where none was measured.
std::optional<Disparity> SceneDisparity(const Frame& frame);

// The line that line feature i shows if it is about as far away as the scene: a line along the rows
// or far away, or one that the right image does not show, has no depth of its own, but says as much
// as any other about the rotation of a camera that moves little against that depth. What was
// measured of its disparities and `scene` are averaged by their variances; both are in the
// information.
LineModel LineAtSceneDepth(const RectifiedCamera& camera,
                           const Frame& frame,
                           std::size_t i,
                           const Disparity& scene);

}  // namespace plumbline
