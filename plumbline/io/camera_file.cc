// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/camera_file.h"

#include "plumbline/base/error.h"
#include "plumbline/base/nearest_name.h"
#include "plumbline/io/builtin_cameras.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <Eigen/LU>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

// A YAML map with the place it came from, for messages. `prefix` is the dotted name of the map.
class Section {
 public:
  Section(const YAML::Node& node, std::string source, std::string prefix)
      : node_(node), source_(std::move(source)), prefix_(std::move(prefix)) {}

  static Section Parse(const std::string& yaml, const std::string& source) {
    YAML::Node node;
    try {
      node = YAML::Load(yaml);
    } catch (const YAML::Exception& error) {
      throw InputError(source + ":" + std::to_string(error.mark.line + 1) +
                       ": expected YAML, found an error: " + error.msg);
    }
    if (!node.IsMap()) throw InputError(source + ":1: expected 'key: value' rows of a camera file");
    return {node, source, ""};
  }

  bool Has(const std::string& key) const { return node_[key].IsDefined(); }

  [[noreturn]] void Fail(const std::string& key, const std::string& message) const {
    const YAML::Node value = node_[key];
    const int line = value.IsDefined() ? value.Mark().line : node_.Mark().line;
    throw InputError(source_ + ":" + std::to_string(line + 1) + ": " + prefix_ + key + ": " +
                     message);
  }

  Section Child(const std::string& key) const {
    if (!Has(key) || !node_[key].IsMap()) Fail(key, "expected a group of keys, found none");
    return {node_[key], source_, prefix_ + key + "."};
  }

  std::string Text(const std::string& key) const {
    if (!Has(key)) Fail(key, "expected a value, found none");
    return Scalar(key, node_[key]);
  }

  bool Bool(const std::string& key) const {
    const std::string text = Text(key);
    if (text != "true" && text != "false") Fail(key, "expected true or false, found " + text);
    return text == "true";
  }

  double Positive(const std::string& key) const {
    const std::string text = Text(key);
    const std::optional<double> value = ParseNumber(text);
    if (!value || *value <= 0) Fail(key, "expected a number above 0, found '" + text + "'");
    return *value;
  }

  std::vector<double> Numbers(const std::string& key, std::vector<std::size_t> counts) const {
    const std::string expected = fmt::format("expected {} numbers", fmt::join(counts, " or "));
    if (!Has(key) || !node_[key].IsSequence()) Fail(key, expected + ", found no list");
    std::vector<double> numbers;
    for (const YAML::Node& item : node_[key]) {
      const std::string text = Scalar(key, item);
      const std::optional<double> value = ParseNumber(text);
      if (!value) Fail(key, expected + ", found '" + text + "'");
      numbers.push_back(*value);
    }
    if (std::find(counts.begin(), counts.end(), numbers.size()) == counts.end()) {
      Fail(key, expected + ", found " + std::to_string(numbers.size()));
    }
    return numbers;
  }

  void RejectUnknown(const std::vector<std::string>& known) const {
    for (const auto& entry : node_) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "[...]";
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::optional<std::string> nearest = NearestName(key, known);
      throw InputError(source_ + ":" + std::to_string(entry.first.Mark().line + 1) +
                       ": unknown key '" + prefix_ + key + "'" +
                       (nearest ? "; did you mean '" + *nearest + "'?" : ""));
    }
  }

 private:
  std::string Scalar(const std::string& key, const YAML::Node& node) const {
    if (!node.IsScalar()) Fail(key, "expected one value, found a list or a group");
    return node.Scalar();
  }

  YAML::Node node_;
  std::string source_;
  std::string prefix_;
};

Rigid3 ReadMotion(const Section& section, const std::string& key) {
  const std::vector<double> m = section.Numbers(key, {16});
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = m[static_cast<std::size_t>(i)];
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (off > 1e-3 || rotation.determinant() < 0 || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    section.Fail(key, "expected a rigid motion (rotation, translation, last row 0 0 0 1)");
  }
  return {Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner<3, 1>()};
}

Camera ReadCamera(const Section& section, const std::string& size_key, DistortionModel model) {
  CameraIntrinsics intrinsics;
  const std::vector<double> size = section.Numbers(size_key, {2});
  const std::vector<double> k = section.Numbers("intrinsics", {4});
  for (const double length : size) {
    if (length < 1 || length > 100000 || length != std::floor(length)) {
      section.Fail(size_key, fmt::format("expected whole numbers above 0, found {}", length));
    }
  }
  intrinsics.width = static_cast<int>(size[0]);
  intrinsics.height = static_cast<int>(size[1]);
  intrinsics.fx = k[0];
  intrinsics.fy = k[1];
  intrinsics.cx = k[2];
  intrinsics.cy = k[3];
  intrinsics.model = model;
  if (model != DistortionModel::kNone) {
    const bool radtan = model == DistortionModel::kRadTan;
    const std::vector<double> d =
        section.Numbers("distortion_coefficients",
                        radtan ? std::vector<std::size_t>{4, 5} : std::vector<std::size_t>{4});
    std::copy(d.begin(), d.end(), intrinsics.distortion.begin());
  }
  try {
    return Camera(intrinsics);
  } catch (const InputError& error) {
    section.Fail("intrinsics", error.what());
  }
}

