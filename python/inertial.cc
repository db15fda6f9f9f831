// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "inertial.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/io/text_rows.h"

#include "apps/inertial_input.h"
#include "arrays.h"
#include "bindings.h"
#include "running_system.h"
#include "texts.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// imu: "off", "auto", a file, or samples; None: as auto, but silent where the data have none.
std::unique_ptr<RunInertial> OpenRunInertial(const Dataset& dataset,
                                             const py::object& imu,
                                             const std::optional<std::string>& camera,
                                             const std::vector<std::string>& topics,
                                             const std::string& rotate) {
  InertialRequest request{true, true, true, std::nullopt, camera, topics};
  request.rotation = ParseChoice<Rotation>("rotate", rotate);
  if (imu.is_none()) {
    request.required = request.asked = false;
    const py::gil_scoped_release release;
    return std::make_unique<RunInertial>(OpenInertial(request, dataset));
  }
  const bool is_path = py::isinstance<py::str>(imu) || py::hasattr(imu, "__fspath__");
  if (!is_path) {
    std::vector<InertialSample> samples = ReadInertialSamples(imu);
    const py::gil_scoped_release release;
    return std::make_unique<RunInertial>(OpenGivenInertial(request, dataset, std::move(samples)));
  }
  const std::string name = imu.cast<std::filesystem::path>().string();
  request.used = name != "off";
  request.required = name != "auto";
  if (request.required) request.file = name;
  const py::gil_scoped_release release;
  return std::make_unique<RunInertial>(OpenInertial(request, dataset));
}

void UseRunInertial(const RunInertial& inertial, RunningSystem& system) {
  if (inertial.recording() != nullptr) system.UseInertial(inertial.recording()->calibration);
}

void FeedUpTo(RunInertial& inertial, RunningSystem& system, std::int64_t stamp_ns) {
  system.AddInertial(inertial.feed().UpTo(stamp_ns));
}

py::list ToTexts(const std::vector<std::string>& notes) {
  py::list list;
  for (const std::string& note : notes) list.append(ToText(note));
  return list;
}

py::list NotesAfter(RunInertial& inertial, RunningSystem& system) {
  return ToTexts(system.WithFinished(
      "imu", [&](const RunResult& finished) { return inertial.NotesAfter(finished); }));
}

}  // namespace

const std::vector<std::string>& RunInertial::NotesAfter(const RunResult& finished) {
  if (after_) return *after_;
  after_.emplace();
  if (const InertialRecording* recording = input_.recording.get()) {
    const UnusableSamples unusable = recording->complete ? UnusableSamples{} : feed_.unusable();
    after_ = InertialNotes(finished, *recording, feed_, unusable);
  }
  return *after_;
}

std::vector<InertialSample> ReadInertialSamples(py::handle value) {
  constexpr py::ssize_t kColumns = 7;
  std::vector<InertialSample> samples;
  if (value.is_none()) return samples;
  const Doubles rows = ReadDoubles(value, "imu", {kAny, kColumns});
  const double* row = rows.data();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i, row += kColumns) {
    if (row[0] < 0 || row[0] > static_cast<double>(kLatestStampNs)) {
      throw InputError(
          fmt::format("imu: row {}: expected a stamp in nanoseconds, found {}", i, row[0]));
    }
    const InertialSample sample{
        std::llround(row[0]), {row[1], row[2], row[3]}, {row[4], row[5], row[6]}};
    if (!IsPlausible(sample)) {
      const double largest = std::max(sample.angular_rate.cwiseAbs().maxCoeff(),
                                      sample.specific_force.cwiseAbs().maxCoeff());
      throw InputError(fmt::format(
          "imu: row {}: expected rates in rad/s and forces in m/s^2, found {}", i, largest));
    }
    samples.push_back(sample);
  }
  return samples;
}

void BindInertial(py::module_& module) {
  py::class_<RunInertial>(module, "_RunInertial", "The inertial sensor of run().")
      .def(py::init(&OpenRunInertial),
           py::arg("dataset"),
           py::arg("imu"),
           py::arg("camera"),
           py::arg("topics"),
           py::arg("rotate"),
           "imu: as of run(). Raises InputError.")
      .def_property_readonly(
          "notes",
          [](const RunInertial& inertial) { return ToTexts(inertial.notes()); },
          "What is wrong with the samples, or why they are left out, a sentence each.")
      .def("use",
           &UseRunInertial,
           py::arg("system"),
           "Before the first frame: lets a System use the sensor.")
      .def("feed_up_to",
           &FeedUpTo,
           py::arg("system"),
           py::arg("stamp_ns"),
           "Hands a System the samples of the next frame.")
      .def("notes_after",
           &NotesAfter,
           py::arg("system"),
           "What a finished System found to be wrong with the sensor, a sentence each.");
}

}  // namespace plumbline::python
