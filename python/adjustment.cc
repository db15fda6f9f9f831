// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/pose_optimization.h"

#include "arrays.h"
#include "bindings.h"
#include "interruptible.h"
#include "options.h"
#include "texts.h"
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace plumbline::python {
namespace {

// The arrays of one kind of measurement, by name.
class Columns {
 public:
  // `value`: a dictionary with these names and no others, or None for none of them.
  Columns(py::handle value, const char* name, std::vector<std::string_view> allowed) : name_(name) {
    if (value.is_none()) return;
    if (!py::isinstance<py::dict>(value)) {
      throw InputError(name_ + ": expected a dictionary, found " + Describe(value));
    }
    columns_ = py::reinterpret_borrow<py::dict>(value);
    for (const auto& [key, column] : columns_) {
      const std::string found = ReadText(py::str(key), name_);
      if (std::find(allowed.begin(), allowed.end(), found) != allowed.end()) continue;
      std::string names;
      for (const std::string_view one : allowed) {
        names += (names.empty() ? "" : ", ") + std::string(one);
      }
      throw InputError(name_ + ": expected " + names + ", found " + found);
    }
  }

  bool empty() const { return columns_.empty(); }
  bool Has(const char* key) const { return columns_.contains(key); }
  py::object At(const char* key) const {
    if (!Has(key)) throw InputError(name_ + ": expected " + std::string(key) + ", found none");
    return columns_[key];
  }
  // The name of a column in messages.
  std::string Name(const char* key) const { return name_ + "." + key; }
  std::vector<double> Sigmas(const char* key, std::size_t count) const {
    if (!Has(key)) return std::vector<double>(count, 1.0);
    return ReadSigmas(At(key), Name(key).c_str(), count);
  }
  std::vector<int> Indices(const char* key, std::size_t limit, std::size_t count) const {
    std::vector<int> indices = ReadIndices(At(key), Name(key).c_str(), limit);
    CheckCount(Name(key).c_str(), count, indices.size());
    return indices;
  }

 private:
  std::string name_;
  py::dict columns_;
};

// pixels, sigma_px, disparities (0 or less: not measured), disparity_sigma_px.
std::vector<PointMeasurement> ReadPointMeasurements(const Columns& columns,
                                                    const RectifiedCamera& camera) {
  const auto pixels = ReadVectors2(columns.At("pixels"), columns.Name("pixels").c_str());
  const auto sigmas = columns.Sigmas("sigma_px", pixels.size());
  std::vector<PointMeasurement> measurements(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    measurements[i] = {pixels[i], sigmas[i], std::nullopt};
  }
  if (!columns.Has("disparities")) return measurements;
  if (!(camera.baseline > 0)) {
    throw InputError("camera: expected a baseline greater than 0 for disparities, found 0");
  }
  const std::string name = columns.Name("disparities");
  const Doubles disparities = ReadDoubles(columns.At("disparities"), name.c_str(), {kAny});
  CheckCount(name.c_str(), pixels.size(), static_cast<std::size_t>(disparities.size()));
  const auto disparity_sigmas = columns.Sigmas("disparity_sigma_px", pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double disparity = disparities.data()[i];
    if (disparity > 0) measurements[i].disparity = Disparity{disparity, disparity_sigmas[i]};
  }
  return measurements;
}

std::vector<LineMeasurement> ReadLineMeasurements(const Columns& columns) {
  const auto segments = ReadSegments2(columns.At("segments"), columns.Name("segments").c_str());
  const auto sigmas = columns.Sigmas("sigma_px", segments.size());
  std::vector<LineMeasurement> measurements(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    measurements[i].segment = segments[i];
    measurements[i].covariance = Eigen::Matrix2d::Identity() * sigmas[i] * sigmas[i];
  }
  return measurements;
}

py::dict SolveCameraPose(const RectifiedCamera& camera,
                         py::handle cam_from_world,
                         const py::object& points,
                         const py::object& lines,
                         const py::kwargs& given) {
  PoseProblem problem;
  problem.camera = camera;
  problem.cam_from_world = ReadPose(cam_from_world, "cam_from_world");
  const Columns point_columns(
      points, "points", {"world", "pixels", "sigma_px", "disparities", "disparity_sigma_px"});
  if (!point_columns.empty()) {
    const auto world = ReadVectors3(point_columns.At("world"), "points.world");
    const auto measurements = ReadPointMeasurements(point_columns, camera);
    CheckCount("points.pixels", world.size(), measurements.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
      problem.points.push_back({world[i], measurements[i], Eigen::Matrix3d::Zero()});
    }
  }
  const Columns line_columns(lines, "lines", {"world", "segments", "sigma_px"});
  if (!line_columns.empty()) {
    const auto world = ReadPluckerLines(line_columns.At("world"), "lines.world");
    const auto measurements = ReadLineMeasurements(line_columns);
    CheckCount("lines.segments", world.size(), measurements.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
      problem.lines.push_back({world[i], measurements[i], static_cast<int>(i), {}});
    }
  }
  PoseOnlyOptions options;
  SetOptions(given, options);
  PoseOnlyResult result;
  {
    const py::gil_scoped_release release;
    result = SolvePose(problem, options);
  }
  py::dict dict;
  dict["cam_from_world"] = ToArray(result.cam_from_world);
  dict["information"] = ToArray(result.information);
  dict["point_inliers"] = ToArray(result.point_inliers);
  dict["line_inliers"] = ToArray(result.line_inliers);
  dict["cost"] = result.cost;
  dict["iterations"] = result.iterations;
  dict["converged"] = result.converged;
  return dict;
}

void AddPoints(const py::object& points, const py::object& observations, BaProblem& problem) {
  if (!points.is_none()) problem.points = ReadVectors3(points, "points");
  const Columns columns(
      observations,
      "point_observations",
      {"pose", "point", "pixels", "sigma_px", "disparities", "disparity_sigma_px"});
  if (columns.empty()) return;
  const auto measurements = ReadPointMeasurements(columns, problem.camera);
  const auto poses = columns.Indices("pose", problem.poses.size(), measurements.size());
  const auto indices = columns.Indices("point", problem.points.size(), measurements.size());
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    problem.point_observations.push_back({poses[i], indices[i], measurements[i]});
  }
}

void AddLines(const py::object& lines, const py::object& observations, BaProblem& problem) {
  if (!lines.is_none()) {
    for (const PluckerLine& line : ReadPluckerLines(lines, "lines")) {
      problem.lines.push_back(ToOrthonormal(line));
    }
  }
  const Columns columns(
      observations, "line_observations", {"pose", "line", "segments", "sigma_px"});
  if (columns.empty()) return;
  const auto measurements = ReadLineMeasurements(columns);
  const auto poses = columns.Indices("pose", problem.poses.size(), measurements.size());
  const auto indices = columns.Indices("line", problem.lines.size(), measurements.size());
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    problem.line_observations.push_back({poses[i], indices[i], measurements[i]});
  }
}

