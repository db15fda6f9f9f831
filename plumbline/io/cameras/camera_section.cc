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

// Returns a width or height that `key` gives; throws InputError unless it is a whole number of
// pixels.
int CheckedLength(const YamlSection& section, const std::string& key, double length) {
  if (const auto fault = SizeFault(length, 1)) section.Fail(key, *fault);
  return static_cast<int>(length);
}

}  // namespace

Camera ReadListedCamera(const YamlSection& section,
                        const CameraListKeys& keys,
                        DistortionModel model) {
  CameraIntrinsics intrinsics;
  const std::vector<double> size = section.Numbers(keys.size, {2});
  const std::vector<double> k = section.Numbers(keys.intrinsics, {4});
  intrinsics.width = CheckedLength(section, keys.size, size[0]);
  intrinsics.height = CheckedLength(section, keys.size, size[1]);
  intrinsics.fx = k[0];
  intrinsics.fy = k[1];
  intrinsics.cx = k[2];
  intrinsics.cy = k[3];
  intrinsics.model = model;
  if (model != DistortionModel::kNone) {
    const bool radtan = model == DistortionModel::kRadTan;
    const std::vector<double> d = section.Numbers(
        keys.coefficients, radtan ? std::vector<std::size_t>{4, 5} : std::vector<std::size_t>{4});
    std::copy(d.begin(), d.end(), intrinsics.distortion.begin());
  }
  const std::string& key = keys.intrinsics;
  return CheckedCamera(section, {keys.size, {key, key, key, key}, keys.coefficients}, intrinsics);
}

Camera ReadModelCamera(const YamlSection& section,
                       const CameraListKeys& keys,
                       const std::string& radtan_name) {
  CheckPinhole(section, "camera_model");
  const std::string name = section.Text("distortion_model");
  if (name == radtan_name) return ReadListedCamera(section, keys, DistortionModel::kRadTan);
  if (name == "equidistant") return ReadListedCamera(section, keys, DistortionModel::kEquidistant);
  if (name == "none") return ReadListedCamera(section, keys, DistortionModel::kNone);
  section.Fail("distortion_model",
               "expected " + radtan_name + ", equidistant or none, found " + InQuotes(name));
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
