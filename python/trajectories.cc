// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "trajectories.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/trajectory_error.h"

#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "arrays.h"
#include "bindings.h"
#include "texts.h"
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// Places as far away as those that are read from files may be.
std::vector<Eigen::Vector3d> ReadPlaces(py::handle value, const char* name) {
  std::vector<Eigen::Vector3d> places = ReadVectors3(value, name);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::Index axis = 0;
    if (places[i].cwiseAbs().maxCoeff(&axis) <= kFarthest) continue;
    throw InputError(
        fmt::format("{}: expected coordinates within {:g} of 0, found {:g} at [{}, {}]",
                    name,
                    kFarthest,
                    places[i](axis),
                    i,
                    axis));
  }
  return places;
}

Trajectory MakeTrajectory(py::handle stamps_ns, py::handle positions, py::handle quaternions) {
  const py::array stamps = py::array::ensure(stamps_ns);
  if (!stamps || stamps.ndim() != 1 || (stamps.size() > 0 && stamps.dtype().kind() != 'i')) {
    PyErr_Clear();
    throw InputError(
        "stamps_ns: expected whole numbers of shape (N,), nanoseconds, found " +
        Describe(stamps ? py::object(stamps) : py::reinterpret_borrow<py::object>(stamps_ns)));
  }
  // An empty array may be of any type, of which not all turn into whole numbers.
  const Integers stamp = stamps.size() > 0 ? Integers::ensure(stamps) : Integers(0);
  const std::vector<Eigen::Vector3d> centres = ReadPlaces(positions, "positions");
  const Doubles turns = ReadDoubles(quaternions, "quaternions", {kAny, 4});
  CheckCount("positions", static_cast<std::size_t>(stamp.size()), centres.size());
  CheckCount("quaternions", centres.size(), static_cast<std::size_t>(turns.shape(0)));
  Trajectory poses;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    Eigen::Quaterniond q;
    q.coeffs() = Eigen::Map<const Eigen::Vector4d>(turns.data(row));
    if (!IsRotation(q)) {
      throw InputError(
          fmt::format("quaternions: expected a norm of 1, found {:.3g} at [{}]", q.norm(), i));
    }
    const std::int64_t ns = stamp.data()[row];
    if (!IsReadableStamp(ns)) {
      throw InputError(fmt::format(
          "stamps_ns: expected stamps within {} ns of 0, found {} at [{}]", kLatestStampNs, ns, i));
    }
    if (!poses.empty() && ns <= poses.back().stamp_ns) {
      throw InputError(
          fmt::format("stamps_ns: expected ascending stamps, found {} after {} at [{}]",
                      ns,
                      poses.back().stamp_ns,
                      i));
    }
    poses.push_back({ns, {q.normalized(), centres[i]}});
  }
  return poses;
}

Integers StampsOf(const PoseList& list) {
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : list.poses) stamps.push_back(pose.stamp_ns);
  return ToArray(stamps);
}

Doubles PosesOf(const PoseList& list) {
  std::vector<Rigid3> poses;
  for (const StampedPose& pose : list.poses) poses.push_back(pose.world_from_camera);
  return ToArray(poses);
}

Doubles PositionsOf(const PoseList& list) {
  std::vector<Eigen::Vector3d> positions;
  for (const StampedPose& pose : list.poses) {
    positions.push_back(pose.world_from_camera.translation);
  }
  return ToArray(positions);
}

Doubles QuaternionsOf(const PoseList& list) {
  Doubles array({static_cast<py::ssize_t>(list.poses.size()), py::ssize_t{4}});
  double* out = array.mutable_data();
  for (const StampedPose& pose : list.poses) {
    Eigen::Map<Eigen::Vector4d>{out} = pose.world_from_camera.rotation.coeffs();
    out += 4;
  }
  return array;
}

