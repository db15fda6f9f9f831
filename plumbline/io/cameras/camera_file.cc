// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/camera_file.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_section.h"
#include "plumbline/io/cameras/yaml_section.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

Camera ReadOurCamera(const YamlSection& section) {
  if (section.Has("model")) CheckPinhole(section, "model");
  const std::string name = section.Has("distortion") ? section.Text("distortion") : "none";
  std::vector<std::string_view> names;
  for (const DistortionForm& form : kDistortionForms) {
    names.push_back(form.name);
    if (name != form.name) continue;
    if (form.model == DistortionModel::kNone && section.Has("distortion_coefficients")) {
      section.Fail("distortion_coefficients", "expected none without a distortion model");
    }
    return ReadListedCamera(section, {"size", "intrinsics", "distortion_coefficients"}, form.model);
  }
  section.Fail("distortion",
               fmt::format("expected one of {}, found {}", fmt::join(names, ", "), InQuotes(name)));
}

std::vector<std::string> CameraKeyNames() {
  return {"model", "size", "intrinsics", "distortion", "distortion_coefficients"};
}

void ReadRight(const YamlSection& root, Calibration& calibration) {
  if (root.Has("right")) {
    const YamlSection right = root.Child("right");
    right.RejectUnknown(CameraKeyNames());
    calibration.right = ReadOurCamera(right);
  }
  if (root.Has("baseline")) {
    if (root.Has("right_from_left"))
      root.Fail("baseline",
                "expected only one of baseline and "
                "right_from_left, found both");
    if (!calibration.rectified) {
      root.Fail("baseline", "expected `rectified: true`; give right_from_left otherwise");
    }
    if (!calibration.right) calibration.right = calibration.left;
    calibration.right_from_left.translation.x() = -root.Positive("baseline");
  } else if (root.Has("right_from_left")) {
    if (!calibration.right) root.Fail("right_from_left", "expected a camera `right` with it");
    calibration.right_from_left = root.Motion("right_from_left");
  } else if (calibration.right) {
    root.Fail("right", "expected right_from_left (or baseline) with it, found none");
  }
  if (const auto fault = RectifiedFault(calibration)) root.Fail("rectified", *fault);
  if (calibration.rectified && calibration.right) {
    CheckRectifiedPair(root, "right_from_left", calibration.right_from_left);
  }
}

void AppendCamera(const Camera& camera, const std::string& indent, std::string& out) {
  const CameraIntrinsics& k = camera.intrinsics();
  out += indent + "model: pinhole\n";
  out += indent + fmt::format("size: [{}, {}]\n", k.width, k.height);
  out += indent + fmt::format("intrinsics: [{}, {}, {}, {}]\n", k.fx, k.fy, k.cx, k.cy);
  const DistortionForm& form = FormOf(k.model);
  out += indent + fmt::format("distortion: {}\n", form.name);
  if (k.model == DistortionModel::kNone) return;
  out += indent + fmt::format("distortion_coefficients: [{}]\n",
                              fmt::join(k.distortion.begin(),
                                        k.distortion.begin() + static_cast<int>(form.most),
                                        ", "));
}

std::string FormatMotion(const std::string& key, const Rigid3& motion) {
  std::vector<double> numbers;
  numbers.reserve(16);
  const Eigen::Matrix4d matrix = motion.Matrix();
  for (int i = 0; i < 16; ++i) numbers.push_back(matrix(i / 4, i % 4));
  return fmt::format("{}: [{}]\n", key, fmt::join(numbers, ", "));
}

Calibration ReadOurs(const YamlSection& root) {
  std::vector<std::string> known = CameraKeyNames();
  for (const char* key : {"rectified",
                          "rate_hz",
                          "depth_factor",
                          "right",
                          "right_from_left",
                          "baseline",
                          "body_from_left",
                          "imu"}) {
    known.emplace_back(key);
  }
  root.RejectUnknown(known);
  Calibration calibration;
  calibration.left = ReadOurCamera(root);
  if (root.Has("rectified")) calibration.rectified = root.Bool("rectified");
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  if (root.Has("body_from_left")) calibration.body_from_left = root.Motion("body_from_left");
  ReadRight(root, calibration);
  return calibration;
}

Calibration ReadEuroc(const YamlSection& root) {
  const EurocSensor sensor = ReadEurocSensor(root);
  Calibration calibration;
  calibration.left = sensor.camera;
  calibration.rate_hz = sensor.rate_hz;
  calibration.body_from_left = sensor.body_from_camera;
  return calibration;
}

[[noreturn]] Calibration RefuseKitti(const YamlSection& root) {
  root.Fail("P0",
            "expected a camera file, found a KITTI calib.txt; it is read with the images of its "
            "folder, as it has no image size");
}

// A format of camera files. A file that has one of the keys is of this format.
struct CameraFormat {
  std::string_view name;
  std::vector<std::string> keys;
  Calibration (*read)(const YamlSection& root);
  CalibrationKeys numbers;
};

