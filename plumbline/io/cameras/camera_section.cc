// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/camera_section.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

bool HasPath(const YamlSection& section, const std::string& path) {
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) return section.Has(path);
  const std::string group = path.substr(0, slash);
  return section.Has(group) && HasPath(section.Child(group), path.substr(slash + 1));
}

[[noreturn]] void FailAtPath(const YamlSection& section,
                             const std::string& path,
                             const std::string& message) {
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) section.Fail(path, message);
  FailAtPath(section.Child(path.substr(0, slash)), path.substr(slash + 1), message);
}

// If there is a fault, fails at the first of the keys in the file.
void FailOn(const std::optional<std::string>& fault,
            const YamlSection& root,
            const std::vector<std::string>& keys) {
  if (!fault) return;
  PLUMBLINE_CHECK(!keys.empty(), "a number that no key gave");
  const auto found = std::find_if(
      keys.begin(), keys.end(), [&](const std::string& key) { return HasPath(root, key); });
  FailAtPath(root, found == keys.end() ? keys.front() : *found, *fault);
}

}  // namespace

int CheckedLength(const YamlSection& section, const std::string& key, double length) {
  if (const auto fault = SizeFault(length, 1)) section.Fail(key, *fault);
  return static_cast<int>(length);
}

Camera ReadListedCamera(const YamlSection& section,
                        const CameraListKeys& keys,
                        DistortionModel model,
                        std::size_t leading) {
  CameraIntrinsics intrinsics;
  const std::vector<double> size = section.Numbers(keys.size, {2});
  const std::vector<double> k = section.Numbers(keys.intrinsics, {leading + 4});
  intrinsics.width = CheckedLength(section, keys.size, size[0]);
  intrinsics.height = CheckedLength(section, keys.size, size[1]);
  intrinsics.fx = k[leading];
  intrinsics.fy = k[leading + 1];
  intrinsics.cx = k[leading + 2];
  intrinsics.cy = k[leading + 3];
  intrinsics.model = model;
  std::copy_n(k.begin(), leading, intrinsics.distortion.begin());
  const DistortionForm& form = FormOf(model);
  const bool more = form.most > leading && !keys.coefficients.empty();
  if (more) {
    std::vector<std::size_t> counts = {form.most - leading};
    if (form.least > leading && form.least < form.most) {
      counts.insert(counts.begin(), form.least - leading);
    }
    const std::vector<double> d = section.Numbers(keys.coefficients, counts);
    std::copy(d.begin(), d.end(), intrinsics.distortion.begin() + static_cast<int>(leading));
  }
  const std::string& key = keys.intrinsics;
  // Coefficients with bounds (alpha, xi) stand before the others.
  const bool leads = leading > 0 && CoefficientFault(intrinsics);
  const std::string& last = more && !leads ? keys.coefficients : key;
  return CheckedCamera(section, {keys.size, {key, key, key, key}, last}, intrinsics);
}

Camera ReadModelCamera(const YamlSection& section,
                       const CameraListKeys& keys,
                       const std::string& radtan_name) {
  CheckPinhole(section, "camera_model");
  const std::string name = section.Text("distortion_model");
  if (name == radtan_name) return ReadListedCamera(section, keys, DistortionModel::kRadTan);
  if (name == "equidistant") return ReadListedCamera(section, keys, DistortionModel::kEquidistant);
  if (name == "fov") return ReadListedCamera(section, keys, DistortionModel::kFov);
  if (name == "none") return ReadListedCamera(section, keys, DistortionModel::kNone);
  section.Fail("distortion_model",
               "expected " + radtan_name + ", equidistant, fov or none, found " + InQuotes(name));
}

void CheckPinhole(const YamlSection& section, const std::string& key) {
  const std::string name = section.Text(key);
  if (name != "pinhole") section.Fail(key, "expected pinhole, found " + InQuotes(name));
}