constexpr std::array<std::pair<DistortionModel, std::string_view>, 3> kDistortionNames = {
    {{DistortionModel::kNone, "none"},
     {DistortionModel::kRadTan, "radtan"},
     {DistortionModel::kEquidistant, "equidistant"}}};

Camera ReadOurCamera(const Section& section) {
  if (section.Has("model") && section.Text("model") != "pinhole") {
    section.Fail("model", "expected pinhole, found '" + section.Text("model") + "'");
  }
  const std::string name = section.Has("distortion") ? section.Text("distortion") : "none";
  for (const auto& [model, model_name] : kDistortionNames) {
    if (name != model_name) continue;
    if (model == DistortionModel::kNone && section.Has("distortion_coefficients")) {
      section.Fail("distortion_coefficients", "expected none without a distortion model");
    }
    return ReadCamera(section, "size", model);
  }
  section.Fail("distortion", "expected none, radtan or equidistant, found '" + name + "'");
}

std::vector<std::string> CameraKeyNames() {
  return {"model", "size", "intrinsics", "distortion", "distortion_coefficients"};
}

void ReadRight(const Section& root, Calibration& calibration) {
  if (root.Has("right")) {
    const Section right = root.Child("right");
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
    calibration.right_from_left = ReadMotion(root, "right_from_left");
  } else if (calibration.right) {
    root.Fail("right", "expected right_from_left (or baseline) with it, found none");
  }
  if (calibration.rectified && calibration.right) {
    const Rigid3& motion = calibration.right_from_left;
    if (AngularDistance(motion.rotation, Eigen::Quaterniond::Identity()) > 1e-6 ||
        motion.translation.tail<2>().norm() > 1e-6 || motion.translation.x() >= 0) {
      root.Fail("right_from_left", "expected a motion along -x, as the pair is rectified");
    }
  }
}

void AppendCamera(const Camera& camera, const std::string& indent, std::string& out) {
  const CameraIntrinsics& k = camera.intrinsics();
  out += indent + "model: pinhole\n";
  out += indent + fmt::format("size: [{}, {}]\n", k.width, k.height);
  out += indent + fmt::format("intrinsics: [{}, {}, {}, {}]\n", k.fx, k.fy, k.cx, k.cy);
  for (const auto& [model, name] : kDistortionNames) {
    if (model == k.model) out += indent + fmt::format("distortion: {}\n", name);
  }
  if (k.model == DistortionModel::kNone) return;
  const std::size_t count = k.model == DistortionModel::kRadTan ? 5 : 4;
  out += indent + fmt::format("distortion_coefficients: [{}]\n",
                              fmt::join(k.distortion.begin(), k.distortion.begin() + count, ", "));
}

std::string FormatMotion(const std::string& key, const Rigid3& motion) {
  std::vector<double> numbers;
  numbers.reserve(16);
  const Eigen::Matrix4d matrix = motion.Matrix();
  for (int i = 0; i < 16; ++i) numbers.push_back(matrix(i / 4, i % 4));
  return fmt::format("{}: [{}]\n", key, fmt::join(numbers, ", "));
}

}  // namespace

Calibration ParseCamera(const std::string& yaml, const std::string& source) {
  const Section root = Section::Parse(yaml, source);
  std::vector<std::string> known = CameraKeyNames();
  for (const char* key : {"rectified",
                          "rate_hz",
                          "depth_factor",
                          "right",
                          "right_from_left",
                          "baseline",
                          "body_from_left"}) {
    known.emplace_back(key);
  }
  root.RejectUnknown(known);
  Calibration calibration;
  calibration.left = ReadOurCamera(root);
  if (root.Has("rectified")) calibration.rectified = root.Bool("rectified");
  if (root.Has("rate_hz")) calibration.rate_hz = root.Positive("rate_hz");
  if (root.Has("depth_factor")) calibration.depth_factor = root.Positive("depth_factor");
  if (root.Has("body_from_left")) calibration.body_from_left = ReadMotion(root, "body_from_left");
  ReadRight(root, calibration);
  return calibration;
}

Calibration ReadCameraFile(const std::filesystem::path& path) {
  return ParseCamera(ReadTextFile(path), path.string());
}

Calibration FindCamera(const std::string& path_or_name) {
  std::error_code error;
  if (!std::filesystem::exists(path_or_name, error)) {
    for (const BuiltInCamera& file : BuiltInCameraFiles()) {
      if (file.name == path_or_name) return ParseCamera(file.yaml, file.name + ".yaml");
    }
    throw InputError(fmt::format("{}: no such camera file; built-in cameras: {}",
                                 path_or_name,
                                 fmt::join(BuiltInCameras(), ", ")));
  }
  return ReadCameraFile(path_or_name);
}

std::vector<std::string> BuiltInCameras() {
  std::vector<std::string> names;
  for (const BuiltInCamera& file : BuiltInCameraFiles()) names.push_back(file.name);
  return names;
}

EurocSensor ReadEurocSensor(const std::filesystem::path& path) {
  const Section root = Section::Parse(ReadTextFile(path), path.string());
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
  sensor.camera = ReadCamera(root, "resolution", *model);
  sensor.body_from_camera = ReadMotion(root.Child("T_BS"), "data");
  sensor.rate_hz = root.Positive("rate_hz");
  return sensor;
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
