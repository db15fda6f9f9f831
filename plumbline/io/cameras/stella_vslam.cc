// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace plumbline {
namespace {

// A group of keys, `Camera: {fx: ...}`, or in files before 2021 rows with its name in each key,
// `Camera.fx: ...`.
class KeyGroup {
 public:
  KeyGroup(const YamlSection& root, const std::string& name)
      : section_(root.Has(name) ? root.Child(name) : root),
        prefix_(root.Has(name) ? "" : name + ".") {}

  const YamlSection& section() const { return section_; }
  std::string Key(const std::string& name) const { return prefix_ + name; }
  bool Has(const std::string& name) const { return section_.Has(Key(name)); }
  double Number(const std::string& name) const { return section_.Number(Key(name)); }
  std::string Text(const std::string& name) const { return section_.Text(Key(name)); }

 private:
  YamlSection section_;
  std::string prefix_;
};

bool IsFisheye(const KeyGroup& group) {
  const std::string name = group.Text("model");
  if (name == "perspective" || name == "fisheye") return name == "fisheye";
  group.section().Fail(group.Key("model"),
                       "expected perspective or fisheye, found " + InQuotes(name));
}

void SetDistortion(const std::vector<double>& numbers, bool fisheye, CameraIntrinsics& intrinsics) {
  if (!fisheye) return SetRadTan(numbers, intrinsics);
  intrinsics.model = DistortionModel::kEquidistant;
  std::copy(numbers.begin(), numbers.end(), intrinsics.distortion.begin());
}

Camera ReadStellaCamera(const KeyGroup& group) {
  const bool fisheye = IsFisheye(group);
  CameraIntrinsics in;
  in.width = ReadLength(group.section(), group.Key("cols"));
  in.height = ReadLength(group.section(), group.Key("rows"));
  in.fx = group.Number("fx");
  in.fy = group.Number("fy");
  in.cx = group.Number("cx");
  in.cy = group.Number("cy");
  std::vector<double> numbers;
  const std::vector<const char*> names =
      fisheye ? std::vector{"k1", "k2", "k3", "k4"} : std::vector{"k1", "k2", "p1", "p2", "k3"};
  for (const char* name : names) numbers.push_back(group.Number(name));
  SetDistortion(numbers, fisheye, in);
  return CheckedCamera(group.section(),
                       {group.Key("cols"),
                        {group.Key("fx"), group.Key("fy"), group.Key("cx"), group.Key("cy")},
                        group.Key("k1")},
                       in);
}

// One camera of the pair as delivered; `side` is left or right.
Camera ReadRawCamera(const KeyGroup& group, const std::string& side, const Camera& rectified) {
  const bool fisheye = group.Has("model") && IsFisheye(group);
  const std::string matrix = group.Key("K_" + side), numbers = group.Key("D_" + side);
  CameraIntrinsics in;
  in.width = rectified.width();
  in.height = rectified.height();
  ReadCameraMatrix(group.section(), matrix, in);
  const std::vector<std::size_t> counts =
      fisheye ? std::vector<std::size_t>{4} : std::vector<std::size_t>{4, 5};
  SetDistortion(group.section().Numbers(numbers, counts), fisheye, in);
  return CheckedCamera(group.section(), {matrix, {matrix, matrix, matrix, matrix}, numbers}, in);
}

void ReadStellaPair(const YamlSection& root, const KeyGroup& camera, Calibration& calibration) {
  const double baseline =
      camera.section().Positive(camera.Key("focal_x_baseline")) / calibration.left.intrinsics().fx;
  const Eigen::Vector3d shift(-baseline, 0, 0);
  const KeyGroup raw(root, "StereoRectifier");
  if (!raw.Has("K_left")) {
    if (!calibration.left.IsIdeal()) {
      camera.section().Fail(camera.Key("k1"),
                            "expected zeros of a rectified pair, or a StereoRectifier");
    }
    calibration.rectified = true;
    calibration.right = calibration.left;
    calibration.right_from_left.translation = shift;
    return;
  }
  const Camera rectified = calibration.left;
  const Eigen::Quaterniond left = raw.section().Rotation(raw.Key("R_left"));
  const Eigen::Quaterniond right = raw.section().Rotation(raw.Key("R_right")).conjugate();
  calibration.left = ReadRawCamera(raw, "left", rectified);
  calibration.right = ReadRawCamera(raw, "right", rectified);
  calibration.right_from_left = {(right * left).normalized(), right * shift};
}

}  // namespace

Calibration ReadStellaVslam(const YamlSection& root) {
  const KeyGroup camera(root, "Camera");
  Calibration calibration;
  calibration.left = ReadStellaCamera(camera);
  if (camera.Has("fps")) calibration.rate_hz = camera.section().Positive(camera.Key("fps"));
  const std::string setup = camera.Has("setup") ? camera.Text("setup") : "monocular";
  if (setup == "stereo") {
    ReadStellaPair(root, camera, calibration);
  } else if (setup == "RGBD") {
    const KeyGroup depth(root, "Preprocessing");
    calibration.depth_factor = depth.Has("depthmap_factor")
                                   ? depth.section().Positive(depth.Key("depthmap_factor"))
                                   : root.Positive("depthmap_factor");
  } else if (setup != "monocular") {
    camera.section().Fail(camera.Key("setup"),
                          "expected monocular, stereo or RGBD, found " + InQuotes(setup));
  }
  return calibration;
}

}  // namespace plumbline