py::dict StatisticsDict(const ErrorStatistics& errors) {
  py::dict dict;
  dict["count"] = errors.count;
  dict["rmse"] = errors.rmse;
  dict["mean"] = errors.mean;
  dict["median"] = errors.median;
  dict["max"] = errors.max;
  dict["std"] = errors.deviation;
  dict["p75"] = errors.p75;
  dict["p95"] = errors.p95;
  return dict;
}

py::object OptionalStatistics(const std::optional<ErrorStatistics>& errors) {
  if (!errors) return py::none();
  return StatisticsDict(*errors);
}

py::dict Compare(const PoseList& reference,
                 const PoseList& estimate,
                 const std::string& alignment,
                 const std::string& association,
                 double window_s,
                 double max_gap_s) {
  TrajectoryErrorOptions options;
  options.alignment = ParseChoice<TrajectoryAlignment>("alignment", alignment);
  options.association = ParseChoice<TrajectoryAssociation>("association", association);
  constexpr double kShortest = 1e-6, kLongest = 1e6;  // as of `evaluate --delta`
  for (const auto& [name, seconds] : {std::pair{"window_s", window_s}, {"max_gap_s", max_gap_s}}) {
    if (seconds >= kShortest && seconds <= kLongest) continue;
    throw InputError(fmt::format(
        "{}: expected seconds from {:g} to {:g}, found {:g}", name, kShortest, kLongest, seconds));
  }
  options.window.duration_ns = static_cast<std::int64_t>(std::llround(1e9 * window_s));
  options.max_gap_ns = static_cast<std::int64_t>(std::llround(1e9 * max_gap_s));
  const auto error = CompareTrajectories(reference.poses, estimate.poses, options);
  if (!error)
    throw InputError("estimate: expected poses within the time of the reference, found none");
  py::dict dict;
  std::vector<std::int64_t> stamps;
  std::vector<double> positions, rotations;
  for (const EvaluatedPose& pose : error->poses) {
    stamps.push_back(pose.stamp_ns);
    positions.push_back(pose.position_error);
    rotations.push_back(pose.rotation_error);
  }
  dict["ate"] = StatisticsDict(error->ate);
  dict["rpe"] = OptionalStatistics(error->rpe);
  dict["roe"] = OptionalStatistics(error->roe);
  dict["scale"] = error->reference_from_estimate.scale;
  dict["scale_drift"] = error->scale_drift;
  dict["reference_from_estimate"] = ToArray(error->reference_from_estimate.Matrix());
  dict["degenerate"] = error->degenerate.has_value();
  dict["stamps_ns"] = ToArray(stamps);
  dict["position_errors"] = ToArray(positions);
  dict["rotation_errors"] = ToArray(rotations);
  return dict;
}

py::tuple Align(py::handle source, py::handle target, bool with_scale) {
  const auto from = ReadPlaces(source, "source");
  const auto to = ReadPlaces(target, "target");
  CheckCount("target", from.size(), to.size());
  const auto alignment =
      AlignPoints(from, to, with_scale ? AlignmentScale::kFree : AlignmentScale::kFixed);
  if (!alignment) {
    constexpr std::array kReasons{"fewer than three", "all in one place", "all on one line"};
    throw InputError(
        fmt::format("source, target: expected points that determine a motion, found {}",
                    kReasons[static_cast<std::size_t>(alignment.error())]));
  }
  return py::make_tuple(ToArray(alignment->target_from_source.Matrix()), alignment->rmse);
}

