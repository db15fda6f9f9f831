// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cut_lines.h"

#include "plumbline/base/error.h"
#include "plumbline/line_cutting/cut_residuals.h"
#include "plumbline/line_cutting/pose_information.h"
#include "plumbline/line_cutting/single_line.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>

namespace plumbline {
namespace {

void Check(const CuttingProblem& problem) {
  for (const CuttableLine& line : problem.lines) {
    PLUMBLINE_CHECK(
        line.segment_in_cam.start.z() > kMinDepth && line.segment_in_cam.end.z() > kMinDepth,
        "a line to cut has an end behind the camera");
    PLUMBLINE_CHECK(line.sigma_px > 0, "a line to cut has no noise in the image");
  }
}

}  // namespace

double CutEachLine(const CuttingProblem& problem,
                   CuttingInformation information,
                   std::vector<LineCut>& cuts) {
  Check(problem);
  InformationSums sums = SumInformation(problem, cuts, information);
  double gain = 0;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    sums.Subtract(EvaluateCut(problem.camera, problem.lines[i], cuts[i], information));
    const SingleLineCut found = CutSingleLine(problem, i, sums, cuts[i], information);
    cuts[i] = found.cut;
    gain += found.gain;
    sums.Add(EvaluateCut(problem.camera, problem.lines[i], cuts[i], information));
  }
  return gain;
}

std::vector<LineCut> CutLines(const CuttingProblem& problem, CuttingInformation information) {
  std::vector<LineCut> cuts(problem.lines.size());
  CutEachLine(problem, information, cuts);
  return cuts;
}

Eigen::Matrix2d CutWeight(const RectifiedCamera& camera,
                          const CuttableLine& line,
                          const LineCut& cut,
                          CuttingInformation information) {
  return EvaluateCut(camera, line, cut, information).weight;
}

Matrix6d SumPoints(std::span<const PointRows> points, const std::vector<bool>& used) {
  PLUMBLINE_CHECK(used.empty() || used.size() == points.size(), "one mark for each point");
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used.empty() || used[i]) sum.noalias() += points[i].transpose() * points[i];
  }
  return sum;
}

ChosenFeatures ChooseAll(const CuttingProblem& problem,
                         std::span<const PointRows> points,
                         const CuttingOptions& options) {
  CuttingProblem with_points = problem;
  with_points.other_information += SumPoints(points);
  return {std::vector<bool>(points.size(), true), CutLines(with_points, options.information)};
}

}  // namespace plumbline
