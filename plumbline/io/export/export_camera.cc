// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/export_camera.h"

namespace plumbline {

CameraIntrinsics ExportCamera::intrinsics() const {
  if (left_) return left_->intrinsics();
  CameraIntrinsics in;
  in.fx = rectified_.fx;
  in.fy = rectified_.fy;
  in.cx = rectified_.cx;
  in.cy = rectified_.cy;
  in.width = rectified_.width;
  in.height = rectified_.height;
  return in;
}

Rigid3 ExportCamera::PoseOf(const Rigid3& cam_from_world) const {
  if (!left_) return cam_from_world;
  return Rigid3{turn_, Eigen::Vector3d::Zero()} * cam_from_world;
}

std::optional<Eigen::Vector2d> ExportCamera::Project(const Eigen::Vector3d& in_rectified) const {
  if (!(in_rectified.z() > 0)) return std::nullopt;
  if (!left_) return rectified_.Project(in_rectified);
  return left_->Project(turn_ * in_rectified);
}

std::optional<Eigen::Vector2d> ExportCamera::PixelOf(const Eigen::Vector2d& rectified_px) const {
  if (!left_) return rectified_px;
  return left_->Project(turn_ * rectified_.Unproject(rectified_px));
}

}  // namespace plumbline
