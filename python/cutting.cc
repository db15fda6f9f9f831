// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/line_cutting/pose_information.h"

#include "apps/command_line.h"
#include "arrays.h"
#include "bindings.h"
#include "texts.h"
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace plumbline::python {
namespace {

constexpr double kNearest = 1e-6;  // z of an end in the camera

Eigen::Matrix3d ReadCovariance(const double* numbers, std::size_t line) {
  const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix3d>(numbers);
  const double size = matrix.cwiseAbs().maxCoeff();
  const bool symmetric = (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * size;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix, Eigen::EigenvaluesOnly);
  if (!symmetric || solver.eigenvalues().minCoeff() < -1e-9 * size) {
    throw InputError(fmt::format(
        "covariances: expected symmetric, positive semidefinite matrices, found another at [{}]",
        line));
  }
  return matrix;
}

CuttingProblem ReadProblem(const RectifiedCamera& camera,
                           py::handle segments,
                           py::handle covariances,
                           py::handle measured,
                           py::handle sigma_px) {
  const auto pieces = ReadSegments3(segments, "segments");
  const auto images = ReadSegments2(measured, "measured");
  CheckCount("measured", pieces.size(), images.size());
  const Doubles ends =
      ReadDoubles(covariances, "covariances", {static_cast<py::ssize_t>(pieces.size()), 2, 3, 3});
  const std::vector<double> sigmas = ReadSigmas(sigma_px, "sigma_px", pieces.size());
  CuttingProblem problem;
  problem.camera = camera;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double nearest = std::min(pieces[i].start.z(), pieces[i].end.z());
    if (nearest <= kNearest) {
      throw InputError(
          fmt::format("segments: expected ends before the camera (z > {}), found z = {} at [{}]",
                      kNearest,
                      nearest,
                      i));
    }
    const double* numbers = ends.data(static_cast<py::ssize_t>(i));
    problem.lines.push_back({pieces[i],
                             ReadCovariance(numbers, i),
                             ReadCovariance(numbers + 9, i),
                             LineThrough(images[i]),
                             sigmas[i]});
  }
  return problem;
}

void ReadInformation(const py::object& value, CuttingProblem& problem) {
  if (value.is_none()) return;
  const Doubles numbers = ReadDoubles(value, "other_information", {6, 6});
  problem.other_information = Eigen::Map<const Matrix6d>(numbers.data());
  if (!problem.other_information.isApprox(problem.other_information.transpose(), 1e-9)) {
    throw InputError("other_information: expected a symmetric matrix, found another one");
  }
}

py::dict Cut(const RectifiedCamera& camera,
             py::handle segments,
             py::handle covariances,
             py::handle measured,
             py::handle sigma_px,
             const py::object& other_information,
             const std::string& information) {
  CuttingProblem problem = ReadProblem(camera, segments, covariances, measured, sigma_px);
  ReadInformation(other_information, problem);
  const auto kind = ParseChoice<CuttingInformation>("information", information);
  std::vector<LineCut> cuts;
  const std::vector<LineCut> whole(problem.lines.size());
  double before = 0, after = 0;
  {
    const py::gil_scoped_release release;
    cuts = CutLines(problem, kind);
    before = LogDeterminantOf(problem, whole, kind);
    after = LogDeterminantOf(problem, cuts, kind);
  }
  std::vector<Eigen::Vector2d> ratios;
  for (const LineCut& cut : cuts) ratios.emplace_back(cut.first, cut.second);
  py::dict dict;
  dict["ratios"] = ToArray(ratios);
  dict["log_det_whole"] = before;
  dict["log_det_cut"] = after;
  return dict;
}

// (N, 2), each row from 0 to 1 and not descending; None: whole lines.
std::vector<LineCut> ReadCuts(const py::object& value, std::size_t count) {
  std::vector<LineCut> cuts(count);
  if (value.is_none()) return cuts;
  const Doubles ratios = ReadDoubles(value, "ratios", {static_cast<py::ssize_t>(count), 2});
  for (std::size_t i = 0; i < count; ++i) {
    const double* row = ratios.data(static_cast<py::ssize_t>(i));
    cuts[i] = {row[0], row[1]};
    if (0 <= row[0] && row[0] <= row[1] && row[1] <= 1) continue;
    throw InputError(fmt::format(
        "ratios: expected 0 <= first <= second <= 1, found {} and {} at [{}]", row[0], row[1], i));
  }
  return cuts;
}

struct LinesSeen {
  py::handle segments, covariances, measured, sigma_px;
};

Doubles InformationOfCuts(const RectifiedCamera& camera,
                          const LinesSeen& lines,
                          const py::object& ratios,
                          const py::object& other_information,
                          const std::string& information) {
  CuttingProblem problem =
      ReadProblem(camera, lines.segments, lines.covariances, lines.measured, lines.sigma_px);
  ReadInformation(other_information, problem);
  const std::vector<LineCut> cuts = ReadCuts(ratios, problem.lines.size());
  const auto kind = ParseChoice<CuttingInformation>("information", information);
  const InformationSums sums = SumInformation(problem, cuts, kind);
  return ToArray(PoseInformation(sums, problem.other_information, kind));
}

Doubles CovarianceOfStereo(const RectifiedCamera& camera,
                           py::handle points,
                           double sigma_px,
                           double sigma_disparity_px) {
  const auto places = ReadVectors3(points, "points");
  if (!(camera.baseline > 0)) {
    throw InputError("camera: expected a baseline greater than 0, found 0");
  }
  for (const auto& [name, sigma] :
       {std::pair{"sigma_px", sigma_px}, {"sigma_disparity_px", sigma_disparity_px}}) {
    if (sigma > 0 && std::isfinite(sigma)) continue;
    throw InputError(fmt::format("{}: expected a number greater than 0, found {}", name, sigma));
  }
  Doubles array({static_cast<py::ssize_t>(places.size()), py::ssize_t{3}, py::ssize_t{3}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!(places[i].z() > 0)) {
      throw InputError(fmt::format(
          "points: expected points before the camera, found z = {} at [{}]", places[i].z(), i));
    }
    Eigen::Map<Eigen::Matrix3d>(array.mutable_data(static_cast<py::ssize_t>(i))) =
        CovarianceFromDisparity(camera, places[i], sigma_px, sigma_disparity_px);
  }
  return array;
}

}  // namespace

