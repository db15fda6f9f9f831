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

// Returns the point, in the world, that feature i of one stereo or RGB-D frame shows. Returns
// nullopt without disparity, or when the depth is known to worse than max_relative_sigma (standard
// deviation / depth).
std::optional<PointModel> PointFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i,
                                         double max_relative_sigma);

// Returns the covariance, in the world, of the place of PointFromFrame. It comes from the
// deviations of the pixel and of the disparity; the pose counts as exact. The feature must have a
// disparity.
Eigen::Matrix3d PointCovarianceFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i);

// Returns the line, in the world and with its information, that line feature i of one stereo or
// RGB-D frame shows. Returns nullopt where the line was not found in the right image, where it runs
// along the rows (no depth), or when the depth of an end is known to worse than max_relative_sigma.
std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma);

// Returns the disparity of the scene that a stereo or RGB-D frame shows: the median over its points
// and ends of lines, with half of it as deviation. Returns nullopt where none was measured.
std::optional<Disparity> SceneDisparity(const Frame& frame);

// Returns the line that line feature i shows if it is about as far away as the scene. A line along
// the rows or far away, or one that the right image does not show, has no depth of its own. It
// still says as much as any other line about the rotation of a camera that moves little against
// that depth. Its measured disparities and `scene` are averaged by their variances; the information
// counts both.
LineModel LineAtSceneDepth(const RectifiedCamera& camera,
                           const Frame& frame,
                           std::size_t i,
                           const Disparity& scene);

}  // namespace plumbline
