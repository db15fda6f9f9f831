// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <fmt/core.h>

namespace plumbline {
namespace {

// Models whose first numbers stand before the focal lengths.
struct KalibrModel {
  const char* name;
  DistortionModel model;
  std::size_t leading;
};
constexpr std::array<KalibrModel, 3> kSphereModels = {{{"omni", DistortionModel::kOmni, 1},
                                                       {"ds", DistortionModel::kDoubleSphere, 2},
                                                       {"eucm", DistortionModel::kEucm, 2}}};

Camera ReadSphereCamera(const YamlSection& section, const KalibrModel& sphere) {
  const bool bends = sphere.model == DistortionModel::kOmni;
  const std::string name =
      section.Has("distortion_model") ? section.Text("distortion_model") : "none";
  if (name == "none" || (bends && name == "radtan")) {
    return ReadListedCamera(section,
                            {"resolution", "intrinsics", name == "none" ? "" : "distortion_coeffs"},
                            sphere.model,
                            sphere.leading);
  }
  section.Fail("distortion_model",
               fmt::format("expected {}none with {}, found {}",
                           bends ? "radtan or " : "",
                           sphere.name,
                           InQuotes(name)));
}

Camera ReadCamera(const YamlSection& section) {
  const std::string name = section.Text("camera_model");
  for (const KalibrModel& sphere : kSphereModels) {
    if (name == sphere.name) return ReadSphereCamera(section, sphere);
  }
  if (name != "pinhole") {
    section.Fail("camera_model", "expected pinhole, omni, ds or eucm, found " + InQuotes(name));
  }
  return ReadModelCamera(section, {"resolution", "intrinsics", "distortion_coeffs"}, "radtan");
}

// Reads a number unknown to Kalibr, at the top of the file or with the left camera.
std::optional<double> AddedNumber(const YamlSection& root, const std::string& key) {
  const YamlSection left = root.Child("cam0");
  if (!root.Has(key)) return left.Has(key) ? std::optional(left.Positive(key)) : std::nullopt;
  if (left.Has(key)) root.Fail(key, "expected it here or in cam0, found both");
  return root.Positive(key);
}

// The pose of the right camera: Kalibr's own, or without it from the poses of both cameras at an
// inertial sensor, as in files of OpenVINS.
Rigid3 RightFromLeft(const YamlSection& left, const YamlSection& right) {
  if (!right.Has("T_cn_cnm1")) {
    const auto both = [&](const char* key) { return left.Has(key) && right.Has(key); };
    if (both("T_cam_imu")) return right.Motion("T_cam_imu") * Inverse(left.Motion("T_cam_imu"));
    if (both("T_imu_cam")) return Inverse(right.Motion("T_imu_cam")) * left.Motion("T_imu_cam");
    right.Fail("T_cn_cnm1", "expected it, or T_cam_imu or T_imu_cam of both cameras, found none");
  }
  return right.Motion("T_cn_cnm1");
}

}  // namespace

Calibration ReadKalibr(const YamlSection& root) {
  if (!root.Has("cam0")) root.Fail("cam1", "expected cam0, the left camera, beside it, found none");
  Calibration calibration;
  calibration.left = ReadCamera(root.Child("cam0"));
  if (root.Has("cam1")) {
    const YamlSection right = root.Child("cam1");
    calibration.right = ReadCamera(right);
    calibration.right_from_left = RightFromLeft(root.Child("cam0"), right);
  }
  calibration.rate_hz = AddedNumber(root, "rate_hz");
  calibration.depth_factor = AddedNumber(root, "depth_factor");
  return calibration;
}

}  // namespace plumbline
