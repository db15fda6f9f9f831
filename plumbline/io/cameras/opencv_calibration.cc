// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::size_t kMostRadTan = 5;  // k1, k2, p1, p2, k3

// ROS names the model. OpenCV's programs mark that of cv::fisheye, or know only the other one.
bool IsFisheye(const YamlSection& root) {
  if (!root.Has("distortion_model")) {
    return root.Has("fisheye_model") && root.Number("fisheye_model") != 0;
  }
  const std::string name = root.Text("distortion_model");
  if (name == "equidistant" || name == "fisheye") return true;
  if (name == "plumb_bob" || name == "rational_polynomial") return false;
  root.Fail(
      "distortion_model",
      "expected plumb_bob, rational_polynomial, equidistant or fisheye, found " + InQuotes(name));
}

void ReadFisheye(const YamlSection& matrix, CameraIntrinsics& intrinsics) {
  const std::vector<double> d = matrix.Numbers("data", {4});
  std::copy(d.begin(), d.end(), intrinsics.distortion.begin());
  intrinsics.model = DistortionModel::kEquidistant;
}

// The rational, thin prism and tilted models have more coefficients, and none of them is here.
void ReadRadTan(const YamlSection& matrix, CameraIntrinsics& intrinsics) {
  std::vector<double> d = matrix.Numbers("data", {4, 5, 8, 12, 14});
  for (std::size_t i = kMostRadTan; i < d.size(); ++i) {
    if (d[i] == 0) continue;
    matrix.Fail("data",
                fmt::format("expected k1, k2, p1, p2, k3 and then zeros, found {:g} as number {}; "
                            "calibrate without the rational, thin prism and tilted models",
                            d[i],
                            i + 1));
  }
  d.resize(std::min(d.size(), kMostRadTan));
  SetRadTan(d, intrinsics);
}

}  // namespace

Calibration ReadOpenCvCalibration(const YamlSection& root) {
  const std::string matrix = "camera_matrix", coefficients = "distortion_coefficients";
  CameraIntrinsics intrinsics;
  intrinsics.width = ReadLength(root, "image_width");
  intrinsics.height = ReadLength(root, "image_height");
  ReadCameraMatrix(root, matrix, intrinsics);
  const auto read_distortion = IsFisheye(root) ? ReadFisheye : ReadRadTan;
  read_distortion(root.Child(coefficients), intrinsics);
  Calibration calibration;
  calibration.left = CheckedCamera(
      root, {"image_width", {matrix, matrix, matrix, matrix}, coefficients}, intrinsics);
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  return calibration;
}

}  // namespace plumbline
