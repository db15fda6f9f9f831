// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/playback_schedule.h"

#include "apps/command_line.h"
#include "arrays.h"
#include "bindings.h"
#include "frames.h"
#include "iteration.h"
#include "texts.h"
#include "trajectories.h"
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// Preparation of images, by the names of Python.
struct Preparation {
  std::optional<std::filesystem::path> ground_truth;
  std::string rotate;
  std::optional<int> max_width;
  std::optional<double> view_angle;
  py::object mask;
};

// Paths, or topics, of one mask or of a sequence of them.
std::vector<std::string> ReadMasks(const py::object& mask) {
  const auto path = [](const py::handle& one) {
    try {
      return one.cast<std::filesystem::path>().string();
    } catch (const py::cast_error&) {
      throw InputError("mask: expected a path, or a path for each camera, found " + Describe(one));
    }
  };
  std::vector<std::string> masks;
  if (mask.is_none()) return masks;
  if (!py::isinstance<py::tuple>(mask) && !py::isinstance<py::list>(mask)) return {path(mask)};
  for (const py::handle& one : mask) masks.push_back(path(one));
  return masks;
}

std::shared_ptr<Dataset> Open(const std::filesystem::path& path,
                              const std::optional<std::string>& sensor,
                              const std::optional<std::string>& camera,
                              const std::optional<std::string>& format,
                              const std::vector<std::string>& topics,
                              const Preparation& preparation) {
  DatasetOptions options;
  if (preparation.ground_truth) options.ground_truth = preparation.ground_truth->string();
  options.topics = topics;
  if (sensor) options.sensor = ParseChoice<SensorKind>("sensor", *sensor);
  if (format) options.format = ParseChoice<DatasetFormat>("format", *format);
  options.camera = camera;
  options.rotate = ParseChoice<Rotation>("rotate", preparation.rotate);
  options.max_width = preparation.max_width;
  options.view_angle_deg = preparation.view_angle;
  options.masks = ReadMasks(preparation.mask);
  const py::gil_scoped_release release;
  return OpenDataset(path, options);
}

std::size_t IndexOf(const Dataset& dataset, py::ssize_t i) {
  const auto size = static_cast<py::ssize_t>(dataset.size());
  if (i < -size || i >= size) {
    throw py::index_error(fmt::format("frame: expected -{} to {}, found {}", size, size - 1, i));
  }
  return static_cast<std::size_t>(i < 0 ? i + size : i);
}

// The frame, or the reason why it is to be skipped (ImageFailure::reason).
std::variant<PyFrame, std::string> ReadOrReason(const Dataset& dataset, py::ssize_t i) {
  const std::size_t index = IndexOf(dataset, i);
  const py::gil_scoped_release release;
  auto frame = dataset.Read(index);
  if (!frame) return frame.error().reason();
  return PyFrame{*frame};
}

PyFrame Read(const Dataset& dataset, py::ssize_t i) {
  const std::size_t index = IndexOf(dataset, i);
  const py::gil_scoped_release release;
  auto frame = dataset.Read(index);
  if (frame) return {*frame};
  throw InputError(frame.error().path.string() + ": " + frame.error().why);
}

std::optional<PoseList> TruthOf(const Dataset& dataset) {
  const auto& truth = dataset.info().ground_truth;
  if (!truth) return std::nullopt;
  return PoseList{truth->OfCamera(dataset.calibration())};
}

py::dict ErrorOptionsOf(const Dataset& dataset) {
  const TrajectoryErrorOptions options = ErrorOptionsFor(dataset.sensor(), dataset.info().format);
  py::dict dict;
  dict["alignment"] = NameOf(options.alignment);
  dict["max_gap_s"] = static_cast<double>(options.max_gap_ns) / 1e9;
  return dict;
}

