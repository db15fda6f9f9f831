// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace plumbline {

// Model of the lens, from rays to points on the normalized image plane. With a point (x, y, z),
// r = |(x, y)| / z, theta its angle to the optical axis and n its distance:
enum class DistortionModel {
  kNone,    // (x, y) / z
  kRadTan,  // radial-tangential (Brown-Conrady) in r: k1 k2 p1 p2 k3, k3 = 0 where a file has four
  kEquidistant,   // Kannala-Brandt: theta (1 + k1 theta^2 + ... + k4 theta^8)
  kRational,      // OpenCV: as kRadTan, radial (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + ...)
  kFov,           // FOV or ATAN, Devernay and Faugeras 2001: atan(2 r tan(w / 2)) / w
  kDoubleSphere,  // Usenko et al. 2018: (x, y) / (alpha d2 + (1 - alpha) (xi n + z))
  kEucm,  // Khomutenko et al. 2016: (x, y) / (alpha d + (1 - alpha) z), d^2 = beta r^2 + z^2
  kOmni,  // Mei and Rives 2007: (x, y) / (z + xi n), bent as by kRadTan
};

// Numbers of CameraIntrinsics::distortion at most.
constexpr std::size_t kMostCoefficients = 8;

// How files of ours write a model: its name and the names of its coefficients, in their order.
struct DistortionForm {
  DistortionModel model;
  std::string_view name;
  std::array<std::string_view, kMostCoefficients> coefficients;
  std::size_t least, most;  // coefficients that a file has; missing ones are zero
};
constexpr std::array<DistortionForm, 8> kDistortionForms = {{
    {DistortionModel::kNone, "none", {}, 0, 0},
    {DistortionModel::kRadTan, "radtan", {"k1", "k2", "p1", "p2", "k3"}, 4, 5},
    {DistortionModel::kEquidistant, "equidistant", {"k1", "k2", "k3", "k4"}, 4, 4},
    {DistortionModel::kRational,
     "rational",
     {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"},
     8,
     8},
    {DistortionModel::kFov, "fov", {"w"}, 1, 1},
    {DistortionModel::kDoubleSphere, "double_sphere", {"xi", "alpha"}, 2, 2},
    {DistortionModel::kEucm, "eucm", {"alpha", "beta"}, 2, 2},
    {DistortionModel::kOmni, "omni", {"xi", "k1", "k2", "p1", "p2"}, 1, 5},
}};  // in the order of the models

// Returns the form of a model.
constexpr const DistortionForm& FormOf(DistortionModel model) {
  return kDistortionForms[static_cast<std::size_t>(model)];
}

// Intrinsics and distortion of one camera, as in a calibration file. Pixel centres at integer
// coordinates.
struct CameraIntrinsics {
  double fx = 1, fy = 1, cx = 0, cy = 0;  // pixels
  int width = 1, height = 1;
  DistortionModel model = DistortionModel::kNone;
  std::array<double, kMostCoefficients> distortion{};  // in the order of kDistortionForms

  // Equal if all numbers are.
  friend bool operator==(const CameraIntrinsics&, const CameraIntrinsics&) = default;
};

// Returns what is wrong with the coefficients of a model that bounds them, "expected alpha from 0
// to 1, found 3"; nullopt if nothing is. All must be finite.
std::optional<std::string> CoefficientFault(const CameraIntrinsics& intrinsics);

// A camera as delivered, with lens distortion. Camera frame: x right, y down, z forward, metres.
//
// The polynomial of a distortion model is fitted within the image area; beyond it may turn back, so
// that two rays share a pixel. Both directions of the mapping end where it stops being monotonic.
// Models of the plane z = 1 (kNone, kRadTan, kRational, kFov) end at 90 degrees off the axis, the
// others (kEquidistant, kDoubleSphere, kEucm, kOmni) see past it.
class Camera {
 public:
  // Derivative of a pixel with respect to the 3D point.
  using ProjectionJacobian = Eigen::Matrix<double, 2, 3>;

  // A placeholder: f = 1, one pixel, no distortion.
  Camera() = default;

  // Throws InputError ("camera: expected fx > 0, found -1") unless focal lengths and size are
  // positive, all numbers finite and the coefficients within the bounds of their model.
  explicit Camera(const CameraIntrinsics& intrinsics);

  // Pixel of a point in the camera frame, also outside the image. nullopt beyond the invertible
  // domain of the model. `jacobian`, if not null, becomes d(pixel)/d(point).
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& point,
                                         ProjectionJacobian* jacobian = nullptr) const;

  // Direction, of any length, that Project maps to the pixel; z = 1 of a model of the plane. By
  // closed forms; polynomials by a bracketed search along the radius, then Newton steps in two
  // dimensions. nullopt if the invertible domain has none.
  std::optional<Eigen::Vector3d> Ray(const Eigen::Vector2d& px) const;
  // The same with z = 1; nullopt also for 90 degrees off the axis and more.
  std::optional<Eigen::Vector3d> Unproject(const Eigen::Vector2d& px) const;

  // Angle off the axis at which the model ends, radians: Project knows no point beyond.
  double MaxAngle() const { return max_angle_; }
  // Pixels per radian on the axis, the mean of x and y.
  double CentreFocal() const;

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
  // The two steps of Project: to the plane on which kRadTan bends, and the bending.
  std::optional<Eigen::Vector2d> ToPlane(const Eigen::Vector3d& point,
                                         ProjectionJacobian* jacobian) const;
  std::optional<Eigen::Vector2d> Distort(const Eigen::Vector2d& ideal,
                                         Eigen::Matrix2d* jacobian) const;
  // Their inverses.
  std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& distorted) const;
  std::optional<Eigen::Vector3d> FromPlane(const Eigen::Vector2d& plane) const;

  CameraIntrinsics intrinsics_;
  // Radius on the plane up to which the radial distortion is monotonic.
  double max_radius_ = std::numeric_limits<double>::infinity();
  double max_angle_ = 0;
  double min_cosine_ = 0;  // of the angle at which ToPlane ends
};

}  // namespace plumbline