void BindCutting(py::module_& module) {
  module.def("cut_lines",
             &Cut,
             py::arg("camera"),
             py::arg("segments"),
             py::arg("covariances"),
             py::arg("measured"),
             py::arg("sigma_px") = 1.0,
             py::arg("other_information") = py::none(),
             py::arg("information") = "independent",
             R"(cut_lines(camera, segments, covariances, measured, sigma_px=1.0,
          other_information=None, information="independent") -> dict

Good line cutting (docs/methods/line-cutting.md): the piece of each 3D line that tells most about
the pose of a camera. segments (N, 2, 3): ends in the camera's frame, before it; covariances
(N, 2, 3, 3) of these ends, m^2; measured (N, 2, 2): the segments in the image, pixels; sigma_px, one
or (N,): of the measured lines across; other_information (6, 6): what else tells of the pose, for the
left perturbation [rotation, translation].

Lines are cut one after the other, once. information, which cutting raises: "independent", "printed"
or "correlated".

"ratios" (N, 2): the piece from (1 - a) start + a end at the first to that at the second ratio;
"log_det_whole", "log_det_cut": logarithm of the determinant of the pose's information before and
after. New arrays.)");
  module.def(
      "pose_information",
      [](const RectifiedCamera& camera,
         py::handle segments,
         py::handle covariances,
         py::handle measured,
         const py::object& ratios,
         py::handle sigma_px,
         const py::object& other_information,
         const std::string& information) {
        return InformationOfCuts(camera,
                                 {segments, covariances, measured, sigma_px},
                                 ratios,
                                 other_information,
                                 information);
      },
      py::arg("camera"),
      py::arg("segments"),
      py::arg("covariances"),
      py::arg("measured"),
      py::arg("ratios") = py::none(),
      py::arg("sigma_px") = 1.0,
      py::arg("other_information") = py::none(),
      py::arg("information") = "independent",
      R"(pose_information(camera, segments, covariances, measured, ratios=None, sigma_px=1.0,
                 other_information=None, information="independent") -> numpy.ndarray

What pieces of lines tell about the pose: (6, 6) for the left perturbation [rotation, translation],
the matrix whose log det cut_lines raises. ratios (N, 2): the piece of each line, 0 <= first <=
second <= 1 (None: whole lines); the rest as for cut_lines. A new array.)");
  module.def("covariance_from_disparity",
             &CovarianceOfStereo,
             py::arg("camera"),
             py::arg("points"),
             py::arg("sigma_px"),
             py::arg("sigma_disparity_px"),
             R"(covariance_from_disparity(camera, points, sigma_px, sigma_disparity_px)

Covariances (N, 3, 3), m^2, of points (N, 3) in the frame of a camera that measured them as a stereo
pair: columns and rows to sigma_px, disparities to sigma_disparity_px. A new array.)");
}

}  // namespace plumbline::python