// Times of Python's time.monotonic_ns(), as a schedule takes and gives them.
PlaybackSchedule::Clock::time_point TimeOf(std::int64_t ns) {
  return PlaybackSchedule::Clock::time_point(std::chrono::nanoseconds(ns));
}
std::int64_t NanosecondsOf(PlaybackSchedule::Clock::time_point time) {
  return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

py::array Right(const py::object& self) {
  return View(*self.cast<const PyFrame&>().images.right, self);
}

void BindFrame(py::module_& module) {
  py::class_<PyFrame, std::shared_ptr<PyFrame>>(
      module, "Frame", "The images of one instant, before rectification.")
      .def_property_readonly("stamp_ns", [](const PyFrame& frame) { return frame.images.stamp_ns; })
      .def_property_readonly(
          "left",
          [](const py::object& self) {
            return View(self.cast<const PyFrame&>().images.left, self);
          },
          "(rows, columns) uint8; read-only, keeps the frame alive.")
      .def_property_readonly(
          "right",
          [](const py::object& self) -> py::object {
            if (!self.cast<const PyFrame&>().images.right) return py::none();
            return Right(self);
          },
          "(rows, columns) uint8 or None; read-only, keeps the frame alive.")
      .def_property_readonly(
          "depth",
          [](const py::object& self) -> py::object {
            const auto& depth = self.cast<const PyFrame&>().images.depth;
            if (!depth) return py::none();
            return View(*depth, self);
          },
          "(rows, columns) float32 in metres along z, 0: not measured, or None; read-only, keeps "
          "the frame alive.")
      .def_property_readonly(
          "mask",
          [](const py::object& self) -> py::object {
            const auto& mask = self.cast<const PyFrame&>().images.left_mask;
            if (!mask) return py::none();
            return View(*mask, self);
          },
          "(rows, columns) uint8 of the left image, 0 where nothing is to be used, or None; "
          "read-only, keeps the frame alive.")
      .def("__repr__", [](const PyFrame& frame) {
        const SensorFrame& images = frame.images;
        return fmt::format("<Frame at {} s: {}{} of {} x {}>",
                           FormatStamp(images.stamp_ns),
                           images.right ? "pair" : "image",
                           images.depth ? " with depth" : "",
                           images.left.width(),
                           images.left.height());
      });
}

void BindPlaybackSchedule(py::module_& module) {
  py::class_<PlaybackSchedule>(
      module,
      "_PlaybackSchedule",
      "When the frames of a recording that is played live are read and given out, in "
      "time.monotonic_ns().")
      .def(py::init<>())
      .def(
          "read_at",
          [](const PlaybackSchedule& schedule, std::int64_t stamp_ns) {
            return NanosecondsOf(schedule.ReadAt(stamp_ns));
          },
          py::arg("stamp_ns"),
          "When to begin to read the frame of this stamp.")
      .def(
          "due_once_read",
          [](PlaybackSchedule& schedule,
             std::int64_t stamp_ns,
             std::int64_t begin_ns,
             std::int64_t end_ns) {
            return NanosecondsOf(schedule.DueOnceRead(stamp_ns, TimeOf(begin_ns), TimeOf(end_ns)));
          },
          py::arg("stamp_ns"),
          py::arg("begin_ns"),
          py::arg("end_ns"),
          "When the frame of this stamp is due, which was read between these times.");
}

void BindOpen(py::module_& module) {
  module.def(
      "open",
      [](const std::filesystem::path& path,
         const std::optional<std::string>& sensor,
         const std::optional<std::string>& camera,
         const std::optional<std::string>& format,
         const std::vector<std::string>& topics,
         const std::optional<std::filesystem::path>& ground_truth,
         const std::string& rotate,
         std::optional<int> max_width,
         std::optional<double> view_angle,
         const py::object& mask) {
        return Open(path,
                    sensor,
                    camera,
                    format,
                    topics,
                    {ground_truth, rotate, max_width, view_angle, mask});
      },
      py::arg("path"),
      py::arg("sensor") = py::none(),
      py::arg("camera") = py::none(),
      py::arg("format") = py::none(),
      py::arg("topics") = py::tuple(),
      py::arg("ground_truth") = py::none(),
      py::arg("rotate") = "auto",
      py::arg("max_width") = py::none(),
      py::arg("view_angle") = py::none(),
      py::arg("mask") = py::none(),
      R"(open(path, sensor=None, camera=None, format=None, topics=(), ground_truth=None,
     rotate="auto", max_width=None, view_angle=None, mask=None) -> Dataset

Opens a EuRoC folder, a TUM or ICL folder, a KITTI sequence, a folder of images, a bag of ROS 1 or
ROS 2 (a folder or a .db3), an MCAP file or a video. sensor: "mono", "stereo" or "rgbd" (None: the richest the data offers).
camera: a camera file or the name of a built-in camera. format: "euroc", "tum", "kitti", "images",
"video", "bag", "mcap" or "rosbag2" (None: found out). topics: of a bag or MCAP file, those of the
images, in the order left, right, depth (empty: found out). ground_truth: a file of poses in place of those with the data,
"none" for none. rotate: "auto", "none", "90", "180" or "270", clockwise ("auto": as a video or the
EXIF data of stills ask). max_width: wider images are reduced to this width (None: to 2 megapixels).
view_angle: widest view in degrees of the pinhole image that is cut out of a lens (None: 110 of lenses
but radtan). mask: an image file, or one for each camera, that is black where nothing is to be used;
of a bag or MCAP file also topics.
Frames and calibration are those of the images as used. Raises InputError with the program's
message.)");
}

}  // namespace

