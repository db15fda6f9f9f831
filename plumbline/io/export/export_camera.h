// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// The camera of exported images: the rectified camera of the map, or the left camera as delivered,
// with its lens. Both have the same centre. Pixel centres at integer coordinates.
class ExportCamera {
 public:
  // The rectified camera.
  explicit ExportCamera(const RectifiedCamera& rectified) : rectified_(rectified) {}
  // The left camera as delivered.
  ExportCamera(const RectifiedCamera& rectified,
               const Eigen::Quaterniond& rectified_from_left,
               const Camera& left)
      : rectified_(rectified), turn_(rectified_from_left.conjugate()), left_(left) {}

  // True if the images are as delivered.
  bool IsDelivered() const { return left_.has_value(); }
  // Its intrinsics; of the rectified camera without distortion.
  CameraIntrinsics intrinsics() const;

  // Pose of this camera, by that of the rectified one.
  Rigid3 PoseOf(const Rigid3& cam_from_world) const;
  // Pixel of a point in the frame of the rectified camera; nullopt behind that camera and beyond
  // the end of the lens model.
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& in_rectified) const;
  // Pixel that shows what a pixel of the rectified camera shows, without rounding; nullopt beyond
  // the end of the lens model.
  std::optional<Eigen::Vector2d> PixelOf(const Eigen::Vector2d& rectified_px) const;

 private:
  RectifiedCamera rectified_;
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();  // left from rectified
  std::optional<Camera> left_;
};

}  // namespace plumbline
