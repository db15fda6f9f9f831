// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace plumbline {
namespace {

// The keys of a model: of fx, fy, cx, cy, and of the coefficients in our order, with their groups.
struct CamodocalModel {
  const char* name;
  DistortionModel model;
  std::array<const char*, 4> intrinsics;
  std::vector<std::pair<const char*, std::vector<const char*>>> coefficients;
};

const std::vector<CamodocalModel>& CamodocalModels() {
  static const std::vector<CamodocalModel> models = {
      {"PINHOLE",
       DistortionModel::kRadTan,
       {"fx", "fy", "cx", "cy"},
       {{"distortion_parameters", {"k1", "k2", "p1", "p2"}}}},
      {"KANNALA_BRANDT",
       DistortionModel::kEquidistant,
       {"mu", "mv", "u0", "v0"},
       {{"projection_parameters", {"k2", "k3", "k4", "k5"}}}},
      {"MEI",
       DistortionModel::kOmni,
       {"gamma1", "gamma2", "u0", "v0"},
       {{"mirror_parameters", {"xi"}}, {"distortion_parameters", {"k1", "k2", "p1", "p2"}}}}};
  return models;
}

}  // namespace

Calibration ReadCamodocal(const YamlSection& root) {
  const std::string name = root.Text("model_type");
  const std::vector<CamodocalModel>& models = CamodocalModels();
  const auto found = std::find_if(models.begin(), models.end(), [&](const CamodocalModel& model) {
    return name == model.name;
  });
  if (found == models.end()) {
    root.Fail("model_type", "expected PINHOLE, KANNALA_BRANDT or MEI, found " + InQuotes(name));
  }
  CameraIntrinsics intrinsics;
  intrinsics.width = ReadLength(root, "image_width");
  intrinsics.height = ReadLength(root, "image_height");
  const YamlSection projection = root.Child("projection_parameters");
  intrinsics.fx = projection.Number(found->intrinsics[0]);
  intrinsics.fy = projection.Number(found->intrinsics[1]);
  intrinsics.cx = projection.Number(found->intrinsics[2]);
  intrinsics.cy = projection.Number(found->intrinsics[3]);
  intrinsics.model = found->model;
  std::vector<double> numbers;
  for (const auto& [group, keys] : found->coefficients) {
    const YamlSection section = root.Child(group);
    for (const char* key : keys) numbers.push_back(section.Number(key));
  }
  std::copy(numbers.begin(), numbers.end(), intrinsics.distortion.begin());
  if (found->model == DistortionModel::kRadTan) SetRadTan(numbers, intrinsics);
  const std::string group = "projection_parameters";
  Calibration calibration;
  calibration.left = CheckedCamera(
      root,
      {"image_width", {group, group, group, group}, found->coefficients.front().first},
      intrinsics);
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  return calibration;
}

}  // namespace plumbline
