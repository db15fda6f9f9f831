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

// Returns the point, in the world, of feature i of one stereo or RGB-D frame. Returns nullopt
// without disparity, or if the relative uncertainty of its depth (standard deviation / depth)
// exceeds max_relative_sigma.
std::optional<PointModel> PointFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i,
                                         double max_relative_sigma);

// Returns the covariance, in the world, of the position of PointFromFrame, from the deviations of
// the pixel and of the disparity; the pose counts as exact. The feature must have a disparity.
Eigen::Matrix3d PointCovarianceFromFrame(const RectifiedCamera& camera,
                                         const Frame& frame,
                                         std::size_t i);

// Returns the line, in the world and with its information, of line feature i of one stereo or RGB-D
// frame. Returns nullopt if the line was not found in the right image, if it runs along the rows
// (no depth), or if the relative uncertainty of the depth of an end exceeds max_relative_sigma.
std::optional<LineModel> LineFromFrame(const RectifiedCamera& camera,
                                       const Frame& frame,
                                       std::size_t i,
                                       double max_relative_sigma);

// Returns the scene disparity of a stereo or RGB-D frame: the median over its points and ends of
// lines, with half of it as standard deviation. Returns nullopt if none was measured.
std::optional<Disparity> SceneDisparity(const Frame& frame);

// Returns the line of line feature i, assumed about as far away as the scene. A line along the
// rows, far away, or missing in the right image has no depth of its own. It still constrains, like
// any other line, the rotation of a camera that moves little relative to that depth. Its measured
// disparities and `scene` are averaged by their variances; the information includes both.
LineModel LineAtSceneDepth(const RectifiedCamera& camera,
                           const Frame& frame,
                           std::size_t i,
                           const Disparity& scene);

}  // namespace plumbline
