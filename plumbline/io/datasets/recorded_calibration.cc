// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/recorded_calibration.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <fmt/format.h>

namespace plumbline {
namespace {

using RowMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Largest difference of R from a rotation: R is written with few digits.
constexpr double kRotationSlack = 1e-3;

[[noreturn]] void Fail(const RecordedCamera& camera, const std::string& why) {
  throw InputError(camera.source + ": " + why);
}

void Check(const RecordedCamera& camera, const std::optional<std::string>& fault) {
  if (fault) Fail(camera, *fault);
}

void SetDistortion(const RecordedCamera& camera, CameraIntrinsics& intrinsics) {
  const CalibrationMessage& message = camera.message;
  const auto fault = SetNamedDistortion(message.distortion_model, message.d, intrinsics);
  if (fault) Fail(camera, *fault + ": give --camera FILE");
}

Camera CameraOf(const RecordedCamera& camera) {
  const CalibrationMessage& message = camera.message;
  if (message.binning_x > 1 || message.binning_y > 1 || message.roi_x > 0 || message.roi_y > 0) {
    Fail(camera, "expected whole images, found binned or cut ones: give --camera FILE");
  }
  Check(camera, SizeFault(message.width, message.height));
  CameraIntrinsics intrinsics;
  intrinsics.width = static_cast<int>(message.width);
  intrinsics.height = static_cast<int>(message.height);
  if (camera.rectified) {
    intrinsics.fx = message.p[0];
    intrinsics.fy = message.p[5];
    intrinsics.cx = message.p[2];
    intrinsics.cy = message.p[6];
  } else {
    intrinsics.fx = message.k[0];
    intrinsics.fy = message.k[4];
    intrinsics.cx = message.k[2];
    intrinsics.cy = message.k[5];
    SetDistortion(camera, intrinsics);
  }
  Check(camera, IntrinsicsFault(intrinsics));
  Check(camera, DistortionFault(intrinsics));
  return Camera(intrinsics);
}

// Returns the rotation from the camera as it is to the rectified pair.
Eigen::Quaterniond RectifiedFromCamera(const RecordedCamera& camera) {
  const RowMatrix3 r = Eigen::Map<const RowMatrix3>(camera.message.r.data());
  const bool finite = r.allFinite();
  if (!finite || (r * r.transpose() - RowMatrix3::Identity()).norm() > kRotationSlack ||
      r.determinant() < 0) {
    Fail(camera, "expected a rotation in R, found none: give --camera FILE");
  }
  return Eigen::Quaterniond(Eigen::Matrix3d(r)).normalized();
}

// Returns the place of the camera on the common x axis of the rectified pair, in metres.
double PlaceOnBaseline(const RecordedCamera& camera) {
  const double fx = camera.message.p[0], shift = camera.message.p[3];
  if (!std::isfinite(shift) || !(fx > 0)) {
    Fail(camera, "expected a projection in P, found none: give --camera FILE");
  }
  return -shift / fx;
}

constexpr std::array<std::string_view, 6> kRadTanNames = {
    "plumb_bob", "rational_polynomial", "radtan", "radial_tangential", "brown_conrady", "brown"};
constexpr std::array<std::string_view, 5> kEquidistantNames = {
    "equidistant", "fisheye", "kannala_brandt", "kannala_brandt4", "kannala_brandt_4"};

template <std::size_t kSize>
bool IsIn(const std::array<std::string_view, kSize>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the name in small letters, with underscores between its words.
std::string Simplified(std::string_view model) {
  std::string name;
  for (const char letter : model) {
    const auto byte = static_cast<unsigned char>(letter);
    name += std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '_';
  }
  return name;
}

bool AllZero(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0; });
}

std::string WhyNot(std::string_view model, const std::string& name) {
  if (name.empty()) {
    return "expected the name of a distortion model with its numbers, found ''";
  }
  if (name == "inverse_brown_conrady" || name == "modified_brown_conrady") {
    return fmt::format(
        "expected plumb_bob or equidistant, found {}, whose numbers undo a distortion "
        "in place of describing it",
        InQuotes(model));
  }
  return fmt::format("expected distortion plumb_bob or equidistant, found {}", InQuotes(model));
}

std::optional<std::string> SetPinholeDistortion(std::string_view model,
                                                std::span<const double> numbers,
                                                CameraIntrinsics& intrinsics) {
  constexpr std::size_t kLeast = 4;
  if (numbers.size() < kLeast && !AllZero(numbers)) {
    return fmt::format(
        "expected {} of at least 4 numbers, found {}", InQuotes(model), numbers.size());
  }
  return SetOpenCvDistortion(numbers, intrinsics);
}

}  // namespace

bool IsCalibrated(const CalibrationMessage& message) {
  return message.k[0] != 0 || message.p[0] != 0;
}

Calibration CalibrationOf(const RecordedCamera& left, const std::optional<RecordedCamera>& right) {
  Calibration calibration;
  calibration.left = CameraOf(left);
  calibration.rectified = left.rectified;
  if (!right) return calibration;
  if (left.rectified != right->rectified) {
    Fail(*right, "expected a pair of which both images are rectified or none, found one");
  }
  calibration.right = CameraOf(*right);
  const double baseline = PlaceOnBaseline(*right) - PlaceOnBaseline(left);
  if (baseline == 0) {
    Fail(*right, "expected the baseline in P, found 0: give --camera FILE");
  }
  const Rigid3 right_from_left_rectified{Eigen::Quaterniond::Identity(), {-baseline, 0, 0}};
  calibration.right_from_left = right_from_left_rectified;
  if (!left.rectified) {
    const Rigid3 rectified_from_left{RectifiedFromCamera(left), Eigen::Vector3d::Zero()};
    const Rigid3 rectified_from_right{RectifiedFromCamera(*right), Eigen::Vector3d::Zero()};
    calibration.right_from_left =
        Inverse(rectified_from_right) * right_from_left_rectified * rectified_from_left;
  }
  Check(*right, PairFault(calibration));
  return calibration;
}

std::optional<std::string> SetNamedDistortion(std::string_view model,
                                              std::span<const double> numbers,
                                              CameraIntrinsics& intrinsics) {
  const std::string name = Simplified(model);
  const bool radtan = IsIn(kRadTanNames, name), equidistant = IsIn(kEquidistantNames, name);
  if (!radtan && !equidistant) {
    intrinsics.model = DistortionModel::kNone;
    return AllZero(numbers) ? std::nullopt : std::optional(WhyNot(model, name));
  }
  if (radtan) return SetPinholeDistortion(model, numbers, intrinsics);
  constexpr std::size_t kMost = 4;
  if (numbers.size() < kMost) {
    return fmt::format("expected {} of 4 numbers, found {}", InQuotes(model), numbers.size());
  }
  for (std::size_t i = kMost; i < numbers.size(); ++i) {
    if (numbers[i] == 0) continue;
    return fmt::format(
        "expected k1, k2, k3, k4 and then zeros, found {:g} as number {}; calibrate "
        "without more numbers",
        numbers[i],
        i + 1);
  }
  intrinsics.model = DistortionModel::kEquidistant;
  std::copy_n(numbers.begin(), kMost, intrinsics.distortion.begin());
  return std::nullopt;
}

}  // namespace plumbline
