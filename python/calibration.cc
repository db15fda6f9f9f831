// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/calibration.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/dataset.h"

#include "apps/command_line.h"
#include "arrays.h"
#include "bindings.h"
#include "sensor_kind.h"
#include "texts.h"
#include <string>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// The calibration for one kind of sensor.
Calibration ForSensor(Calibration calibration, const std::optional<std::string>& sensor) {
  const SensorKind richest = KindOf(calibration);
  const SensorKind wanted = sensor ? ParseChoice<SensorKind>("sensor", *sensor) : richest;
  if (wanted == SensorKind::kStereo && !calibration.right) {
    throw InputError("sensor: expected a calibration of two cameras for stereo, found one");
  }
  if (wanted == SensorKind::kRgbd && !calibration.depth_factor) {
    throw InputError("sensor: expected a calibration with a depth_factor for rgbd, found none");
  }
  if (wanted != SensorKind::kStereo) calibration.right.reset();
  if (wanted != SensorKind::kRgbd) calibration.depth_factor.reset();
  return calibration;
}

Calibration Load(const std::string& path_or_name, const std::optional<std::string>& sensor) {
  return ForSensor(FindCamera(path_or_name, sensor.value_or("stereo") == "stereo").calibration,
                   sensor);
}

Calibration Parse(const std::string& text, const std::optional<std::string>& sensor) {
  return ForSensor(ParseCamera(text, "calibration", sensor.value_or("stereo") == "stereo"), sensor);
}

Doubles Intrinsics(double fx, double fy, double cx, double cy) {
  Eigen::Matrix3d k;
  k << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return ToArray(k);
}

RectifiedCamera MakeCamera(
    double fx, double fy, double cx, double cy, int width, int height, double baseline) {
  for (const auto& [name, value] : {std::pair{"fx", fx}, {"fy", fy}}) {
    if (value > 0 && std::isfinite(value)) continue;
    throw InputError(fmt::format("{}: expected a number greater than 0, found {}", name, value));
  }
  for (const auto& [name, value] : {std::pair{"cx", cx}, {"cy", cy}, {"baseline", baseline}}) {
    if (std::isfinite(value)) continue;
    throw InputError(fmt::format("{}: expected a finite number, found {}", name, value));
  }
  if (baseline < 0) {
    throw InputError(fmt::format("baseline: expected 0 or more, found {}", baseline));
  }
  if (width < 1 || height < 1) {
    throw InputError(
        fmt::format("width, height: expected at least 1, found {} and {}", width, height));
  }
  return {fx, fy, cx, cy, baseline, width, height};
}

std::string ShowCalibration(const Calibration& c) {
  return fmt::format(
      "<Calibration {}, {} x {}>", NameOf(KindOf(c)), c.left.width(), c.left.height());
}

std::string ShowCamera(const RectifiedCamera& c) {
  return fmt::format(
      "RectifiedCamera(fx={}, fy={}, cx={}, cy={}, width={}, height={}, baseline={})",
      c.fx,
      c.fy,
      c.cx,
      c.cy,
      c.width,
      c.height,
      c.baseline);
}

void BindRectifiedCamera(py::module_& module) {
  py::class_<RectifiedCamera>(
      module, "RectifiedCamera", R"(An ideal pinhole, and beside it a second,
equal one `baseline` metres to its right (0: one camera). Camera frame: x right, y down,
z forward. Pixel centres at integer coordinates.)")
      .def(py::init(&MakeCamera),
           py::arg("fx"),
           py::arg("fy"),
           py::arg("cx"),
           py::arg("cy"),
           py::arg("width"),
           py::arg("height"),
           py::arg("baseline") = 0.0,
           "Focal lengths, principal point and size in pixels, baseline in metres.")
      .def_readonly("fx", &RectifiedCamera::fx)
      .def_readonly("fy", &RectifiedCamera::fy)
      .def_readonly("cx", &RectifiedCamera::cx)
      .def_readonly("cy", &RectifiedCamera::cy)
      .def_readonly("width", &RectifiedCamera::width)
      .def_readonly("height", &RectifiedCamera::height)
      .def_readonly("baseline", &RectifiedCamera::baseline)
      .def_property_readonly(
          "K",
          [](const RectifiedCamera& c) { return Intrinsics(c.fx, c.fy, c.cx, c.cy); },
          "(3, 3) intrinsic matrix, pixels; a new array.")
      .def("__repr__", ShowCamera);
}

}  // namespace

void BindCalibration(py::module_& module) {
  BindRectifiedCamera(module);
  py::class_<Calibration>(module, "Calibration", R"(What is known of the sensor: one camera, and
where there are, a second one or a depth image. Made by `Calibration.load`,
`Calibration.parse`, `plumbline.pinhole` or by opening a data set.)")
      .def_static("load",
                  &Load,
                  py::arg("path_or_name"),
                  py::arg("sensor") = py::none(),
                  R"(load(path_or_name, sensor=None) -> Calibration

Reads a camera file (of Plumbline, EuRoC, Kalibr, OpenCV, ROS or ORB-SLAM) or a built-in camera
by name.
`sensor`: "mono", "stereo" or "rgbd"; None: the richest that the file has.)")
      .def_static("parse",
                  &Parse,
                  py::arg("text"),
                  py::arg("sensor") = py::none(),
                  "parse(text, sensor=None) -> Calibration\n\nThe same from the text of a file.")
      .def_property_readonly(
          "sensor",
          [](const Calibration& c) { return NameOf(KindOf(c)); },
          "\"mono\", \"stereo\" or \"rgbd\"")
      .def_property_readonly("width", [](const Calibration& c) { return c.left.width(); })
      .def_property_readonly("height", [](const Calibration& c) { return c.left.height(); })
      .def_property_readonly(
          "K",
          [](const Calibration& c) {
            const CameraIntrinsics& k = c.left.intrinsics();
            return Intrinsics(k.fx, k.fy, k.cx, k.cy);
          },
          "(3, 3) intrinsic matrix of the left camera as delivered, pixels; a new array.")
      .def_property_readonly(
          "baseline",
          [](const Calibration& c) -> std::optional<double> {
            if (!c.right) return std::nullopt;
            return c.right_from_left.translation.norm();
          },
          "Distance of the two cameras in metres; None where there is one.")
      .def_readonly("depth_factor",
                    &Calibration::depth_factor,
                    "Value of a 16-bit depth image per metre; None where there is none.")
      .def_readonly("rate_hz", &Calibration::rate_hz)
      .def(
          "rectified_camera",
          [](const Calibration& c) { return Rectifier(c).camera(); },
          R"(rectified_camera() -> RectifiedCamera

The ideal camera of the rectified images, which features, maps and the building blocks refer to.)")
      .def("to_yaml", &FormatCamera, "The text of a camera file; `parse` of it gives the same.")
      .def("__repr__", ShowCalibration);
  module.def("built_in_cameras", &BuiltInCameras, "Names that `Calibration.load` knows.");
}

}  // namespace plumbline::python