struct Landmarks {
  py::object points, point_observations, lines, line_observations;
};

py::dict Adjust(const RectifiedCamera& camera,
                py::handle cam_from_world,
                py::handle fixed,
                const Landmarks& landmarks,
                const py::kwargs& given) {
  BaProblem problem;
  problem.camera = camera;
  for (const Rigid3& pose : ReadPoses(cam_from_world, "cam_from_world")) {
    problem.poses.push_back({pose, false, true});
  }
  for (const int pose : ReadIndices(fixed, "fixed", problem.poses.size())) {
    problem.poses[static_cast<std::size_t>(pose)].fixed = true;
  }
  AddPoints(landmarks.points, landmarks.point_observations, problem);
  AddLines(landmarks.lines, landmarks.line_observations, problem);
  LocalBaOptions options;
  SetOptions(given, options);
  BaResult result;
  RunInterruptibly([&](const StopCheck& stop) { result = SolveLocalBa(problem, options, stop); });
  std::vector<PluckerLine> lines;
  for (const OrthonormalLine& line : result.lines) lines.push_back(ToPlucker(line));
  py::dict dict;
  dict["cam_from_world"] = ToArray(result.poses);
  dict["points"] = ToArray(result.points);
  dict["lines"] = ToArray(lines);
  dict["point_inliers"] = ToArray(result.point_inliers);
  dict["line_inliers"] = ToArray(result.line_inliers);
  dict["point_chi2"] = ToArray(result.point_chi2);
  dict["line_chi2"] = ToArray(result.line_chi2);
  dict["initial_cost"] = result.initial_cost;
  dict["final_cost"] = result.final_cost;
  dict["iterations"] = result.iterations;
  dict["termination"] = NameOf(result.termination);
  return dict;
}

}  // namespace