void BindComparison(py::module_& module) {
  module.def(
      "compare_trajectories",
      &Compare,
      py::arg("reference"),
      py::arg("estimate"),
      py::arg("alignment") = "se3",
      py::arg("association") = "interpolate",
      py::arg("window_s") = 3.0,
      py::arg("max_gap_s") = 0.1,
      R"(compare_trajectories(reference, estimate, alignment="se3", association="interpolate",
                     window_s=3.0, max_gap_s=0.1) -> dict

Errors of an estimated trajectory, of the same camera, after the alignment that minimises the
squared distances (Umeyama, PAMI 1991): alignment "none", "se3" or "sim3". association: the
reference is interpolated at the time of each pose, over gaps of at most max_gap_s ("interpolate"),
or its pose nearest in time, at most 20 ms away, is taken ("nearest"). window_s: seconds between the
two poses of a pair of rpe and roe. Raises InputError where no pose has a reference.

"ate" [m], "rpe" [m/s], "roe" [rad/s]: dictionaries of count, rmse, mean, median, max, std
(standard deviation), p75 and p95 (percentiles), None where nothing spans the window; "scale", "scale_drift"; "reference_from_estimate" (4, 4);
"degenerate": positions do not determine the alignment; "stamps_ns" (N,),
"position_errors" (N,) [m], "rotation_errors" (N,) [rad] of the poses that were compared.
All arrays are new.)");
  module.def("align_points",
             &Align,
             py::arg("source"),
             py::arg("target"),
             py::arg("with_scale") = false,
             R"(align_points(source, target, with_scale=False) -> (numpy.ndarray, float)

The motion (4, 4; with_scale: similarity) target_from_source that brings points (N, 3) nearest to
points (N, 3), and the root mean square distance left. Umeyama, PAMI 1991. New array.)");
}

}  // namespace

void BindTrajectories(py::module_& module) {
  py::class_<PoseList>(module, "Trajectory", R"(Poses of one camera, stamps ascending.)")
      .def(py::init([](py::handle stamps, py::handle positions, py::handle quaternions) {
             return PoseList{MakeTrajectory(stamps, positions, quaternions)};
           }),
           py::arg("stamps_ns"),
           py::arg("positions"),
           py::arg("quaternions"),
           R"(Trajectory(stamps_ns, positions, quaternions)

stamps (N,) in nanoseconds, camera centres (N, 3) in the world, quaternions (N, 4) x y z w of
world_from_camera. Stamps until the year 2096 and places within 10^9 m, as load reads them.)")
      .def_static(
          "load",
          [](const std::filesystem::path& path) { return PoseList{ReadTrajectory(path).poses}; },
          py::arg("path"),
          "load(path) -> Trajectory\n\nReads the form of TUM, EuRoC or KITTI.")
      .def(
          "save",
          [](const PoseList& list, const std::filesystem::path& path) {
            CheckOutput("path", path, {}, TrajectoryFileKind());
            WriteTum(path, list.poses);
          },
          py::arg("path"),
          R"(save(path)

Writes the form of TUM, the bytes of `plumbline run`. Raises InputError where a result of a run, or
anything else than such a file, would be replaced.)")
      .def(
          "to_tum",
          [](const PoseList& list) { return FormatTum(list.poses); },
          "to_tum() -> str\n\nThe text that save writes.")
      .def("__len__", [](const PoseList& list) { return list.poses.size(); })
      .def("__repr__",
           [](const PoseList& list) {
             if (list.poses.empty()) return std::string("<Trajectory of 0 poses>");
             return fmt::format("<Trajectory of {} poses, {} to {} s>",
                                list.poses.size(),
                                FormatStamp(list.poses.front().stamp_ns),
                                FormatStamp(list.poses.back().stamp_ns));
           })
      .def_property_readonly("stamps_ns", StampsOf, "(N,) int64, nanoseconds; a new array.")
      .def_property_readonly("poses", PosesOf, "(N, 4, 4) world_from_camera; a new array.")
      .def_property_readonly("positions", PositionsOf, "(N, 3) camera centres; a new array.")
      .def_property_readonly(
          "quaternions", QuaternionsOf, "(N, 4) x y z w of world_from_camera; a new array.")
      .def_property_readonly(
          "length",
          [](const PoseList& list) { return PathLength(list.poses); },
          "Sum of the distances between successive positions.");
  BindComparison(module);
}

}  // namespace plumbline::python
