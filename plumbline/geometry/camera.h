// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace plumbline {

// How the lens bends a ray before it meets the pixel grid.
enum class DistortionModel {
  kNone,
  kRadTan,  // radial-tangential (Brown-Conrady): k1 k2 p1 p2 k3, k3 = 0 where a file gives four
  kEquidistant,  // Kannala-Brandt: k1 k2 k3 k4 of theta, the fifth number unused
};

// The numbers of a calibration file for one camera. Pixel centres at integer coordinates.
struct CameraIntrinsics {
  double fx = 1, fy = 1, cx = 0, cy = 0;  // pixels
  int width = 1, height = 1;
  DistortionModel model = DistortionModel::kNone;
  std::array<double, 5> distortion{};

  // Equal number by number.
  friend bool operator==(const CameraIntrinsics&, const CameraIntrinsics&) = default;
};

// A camera as delivered, with lens distortion. Camera frame: x right, y down, z forward, metres.
//
// The polynomial of a distortion model is a fit to the image area; further out it may turn back, so
// that two rays share a pixel. Both directions of the mapping end where it stops being monotonic.
class Camera {
 public:
  // Derivative of a pixel by the point that it shows.
  using ProjectionJacobian = Eigen::Matrix<double, 2, 3>;

  // A placeholder: f = 1, one pixel, no distortion.
  Camera() = default;

  // Throws InputError ("camera: expected fx > 0, found -1") unless focal lengths and size are
  // positive and all numbers finite.
  explicit Camera(const CameraIntrinsics& intrinsics);

  // Pixel of a point in the camera frame, also outside the image. nullopt for z <= 0 and beyond the
  // invertible domain of the distortion. `jacobian`, where given, becomes d(pixel)/d(point).
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point,
                                         ProjectionJacobian* jacobian = nullptr) const;

  // Ray (z = 1) that Project maps to the pixel: a bracketed search along the radius and then Newton
  // steps in two dimensions. nullopt when there is none within the invertible domain.
  std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& px) const;

  // Where the lens moves a point of the plane z = 1. nullopt beyond the invertible domain.
  // `jacobian`, where given, becomes d(distorted)/d(ideal).
  std::optional<Eigen::Vector2d> Distort(const Eigen::Vector2d& ideal,
                                         Eigen::Matrix2d* jacobian = nullptr) const;
  // The point of the plane z = 1 that the lens moves to `distorted`; nullopt as of Unproject.
  std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& distorted) const;

  // The numbers that the camera was made of.
  const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  // Columns of the image.
  int width() const { return intrinsics_.width; }
  // Rows of the image.
  int height() const { return intrinsics_.height; }
  // True when every coefficient is zero or the model is kNone. (All-zero kEquidistant does bend.)
  bool IsIdeal() const;
  // Whether a pixel lies between the centres of the outermost pixels, these included.
  bool Contains(const Eigen::Vector2d& px) const {
    return px.x() >= 0 && px.y() >= 0 && px.x() <= width() - 1 && px.y() <= height() - 1;
  }

  // Equal number by number.
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
