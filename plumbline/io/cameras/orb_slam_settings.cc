// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

enum class Projection { kPinhole, kFisheye, kRectified };

Projection ReadProjection(const YamlSection& root) {
  if (!root.Has("Camera.type")) return Projection::kPinhole;
  const std::string name = root.Text("Camera.type");
  if (name == "PinHole" || name == "Pinhole") return Projection::kPinhole;
  if (name == "KannalaBrandt8") return Projection::kFisheye;
  if (name == "Rectified") return Projection::kRectified;
  root.Fail("Camera.type",
            "expected PinHole, KannalaBrandt8 or Rectified, found " + InQuotes(name));
}

// Reads a size by the first of two keys that is there.
int ReadEitherLength(const YamlSection& root, const std::string& key, const std::string& other) {
  return ReadLength(root, root.Has(other) && !root.Has(key) ? other : key);
}

// Reads the coefficients prefix + "k1", ...; if all are zero there is no distortion.
void ReadDistortion(const YamlSection& root,
                    const std::string& prefix,
                    Projection projection,
                    CameraIntrinsics& intrinsics) {
  if (projection == Projection::kRectified) return;
  const bool fisheye = projection == Projection::kFisheye;
  const std::array<const char*, 5> names =
      fisheye ? std::array{"k1", "k2", "k3", "k4", ""} : std::array{"k1", "k2", "p1", "p2", "k3"};
  const std::size_t needed = 4;
  const auto given = [&](const char* name) { return root.Has(prefix + name); };
  if (!fisheye && std::none_of(names.begin(), names.end(), given)) return;
  for (std::size_t i = 0; i < needed; ++i) {
    intrinsics.distortion[i] = root.Number(prefix + names[i]);
  }
  if (!fisheye && given(names[4])) intrinsics.distortion[4] = root.Number(prefix + names[4]);
  intrinsics.model = fisheye ? DistortionModel::kEquidistant : DistortionModel::kRadTan;
  const bool ideal = std::all_of(
      intrinsics.distortion.begin(), intrinsics.distortion.end(), [](double k) { return k == 0; });
  if (ideal && !fisheye) intrinsics.model = DistortionModel::kNone;
}

std::array<std::string, 4> IntrinsicsKeys(const std::string& prefix) {
  return {prefix + "fx", prefix + "fy", prefix + "cx", prefix + "cy"};
}

// Returns true if the file has any of these keys. If so, a missing key belongs to them.
bool HasCamera(const YamlSection& root, const std::string& prefix) {
  const auto keys = IntrinsicsKeys(prefix);
  return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return root.Has(key); });
}

Camera ReadCamera(const YamlSection& root, const std::string& prefix, Projection projection) {
  CameraIntrinsics intrinsics;
  intrinsics.width = ReadEitherLength(root, "Camera.width", "LEFT.width");
  intrinsics.height = ReadEitherLength(root, "Camera.height", "LEFT.height");
  intrinsics.fx = root.Number(prefix + "fx");
  intrinsics.fy = root.Number(prefix + "fy");
  intrinsics.cx = root.Number(prefix + "cx");
  intrinsics.cy = root.Number(prefix + "cy");
  ReadDistortion(root, prefix, projection, intrinsics);
  const std::string width = root.Has("Camera.width") ? "Camera.width" : "LEFT.width";
  return CheckedCamera(root, {width, IntrinsicsKeys(prefix), prefix + "k1"}, intrinsics);
}

// A camera of the old stereo form, and how it is turned and shifted into the rectified pair.
struct RectifiedBy {
  Camera camera;
  Eigen::Quaterniond rotation;  // rectified from raw
  double shift = 0;             // shift of the rectified camera along x, metres
};

RectifiedBy ReadRectification(const YamlSection& root, const std::string& side) {
  const std::string key = side + "K";
  CameraIntrinsics intrinsics;
  ReadCameraMatrix(root, key, intrinsics);
  intrinsics.width = ReadEitherLength(root, side + "width", "Camera.width");
  intrinsics.height = ReadEitherLength(root, side + "height", "Camera.height");
  SetRadTan(root.Child(side + "D").Numbers("data", {4, 5}), intrinsics);
  const Eigen::MatrixXd P = root.Matrix(side + "P", 3, 4);
  if (!(P(0, 0) > 0) || P(1, 3) != 0 || P(2, 3) != 0) {
    root.Fail(side + "P", "expected the projection of a camera shifted along x");
  }
  return {CheckedCamera(root, {side + "width", {key, key, key, key}, side + "D"}, intrinsics),
          root.Rotation(side + "R"),
          P(0, 3) / P(0, 0)};
}

void ReadRectifiedPair(const YamlSection& root, Calibration& calibration) {
  const RectifiedBy left = ReadRectification(root, "LEFT.");
  const RectifiedBy right = ReadRectification(root, "RIGHT.");
  const double along_x = right.shift - left.shift;
  if (!(along_x < 0)) root.Fail("RIGHT.P", "expected a right camera, found one left of LEFT.P");
  const Eigen::Quaterniond raw_right_from_rectified = right.rotation.conjugate();
  calibration.left = left.camera;
  calibration.right = right.camera;
  calibration.right_from_left = {(raw_right_from_rectified * left.rotation).normalized(),
                                 raw_right_from_rectified * Eigen::Vector3d(along_x, 0, 0)};
}

// Makes the pair of one camera and a baseline.
void MakeRectifiedPair(const YamlSection& root, const std::string& key, Calibration& calibration) {
  if (!calibration.left.IsIdeal()) {
    root.Fail(key, "expected a rectified camera with it (no distortion), or a second camera");
  }
  const double value = root.Positive(key);
  const double baseline = key == "Camera.bf" ? value / calibration.left.intrinsics().fx : value;
  calibration.rectified = true;
  calibration.right = calibration.left;
  calibration.right_from_left.translation.x() = -baseline;
}

// Returns the first of `keys` that the file has.
std::optional<std::string> FirstOf(const YamlSection& root, const std::vector<std::string>& keys) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return root.Has(key); });
  return found == keys.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

Calibration ReadOrbSlamSettings(const YamlSection& root) {
  Calibration calibration;
  if (root.Has("Camera.fps")) calibration.rate_hz = root.Positive("Camera.fps");
  if (root.Has("LEFT.K")) {
    ReadRectifiedPair(root, calibration);
    return calibration;
  }
  const Projection projection = ReadProjection(root);
  const std::string first = HasCamera(root, "Camera1.") ? "Camera1." : "Camera.";
  calibration.left = ReadCamera(root, first, projection);
  if (HasCamera(root, "Camera2.")) {
    calibration.right = ReadCamera(root, "Camera2.", projection);
    const bool old = root.Has("Tlr") && !root.Has("Stereo.T_c1_c2");
    calibration.right_from_left =
        Inverse(old ? root.Motion("Tlr", 3) : root.Motion("Stereo.T_c1_c2"));
    return calibration;
  }
  calibration.rectified = projection == Projection::kRectified;
  if (const auto factor = FirstOf(root, {"RGBD.DepthMapFactor", "DepthMapFactor"})) {
    calibration.depth_factor = root.Positive(*factor);
  } else if (const auto baseline = FirstOf(root, {"Stereo.b", "Camera.bf"})) {
    MakeRectifiedPair(root, *baseline, calibration);
  }
  return calibration;
}

}  // namespace plumbline
