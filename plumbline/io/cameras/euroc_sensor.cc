// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/input_file.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

namespace plumbline {

EurocSensor ReadEurocSensor(const std::filesystem::path& path) {
  return ReadEurocSensor(YamlSection::Parse(ReadInputFile(path, kLargestSettings), path.string()));
}

EurocSensor ReadEurocSensor(const YamlSection& root) {
  // Some tools write Kalibr's name into files of this form.
  const bool short_name = root.Has("distortion_model") && root.Text("distortion_model") == "radtan";
  EurocSensor sensor;
  sensor.camera = ReadModelCamera(root,
                                  {"resolution", "intrinsics", "distortion_coefficients"},
                                  short_name ? "radtan" : "radial-tangential");
  sensor.body_from_camera = root.Child("T_BS").Motion("data");
  sensor.rate_hz = root.Positive("rate_hz");
  if (const auto fault = LeverFault(sensor.body_from_camera)) root.Fail("T_BS", *fault);
  if (const auto fault = RateFault(sensor.rate_hz)) root.Fail("rate_hz", *fault);
  return sensor;
}

}  // namespace plumbline
