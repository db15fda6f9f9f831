// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// The disparity of a point in a rectified pair, left.x - right.x, measured in the right image or
// computed from a depth image, with its standard deviation.
struct Disparity {
  double px = 0;
  double sigma_px = 1;
};

// The camera of all stages after rectification: an ideal pinhole, with a second, equal one
// displaced by `baseline` along +x (right camera of a rectified pair). For RGB-D images the right
// camera is virtual: depth z is carried as the disparity fx * baseline / z.
//
// Camera frame: x right, y down, z forward. Pixel centres at integer coordinates. Lengths are in
// metres, for a single camera in the map's scale.
struct RectifiedCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double baseline = 0;  // 0: monocular
  int width = 0, height = 0;

  // Pixel of a point with z > 0 (not checked).
  Eigen::Vector2d Project(const Eigen::Vector3d& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  // Ray through a pixel, z = 1.
  Eigen::Vector3d Unproject(const Eigen::Vector2d& px) const {
    return {(px.x() - cx) / fx, (px.y() - cy) / fy, 1.0};
  }
  // Returns the x offset from the left camera's frame to that of a camera of the pair: index 0 is
  // the left (or only) camera, 1 the right one.
  double ShiftInto(int index) const { return index == 0 ? 0.0 : -baseline; }
  // Disparity in pixels of a point at depth z > 0.
  double DisparityFromDepth(double z) const { return fx * baseline / z; }
  // Depth of a point with a disparity in pixels, greater than 0.
  double DepthFromDisparity(double disparity) const { return fx * baseline / disparity; }
  // Returns true if a pixel is at least `border` pixels inside the centres of the outermost pixels.
  bool Contains(const Eigen::Vector2d& px, double border = 0) const {
    return px.x() >= border && px.y() >= border && px.x() <= width - 1 - border &&
           px.y() <= height - 1 - border;
  }
  // Image line (a, b, c), a x + b y + c = 0 in pixels, of a Plücker moment in the camera frame; not
  // scaled to a^2 + b^2 = 1.
  Eigen::Vector3d ProjectMoment(const Eigen::Vector3d& m) const {
    return {fy * m.x(), fx * m.y(), -fy * cx * m.x() - fx * cy * m.y() + fx * fy * m.z()};
  }
};

// A rectified camera and its rotation relative to the left camera as delivered.
struct TurnedCamera {
  RectifiedCamera camera;
  Eigen::Quaterniond rectified_from_left = Eigen::Quaterniond::Identity();
};

// Returns the differences of two cameras, such as "fx 458.6 and 460.1" or "images of 752x480 and
// 640x480 pixels"; nullopt if they are equal up to rounding (1e-9 of each number; 1e-9 radians).
std::optional<std::string> CameraDifference(const TurnedCamera& a, const TurnedCamera& b);

}  // namespace plumbline
