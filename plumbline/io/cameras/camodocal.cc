// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <string>
#include <vector>

namespace plumbline {

Calibration ReadCamodocal(const YamlSection& root) {
  const std::string model = root.Text("model_type");
  const bool pinhole = model == "PINHOLE";
  if (!pinhole && model != "KANNALA_BRANDT") {
    root.Fail("model_type",
              "expected PINHOLE or KANNALA_BRANDT, found " + InQuotes(model) +
                  "; calibrate again with one of these");
  }
  CameraIntrinsics intrinsics;
  intrinsics.width = ReadLength(root, "image_width");
  intrinsics.height = ReadLength(root, "image_height");
  const YamlSection projection = root.Child("projection_parameters");
  intrinsics.fx = projection.Number(pinhole ? "fx" : "mu");
  intrinsics.fy = projection.Number(pinhole ? "fy" : "mv");
  intrinsics.cx = projection.Number(pinhole ? "cx" : "u0");
  intrinsics.cy = projection.Number(pinhole ? "cy" : "v0");
  std::vector<double> d;
  if (pinhole) {
    const YamlSection distortion = root.Child("distortion_parameters");
    for (const char* key : {"k1", "k2", "p1", "p2"}) d.push_back(distortion.Number(key));
    SetRadTan(d, intrinsics);
  } else {
    intrinsics.model = DistortionModel::kEquidistant;
    for (const char* key : {"k2", "k3", "k4", "k5"}) d.push_back(projection.Number(key));
    std::copy(d.begin(), d.end(), intrinsics.distortion.begin());
  }
  const std::string group = "projection_parameters";
  Calibration calibration;
  calibration.left =
      CheckedCamera(root, {"image_width", {group, group, group, group}, group}, intrinsics);
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  return calibration;
}

}  // namespace plumbline
