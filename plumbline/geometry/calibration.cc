// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/calibration.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace plumbline {

namespace {

constexpr double kMinBaseline = 1e-4;  // metres
constexpr double kMaxBaseline = 1e3;
constexpr double kLongestLever = 1e4;              // metres, distance of the camera from the body
constexpr double kMinRate = 1e-4, kMaxRate = 1e5;  // Hz
constexpr double kMinDepthFactor = 1e-3, kMaxDepthFactor = 1e7;

// Focal lengths relative to the longer side of the image: from more than a half circle to a
// telescope.
constexpr double kMinFocal = 0.01, kMaxFocal = 1000;
// Largest distance of the principal point from an image that was cut out, in longer sides.
constexpr double kFarthestCentre = 10;
constexpr double kLargestCoefficient = 1e6;
constexpr double kMinViewDeg = 10, kMaxViewDeg = 150;
// Rounding errors of a calibration file allowed in a pair that is declared rectified.
constexpr double kMaxRectifiedAngle = 1e-3;  // radians
constexpr double kMaxRectifiedTilt = 0.02;   // relative to the baseline
// Optical axes that are further apart see nothing in common.
constexpr double kMaxAxesAngleDeg = 120;

// Returns numbers, with six digits, and texts one after the other.
template <class... Parts>
std::string Text(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

// The comparison is written so that NaN is outside.
bool Within(double value, double min, double max) { return value >= min && value <= max; }

std::optional<std::string> RangeFault(
    const char* name, double value, double min, double max, const char* unit) {
  if (Within(value, min, max)) return std::nullopt;
  return Text("expected ", name, " from ", min, " to ", max, unit, ", found ", value);
}

std::string Place(const Eigen::Vector3d& p) {
  // + 0.0 leaves no minus at 0
  return Text("(", p.x() + 0.0, ", ", p.y() + 0.0, ", ", p.z() + 0.0, ") m");
}

std::optional<std::string> TurnFault(const Calibration& calibration,
                                     const Eigen::Vector3d& centre) {
  const double angle = LogSo3(calibration.right_from_left.rotation).norm();
  if (angle <= kMaxRectifiedAngle && centre.tail<2>().norm() <= kMaxRectifiedTilt * centre.x()) {
    return std::nullopt;
  }
  return Text(
      "expected a right camera displaced along x and not turned, since the images are declared "
      "rectified, found a turn of ",
      angle,
      " rad and a centre at ",
      Place(centre));
}

std::optional<std::string> CameraFault(const CameraIntrinsics& in) {
  if (auto fault = SizeFault(in.width, in.height)) return fault;
  if (auto fault = IntrinsicsFault(in)) return fault;
  return DistortionFault(in);
}

}  // namespace

std::optional<std::string> SizeFault(double width, double height) {
  const auto whole = [](double length) {
    return Within(length, 1, kLongestSide) && length == std::floor(length);
  };
  for (const double length : {width, height}) {
    if (!whole(length)) {
      return Text("expected whole numbers from 1 to ", kLongestSide, ", found ", length);
    }
  }
  if (width * height <= static_cast<double>(kMostPixels)) return std::nullopt;
  return Text("expected an image of at most ",
              kMostPixels / 1'000'000,
              " million pixels, found one of ",
              static_cast<std::int64_t>(width),
              "x",
              static_cast<std::int64_t>(height));
}

std::optional<std::string> IntrinsicsFault(const CameraIntrinsics& in, std::size_t* number) {
  const double side = std::max(in.width, in.height);
  const double far = kFarthestCentre * side;
  const std::array faults = {RangeFault("fx", in.fx, kMinFocal * side, kMaxFocal * side, " px"),
                             RangeFault("fy", in.fy, kMinFocal * side, kMaxFocal * side, " px"),
                             RangeFault("cx", in.cx, -far, side + far, " px"),
                             RangeFault("cy", in.cy, -far, side + far, " px")};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (!faults[i]) continue;
    if (number != nullptr) *number = i;
    return faults[i];
  }
  return std::nullopt;
}

