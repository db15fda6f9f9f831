// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// Model of lens distortion, from rays to points on the normalized image plane.
enum class DistortionModel {
  kNone,
  kRadTan,  // radial-tangential (Brown-Conrady): k1 k2 p1 p2 k3, k3 = 0 where a file gives four
  kEquidistant,  // Kannala-Brandt: k1 k2 k3 k4 of theta, the fifth number unused
};

// Intrinsics and distortion of one camera, as in a calibration file. Pixel centres at integer
// coordinates.
struct CameraIntrinsics {
  double fx = 1, fy = 1, cx = 0, cy = 0;  // pixels
  int width = 1, height = 1;
  DistortionModel model = DistortionModel::kNone;
  std::array<double, 5> distortion{};

  // Equal if all numbers are.
  friend bool operator==(const CameraIntrinsics&, const CameraIntrinsics&) = default;
};

// A camera as delivered, with lens distortion. Camera frame: x right, y down, z forward, metres.
//
// The polynomial of a distortion model is fitted within the image area; beyond it may turn back, so
// that two rays share a pixel. Both directions of the mapping end where it stops being monotonic.
class Camera {
 public:
  // Derivative of a pixel with respect to the 3D point.
  using ProjectionJacobian = Eigen::Matrix<double, 2, 3>;

  // A placeholder: f = 1, one pixel, no distortion.
  Camera() = default;

  // Throws InputError ("camera: expected fx > 0, found -1") unless focal lengths and size are
  // positive and all numbers finite.
  explicit Camera(const CameraIntrinsics& intrinsics);

  // Pixel of a point in the camera frame, also outside the image. nullopt for z <= 0 and beyond the
  // invertible domain of the distortion. `jacobian`, if not null, becomes d(pixel)/d(point).
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point,
                                         ProjectionJacobian* jacobian = nullptr) const;

  // Ray (z = 1) that Project maps to the pixel: a bracketed search along the radius, then Newton
  // steps in two dimensions. nullopt if the invertible domain has none.
  std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& px) const;

  // Distorts a point of the plane z = 1. nullopt beyond the invertible domain. `jacobian`, if not
  // null, becomes d(distorted)/d(ideal).
  std::optional<Eigen::Vector2d> Distort(const Eigen::Vector2d& ideal,
                                         Eigen::Matrix2d* jacobian = nullptr) const;
  // Inverse of Distort, on the plane z = 1; nullopt as for Unproject.
  std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& distorted) const;

  // The intrinsics that the camera was made from.
  const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  // Columns of the image.
  int width() const { return intrinsics_.width; }
  // Rows of the image.
  int height() const { return intrinsics_.height; }
  // True when every coefficient is zero or the model is kNone. (All-zero kEquidistant does bend.)
  bool IsIdeal() const;
  // Returns true if a pixel lies between the centres of the outermost pixels, inclusive.
  bool Contains(const Eigen::Vector2d& px) const {
    return px.x() >= 0 && px.y() >= 0 && px.x() <= width() - 1 && px.y() <= height() - 1;
  }

  // Equal if all numbers of the intrinsics are.
  friend bool operator==(const Camera& a, const Camera& b) {
    return a.intrinsics_ == b.intrinsics_;
  }

 private:
  std::optional<double> UndistortRadius(double distorted_radius) const;

  CameraIntrinsics intrinsics_;
  // Radius on the plane z = 1 up to which the radial distortion is monotonic.
  double max_radius_ = std::numeric_limits<double>::infinity();
};

}  // namespace plumbline