void BindDatasets(py::module_& module) {
  BindFrame(module);
  BindPlaybackSchedule(module);
  py::class_<Dataset, std::shared_ptr<Dataset>>(module, "Dataset", R"(A recorded sequence: frames in
the order of time, read when they are asked for. len(), indices and iteration.)")
      .def("__len__", &Dataset::size)
      .def("__iter__", &IterateByIndex)
      .def("__getitem__",
           &Read,
           py::arg("index"),
           "The frame; InputError where an image is missing or damaged, IndexError.")
      .def("_read",
           &ReadOrReason,
           py::arg("index"),
           "The frame, or the reason of FrameResult where an image cannot be used; IndexError.")
      .def("_error_options",
           &ErrorOptionsOf,
           "How a run on it is compared with its ground truth: arguments of compare_trajectories.")
      .def_property_readonly(
          "stamps_ns",
          [](const Dataset& dataset) { return ToArray(dataset.info().stamps_ns); },
          "(N,) int64, nanoseconds; a new array.")
      .def_property_readonly("calibration", &Dataset::calibration)
      .def_property_readonly("name", [](const Dataset& d) { return ToText(d.info().name); })
      .def_property_readonly("path", [](const Dataset& d) { return d.info().path; })
      .def_property_readonly(
          "sensor",
          [](const Dataset& d) { return NameOf(d.sensor()); },
          "\"mono\", \"stereo\" or \"rgbd\"")
      .def_property_readonly("format", [](const Dataset& d) { return NameOf(d.info().format); })
      .def_property_readonly(
          "notes",
          [](const Dataset& d) {
            py::list notes;
            for (const std::string& note : d.info().notes) notes.append(ToText(note));
            return notes;
          },
          "What is missing or left out, a sentence each.")
      .def_property_readonly(
          "ground_truth", TruthOf, "Trajectory of the left camera; None where there is none.")
      .def_property_readonly(
          "ground_truth_fault",
          [](const Dataset& d) { return d.info().ground_truth_fault; },
          "Why the ground truth that came with the data cannot be used, with file and line, or "
          "None.")
      .def("__repr__", [](const Dataset& d) {
        return ToText(fmt::format(
            "<Dataset {}, {}, {} frames>", d.info().name, NameOf(d.sensor()), d.size()));
      });
  BindOpen(module);
}

}  // namespace plumbline::python
