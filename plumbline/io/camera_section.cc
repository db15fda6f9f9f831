// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_section.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

namespace plumbline {

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
  return CheckedCamera(section, keys.intrinsics, intrinsics);
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
               "expected " + radtan_name + ", equidistant or none, found '" + name + "'");
}

void CheckPinhole(const YamlSection& section, const std::string& key) {
  const std::string name = section.Text(key);
  if (name != "pinhole") section.Fail(key, "expected pinhole, found '" + name + "'");
}

Camera CheckedCamera(const YamlSection& section,
                     const std::string& key,
                     const CameraIntrinsics& intrinsics) {
  try {
    return Camera(intrinsics);
  } catch (const InputError& error) {
    section.Fail(key, error.what());
  }
}

int CheckedLength(const YamlSection& section, const std::string& key, double length) {
  if (length < 1 || length > 100000 || length != std::floor(length)) {
    section.Fail(key, fmt::format("expected whole numbers above 0, found {}", length));
  }
  return static_cast<int>(length);
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
