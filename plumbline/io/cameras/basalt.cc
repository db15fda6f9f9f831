// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

// The model of a camera_type, and the keys of its coefficients in our order.
struct BasaltModel {
  const char* name;
  DistortionModel model;
  std::vector<const char*> keys;
};

const std::vector<BasaltModel>& BasaltModels() {
  using enum DistortionModel;
  static const std::vector<BasaltModel> models = {
      {"pinhole", kNone, {}},
      {"pinhole-radtan8", kRational, {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
      {"kb4", kEquidistant, {"k1", "k2", "k3", "k4"}},
      {"ds", kDoubleSphere, {"xi", "alpha"}},
      {"eucm", kEucm, {"alpha", "beta"}},
      {"ucm", kEucm, {"alpha"}},  // EUCM with beta = 1
      {"fov", kFov, {"w"}}};
  return models;
}

Camera ReadBasaltCamera(const YamlSection& section, int width, int height) {
  const std::string name = section.Text("camera_type");
  for (const BasaltModel& model : BasaltModels()) {
    if (name != model.name) continue;
    const YamlSection numbers = section.Child("intrinsics");
    CameraIntrinsics in;
    in.width = width;
    in.height = height;
    in.fx = numbers.Number("fx");
    in.fy = numbers.Number("fy");
    in.cx = numbers.Number("cx");
    in.cy = numbers.Number("cy");
    in.model = model.model;
    for (std::size_t i = 0; i < model.keys.size(); ++i) {
      in.distortion[i] = numbers.Number(model.keys[i]);
    }
    if (name == "ucm") in.distortion[1] = 1;
    // The key of the coefficient that is out of bounds: the message names it.
    std::string last = model.keys.empty() ? "fx" : model.keys.front();
    const std::string fault = CoefficientFault(in).value_or("");
    for (const auto& key : model.keys) {
      if (fault.find(fmt::format("expected {} ", key)) != std::string::npos) last = key;
    }
    return CheckedCamera(numbers, {"fx", {"fx", "fy", "cx", "cy"}, last}, in);
  }
  section.Fail(
      "camera_type",
      "expected pinhole, pinhole-radtan8, kb4, ds, eucm, ucm or fov, found " + InQuotes(name));
}

Rigid3 ReadBasaltPose(const YamlSection& section) {
  const Eigen::Quaterniond rotation(
      section.Number("qw"), section.Number("qx"), section.Number("qy"), section.Number("qz"));
  if (!IsRotation(rotation)) {
    section.Fail("qw", "expected qx, qy, qz, qw of a rotation, found another length than 1");
  }
  return {rotation.normalized(),
          {section.Number("px"), section.Number("py"), section.Number("pz")}};
}

}  // namespace

Calibration ReadBasalt(const YamlSection& root) {
  const YamlSection rig = root.Child("value0");
  const std::vector<YamlSection> cameras = rig.Items("intrinsics");
  if (cameras.empty()) rig.Fail("intrinsics", "expected a camera, found none");
  const Eigen::MatrixXd sizes = rig.Matrix("resolution", static_cast<int>(cameras.size()), 2);
  const auto camera = [&](int i) {
    return ReadBasaltCamera(cameras[static_cast<std::size_t>(i)],
                            CheckedLength(rig, "resolution", sizes(i, 0)),
                            CheckedLength(rig, "resolution", sizes(i, 1)));
  };
  Calibration calibration;
  calibration.left = camera(0);
  if (cameras.size() > 1) {
    const std::vector<YamlSection> poses = rig.Items("T_imu_cam");
    if (poses.size() < 2) rig.Fail("T_imu_cam", "expected the poses of two cameras, found one");
    calibration.right = camera(1);
    calibration.right_from_left = Inverse(ReadBasaltPose(poses[1])) * ReadBasaltPose(poses[0]);
  }
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  return calibration;
}

}  // namespace plumbline
