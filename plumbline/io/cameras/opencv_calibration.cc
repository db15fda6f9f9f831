// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"

#include <algorithm>
#include <string>
#include <vector>

namespace plumbline {
namespace {

// ROS names the model. OpenCV's programs mark that of cv::fisheye, or know only the other one.
bool IsFisheye(const YamlSection& root) {
  if (!root.Has("distortion_model")) {
    if (!root.Has("fisheye_model")) return false;
    const std::string text = root.Text("fisheye_model");
    const bool word = text == "true" || text == "false";
    return word ? root.Bool("fisheye_model") : root.Number("fisheye_model") != 0;
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

void ReadPinhole(const YamlSection& matrix, CameraIntrinsics& intrinsics) {
  const std::vector<double> d = matrix.Numbers("data", {4, 5, 8, 12, 14});
  if (const auto fault = SetOpenCvDistortion(d, intrinsics)) matrix.Fail("data", *fault);
}

void ReadOmni(const YamlSection& matrix, CameraIntrinsics& intrinsics) {
  const std::vector<double> d = matrix.Numbers("data", {4});
  std::copy(d.begin(), d.end(), intrinsics.distortion.begin() + 1);
  intrinsics.model = DistortionModel::kOmni;
}

}  // namespace

Calibration ReadOpenCvCalibration(const YamlSection& root) {
  const std::string matrix = "camera_matrix", coefficients = "distortion_coefficients";
  CameraIntrinsics intrinsics;
  intrinsics.width = ReadLength(root, "image_width");
  intrinsics.height = ReadLength(root, "image_height");
  ReadCameraMatrix(root, matrix, intrinsics);
  const bool omni = root.Has("xi");
  const auto read_distortion = omni ? ReadOmni : IsFisheye(root) ? ReadFisheye : ReadPinhole;
  read_distortion(root.Child(coefficients), intrinsics);
  // cv::omnidir writes xi as a matrix of one number.
  if (omni) {
    intrinsics.distortion[0] =
        root.IsGroup("xi") ? root.Matrix("xi", 1, 1)(0, 0) : root.Number("xi");
  }
  const bool xi_fault = omni && CoefficientFault(intrinsics);
  Calibration calibration;
  calibration.left = CheckedCamera(
      root,
      {"image_width", {matrix, matrix, matrix, matrix}, xi_fault ? "xi" : coefficients},
      intrinsics);
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  return calibration;
}

}  // namespace plumbline