// Returns the first format that fits. Our own format has no keys here and comes last.
const CameraFormat& FormatOf(const YamlSection& root) {
  static const std::vector<CameraFormat> formats = {
      {"Basalt calibration",
       {"value0"},
       ReadBasalt,
       {.pair = {"value0/T_imu_cam"},
        .rate = {"rate_hz"},
        .depth_factor = {"depth_factor"},
        .lever = {}}},
      {"stella_vslam settings",
       {"Camera", "Camera.model"},
       ReadStellaVslam,
       {.pair = {"Camera.focal_x_baseline", "Camera/focal_x_baseline"},
        .rate = {"Camera.fps", "Camera/fps"},
        .depth_factor = {"depthmap_factor", "Preprocessing/depthmap_factor"},
        .lever = {}}},
      {"Kalibr camchain",
       {"cam0", "cam1"},
       ReadKalibr,
       {.pair = {"cam1/T_cn_cnm1", "cam1/T_cam_imu", "cam1/T_imu_cam"},
        .rate = {"rate_hz", "cam0/rate_hz"},
        .depth_factor = {"depth_factor", "cam0/depth_factor"},
        .lever = {}}},
      {"ORB-SLAM settings",
       {"File.version", "Camera.type", "Camera.fx", "Camera1.fx", "LEFT.K"},
       ReadOrbSlamSettings,
       {.pair = {"RIGHT.P", "Stereo.T_c1_c2", "Tlr", "Stereo.b", "Camera.bf"},
        .rate = {"Camera.fps"},
        .depth_factor = {"RGBD.DepthMapFactor", "DepthMapFactor"},
        .lever = {}}},
      {"EuRoC sensor.yaml",
       {"camera_model", "T_BS"},
       ReadEuroc,
       {.pair = {}, .rate = {"rate_hz"}, .depth_factor = {}, .lever = {"T_BS"}}},
      {"CamOdoCal file",
       {"model_type", "projection_parameters"},
       ReadCamodocal,
       {.pair = {}, .rate = {"rate_hz"}, .depth_factor = {"depth_factor"}, .lever = {}}},
      {"OpenCV or ROS calibration",
       {"camera_matrix"},
       ReadOpenCvCalibration,
       {.pair = {}, .rate = {"rate_hz"}, .depth_factor = {"depth_factor"}, .lever = {}}},
      {"KITTI calib.txt", {"P0"}, RefuseKitti, {}},
      {"Plumbline camera file",
       {},
       ReadOurs,
       {.pair = {"baseline", "right_from_left"},
        .rate = {"rate_hz"},
        .depth_factor = {"depth_factor"},
        .lever = {"body_from_left"}}}};
  for (const CameraFormat& format : formats) {
    const auto has = [&](const std::string& key) { return root.Has(key); };
    if (std::any_of(format.keys.begin(), format.keys.end(), has)) return format;
  }
  return formats.back();
}

Calibration ReadAs(const CameraFormat& format, const YamlSection& root, bool use_pair) {
  Calibration calibration = format.read(root);
  CheckCalibration(root, format.numbers, calibration, use_pair);
  return calibration;
}

}  // namespace

Calibration ParseCamera(const std::string& yaml, const std::string& source, bool use_pair) {
  if (IsColmapCameras(yaml)) return ReadColmapCameras(yaml, source);
  const YamlSection root = YamlSection::Parse(yaml, source);
  return ReadAs(FormatOf(root), root, use_pair);
}

CameraFile ReadCameraFile(const std::filesystem::path& path, bool use_pair) {
  const std::string text = ReadInputFile(path, kLargestSettings);
  if (IsColmapCameras(text)) {
    return {ReadColmapCameras(text, path.string()),
            fmt::format("{} (COLMAP cameras.txt)", path.string())};
  }
  const YamlSection root = YamlSection::Parse(text, path.string());
  const CameraFormat& format = FormatOf(root);
  return {ReadAs(format, root, use_pair), fmt::format("{} ({})", path.string(), format.name)};
}

CameraFile FindCamera(const std::string& path_or_name, bool use_pair) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_or_name, error);
  const bool exists = std::filesystem::exists(status);
  // A folder is no camera file: data are often in one that has the name of their camera.
  if (!exists || std::filesystem::is_directory(status)) {
    for (const auto& [name, yaml] : BuiltInCameraFiles()) {
      if (name != path_or_name) continue;
      return {ParseCamera(yaml, name + ".yaml"), name + " (built-in camera)"};
    }
  }
  if (!exists) {
    throw InputError(fmt::format("{}: no such camera file; built-in cameras: {}",
                                 Printable(path_or_name),
                                 fmt::join(BuiltInCameras(), ", ")));
  }
  return ReadCameraFile(path_or_name, use_pair);
}

std::optional<std::filesystem::path> CameraFileIn(const std::filesystem::path& folder) {
  std::error_code error;
  for (const char* name : {"camera.yaml", "camchain.yaml"}) {
    if (std::filesystem::exists(folder / name, error)) return folder / name;
  }
  return std::nullopt;
}

std::vector<std::string> BuiltInCameras() {
  std::vector<std::string> names;
  for (const auto& file : BuiltInCameraFiles()) names.push_back(file.first);
  return names;
}

std::string FormatCamera(const Calibration& calibration) {
  std::string out;
  AppendCamera(calibration.left, "", out);
  out += fmt::format("rectified: {}\n", calibration.rectified);
  if (calibration.rate_hz) out += fmt::format("rate_hz: {}\n", *calibration.rate_hz);
  if (calibration.depth_factor) out += fmt::format("depth_factor: {}\n", *calibration.depth_factor);
  if (calibration.right) {
    out += "right:\n";
    AppendCamera(*calibration.right, "  ", out);
    out += FormatMotion("right_from_left", calibration.right_from_left);
  }
  if (calibration.body_from_left) {
    out += FormatMotion("body_from_left", *calibration.body_from_left);
  }
  return out;
}

}  // namespace plumbline
