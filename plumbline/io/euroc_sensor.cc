// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/euroc_sensor.h"

#include "plumbline/io/camera_section.h"
#include "plumbline/io/text_rows.h"

#include <optional>
#include <string>

namespace plumbline {

EurocSensor ReadEurocSensor(const std::filesystem::path& path) {
  return ReadEurocSensor(YamlSection::Parse(ReadTextFile(path), path.string()));
}

EurocSensor ReadEurocSensor(const YamlSection& root) {
  const std::string camera_model = root.Text("camera_model");
  if (camera_model != "pinhole") {
    root.Fail("camera_model", "expected pinhole, found '" + camera_model + "'");
  }
  const std::string name = root.Text("distortion_model");
  std::optional<DistortionModel> model;
  if (name == "radial-tangential" || name == "radtan") model = DistortionModel::kRadTan;
  if (name == "equidistant") model = DistortionModel::kEquidistant;
  if (name == "none") model = DistortionModel::kNone;
  if (!model) {
    root.Fail("distortion_model",
              "expected radial-tangential, equidistant or none, found '" + name + "'");
  }
  EurocSensor sensor;
  sensor.camera =
      ReadListedCamera(root, {"resolution", "intrinsics", "distortion_coefficients"}, *model);
  sensor.body_from_camera = root.Child("T_BS").Motion("data");
  sensor.rate_hz = root.Positive("rate_hz");
  return sensor;
}

}  // namespace plumbline