void BindAdjustment(py::module_& module) {
  module.def("solve_pose",
             &SolveCameraPose,
             py::arg("camera"),
             py::arg("cam_from_world"),
             py::arg("points") = py::none(),
             py::arg("lines") = py::none(),
             R"(solve_pose(camera, cam_from_world, points=None, lines=None, **options) -> dict

Camera pose from matches with points and lines of a known map, robustly, from an initial pose
(4, 4). camera: RectifiedCamera. points: dictionary of "world" (N, 3), "pixels" (N, 2), "sigma_px"
(one or (N,), default 1), "disparities" (N,) (0 or less: not measured), "disparity_sigma_px".
lines: dictionary of "world" (M, 6) Pluecker, "segments" (M, 2, 2) in pixels, "sigma_px" of each end
across the line. options: rounds, robust_rounds, max_iterations, decrement_tolerance.

"cam_from_world" (4, 4), "information" (6, 6) for the left perturbation [rotation, translation],
"point_inliers" (N,), "line_inliers" (M,), "cost", "iterations", "converged". New arrays.)");
  module.def(
      "bundle_adjust",
      [](const RectifiedCamera& camera,
         py::handle cam_from_world,
         py::handle fixed,
         py::object points,
         py::object point_observations,
         py::object lines,
         py::object line_observations,
         const py::kwargs& options) {
        return Adjust(camera,
                      cam_from_world,
                      fixed,
                      {std::move(points),
                       std::move(point_observations),
                       std::move(lines),
                       std::move(line_observations)},
                      options);
      },
      py::arg("camera"),
      py::arg("cam_from_world"),
      py::arg("fixed") = py::make_tuple(0),
      py::arg("points") = py::none(),
      py::arg("point_observations") = py::none(),
      py::arg("lines") = py::none(),
      py::arg("line_observations") = py::none(),
      R"(bundle_adjust(camera, cam_from_world, fixed=(0,), points=None, point_observations=None,
              lines=None, line_observations=None, **options) -> dict

Bundle adjustment of poses (P, 4, 4), points (N, 3) and lines (M, 6) Pluecker by Levenberg-Marquardt
with the Schur complement. fixed: poses that stay (the gauge is up to the caller).
point_observations: dictionary of "pose" and "point" (indices), "pixels" (K, 2), "sigma_px",
"disparities", "disparity_sigma_px" as in solve_pose; line_observations: of "pose" and "line",
"segments" (K, 2, 2), "sigma_px". options: rounds, max_iterations, function_tolerance,
rejection_tolerance, robust.

"cam_from_world", "points", "lines" as they came in; "point_inliers", "line_inliers", "point_chi2",
"line_chi2" by observation; "initial_cost", "final_cost", "iterations", "termination". New arrays.
Ctrl-C raises KeyboardInterrupt.)");
}

}  // namespace plumbline::python