std::optional<std::string> DistortionFault(const CameraIntrinsics& in) {
  for (const double k : in.distortion) {
    if (auto fault = RangeFault("coefficients", k, -kLargestCoefficient, kLargestCoefficient, "")) {
      return fault;
    }
  }
  if (auto fault = CoefficientFault(in)) return fault;
  const Camera camera(in);
  if (camera.IsIdeal()) return std::nullopt;
  constexpr int kSteps = 8;
  int reached = 0;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Eigen::Vector2d px(static_cast<double>(camera.width() - 1) * column / kSteps,
                               static_cast<double>(camera.height() - 1) * row / kSteps);
      reached += camera.Ray(px) ? 1 : 0;
    }
  }
  constexpr int kAll = (kSteps + 1) * (kSteps + 1);
  if (2 * reached >= kAll) return std::nullopt;
  return Text("expected a distortion that has a ray for the pixels of the image, found one for ",
              100 * reached / kAll,
              " % of them");
}

std::optional<std::string> PairFault(const Calibration& calibration) {
  const Camera& left = calibration.left;
  const Camera& right = *calibration.right;
  if (left.width() != right.width() || left.height() != right.height()) {
    return Text("expected a right camera of ",
                left.width(),
                "x",
                left.height(),
                " pixels like the left one, found ",
                right.width(),
                "x",
                right.height());
  }
  const Eigen::Vector3d centre = Inverse(calibration.right_from_left).translation;
  // The comparison is written so that NaN fails.
  if (!(centre.x() > 0 && centre.x() > centre.tail<2>().norm())) {
    return Text("expected the right camera to the right (+x) of the left one, found it at ",
                Place(centre));
  }
  if (auto fault = RangeFault("a baseline", centre.norm(), kMinBaseline, kMaxBaseline, " m")) {
    return fault;
  }
  const Eigen::Vector3d axis =
      calibration.right_from_left.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  if (!(axis.z() >= math::Cos(kMaxAxesAngleDeg * kDegree))) {
    return Text("expected a right camera that looks the way the left one does, found its axis ",
                math::Acos(std::clamp(axis.z(), -1.0, 1.0)) / kDegree,
                " degrees off");
  }
  return calibration.rectified ? TurnFault(calibration, centre) : std::nullopt;
}

std::optional<std::string> CalibrationFault(const Calibration& calibration) {
  if (auto fault = CameraFault(calibration.left.intrinsics())) return "left camera: " + *fault;
  if (auto fault = ViewAngleFault(calibration)) return fault;
  if (calibration.depth_factor) {
    if (auto fault = DepthFactorFault(*calibration.depth_factor)) return fault;
  }
  if (auto fault = RectifiedFault(calibration)) return fault;
  if (!calibration.right) return std::nullopt;
  if (auto fault = CameraFault(calibration.right->intrinsics())) return "right camera: " + *fault;
  return PairFault(calibration);
}

std::optional<std::string> ViewAngleFault(const Calibration& calibration) {
  if (!calibration.view_angle_deg) return std::nullopt;
  return RangeFault(
      "a view angle", *calibration.view_angle_deg, kMinViewDeg, kMaxViewDeg, " degrees");
}

std::optional<std::string> RectifiedFault(const Calibration& calibration) {
  const bool ideal =
      calibration.left.IsIdeal() && (!calibration.right || calibration.right->IsIdeal());
  if (!calibration.rectified || ideal) return std::nullopt;
  return "expected no lens distortion, since the images are declared rectified";
}

std::optional<std::string> RateFault(double rate_hz) {
  return RangeFault("a rate", rate_hz, kMinRate, kMaxRate, " Hz");
}

std::optional<std::string> DepthFactorFault(double depth_factor) {
  return RangeFault("a depth factor", depth_factor, kMinDepthFactor, kMaxDepthFactor, " per metre");
}

std::optional<std::string> LeverFault(const Rigid3& body_from_left) {
  const double length = body_from_left.translation.norm();
  if (Within(length, 0, kLongestLever)) return std::nullopt;
  return Text("expected a body at most ", kLongestLever, " m from the camera, found ", length);
}

}  // namespace plumbline
