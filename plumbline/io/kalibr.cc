// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/kalibr.h"

#include "plumbline/io/camera_section.h"

#include <optional>
#include <string>

namespace plumbline {
namespace {

Camera ReadCamera(const YamlSection& section) {
  const std::string camera_model = section.Text("camera_model");
  if (camera_model != "pinhole") {
    section.Fail("camera_model", "expected pinhole, found '" + camera_model + "'");
  }
  const std::string name = section.Text("distortion_model");
  std::optional<DistortionModel> model;
  if (name == "radtan") model = DistortionModel::kRadTan;
  if (name == "equidistant") model = DistortionModel::kEquidistant;
  if (name == "none") model = DistortionModel::kNone;
  if (!model) {
    section.Fail("distortion_model", "expected radtan, equidistant or none, found '" + name + "'");
  }
  return ReadListedCamera(section, {"resolution", "intrinsics", "distortion_coeffs"}, *model);
}

}  // namespace

Calibration ReadKalibr(const YamlSection& root) {
  Calibration calibration;
  calibration.left = ReadCamera(root.Child("cam0"));
  if (root.Has("cam1")) {
    const YamlSection right = root.Child("cam1");
    calibration.right = ReadCamera(right);
    calibration.right_from_left = right.Motion("T_cn_cnm1");
  }
  return calibration;
}

}  // namespace plumbline