Camera CheckedCamera(const YamlSection& section,
                     const CameraKeys& keys,
                     const CameraIntrinsics& intrinsics) {
  if (const auto fault = SizeFault(intrinsics.width, intrinsics.height)) {
    section.Fail(keys.size, *fault);
  }
  std::size_t number = 0;
  if (const auto fault = IntrinsicsFault(intrinsics, &number)) {
    section.Fail(keys.intrinsics[number], *fault);
  }
  if (const auto fault = DistortionFault(intrinsics)) section.Fail(keys.coefficients, *fault);
  return Camera(intrinsics);
}

int ReadLength(const YamlSection& section, const std::string& key) {
  if (!section.Has(key)) {
    section.Fail(key, "expected the size of the images in pixels, found none; add the row");
  }
  return CheckedLength(section, key, section.Number(key));
}

void ReadCameraMatrix(const YamlSection& section,
                      const std::string& key,
                      CameraIntrinsics& intrinsics) {
  const Eigen::MatrixXd K = section.Matrix(key, 3, 3);
  const bool pinhole = K(0, 1) == 0 && K(1, 0) == 0 && K.row(2) == Eigen::RowVector3d(0, 0, 1);
  if (!pinhole) section.Fail(key, "expected fx 0 cx, 0 fy cy, 0 0 1");
  intrinsics.fx = K(0, 0);
  intrinsics.fy = K(1, 1);
  intrinsics.cx = K(0, 2);
  intrinsics.cy = K(1, 2);
}

void SetRadTan(const std::vector<double>& coefficients, CameraIntrinsics& intrinsics) {
  std::copy(coefficients.begin(), coefficients.end(), intrinsics.distortion.begin());
  const bool any = std::any_of(coefficients.begin(), coefficients.end(), [](double coefficient) {
    return coefficient != 0;
  });
  intrinsics.model = any ? DistortionModel::kRadTan : DistortionModel::kNone;
}

std::optional<std::string> SetOpenCvDistortion(std::span<const double> coefficients,
                                               CameraIntrinsics& intrinsics) {
  const std::size_t first_rational = FormOf(DistortionModel::kRadTan).most;
  for (std::size_t i = kMostCoefficients; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0) continue;
    return fmt::format(
        "expected k1, k2, p1, p2, k3, k4, k5, k6 and then zeros, found {:g} as number {}; "
        "calibrate "
        "without the thin prism and tilted models",
        coefficients[i],
        i + 1);
  }
  const std::size_t used = std::min(coefficients.size(), kMostCoefficients);
  const auto any = [&](std::size_t from) {
    return std::any_of(coefficients.begin() + static_cast<std::ptrdiff_t>(std::min(from, used)),
                       coefficients.begin() + static_cast<std::ptrdiff_t>(used),
                       [](double number) { return number != 0; });
  };
  intrinsics.distortion = {};
  std::copy_n(coefficients.begin(), used, intrinsics.distortion.begin());
  intrinsics.model = any(first_rational) ? DistortionModel::kRational
                     : any(0)            ? DistortionModel::kRadTan
                                         : DistortionModel::kNone;
  return std::nullopt;
}

void CheckCalibration(const YamlSection& root,
                      const CalibrationKeys& keys,
                      const Calibration& calibration,
                      bool use_pair) {
  if (calibration.rate_hz) FailOn(RateFault(*calibration.rate_hz), root, keys.rate);
  if (calibration.depth_factor) {
    FailOn(DepthFactorFault(*calibration.depth_factor), root, keys.depth_factor);
  }
  if (calibration.body_from_left) {
    FailOn(LeverFault(*calibration.body_from_left), root, keys.lever);
  }
  if (calibration.right && use_pair) FailOn(PairFault(calibration), root, keys.pair);
}

void CheckRectifiedPair(const YamlSection& section,
                        const std::string& key,
                        const Rigid3& right_from_left) {
  if (AngularDistance(right_from_left.rotation, Eigen::Quaterniond::Identity()) > 1e-6 ||
      right_from_left.translation.tail<2>().norm() > 1e-6 || right_from_left.translation.x() >= 0) {
    section.Fail(key, "expected a motion along -x, as the pair is rectified");
  }
}

}  // namespace plumbline
