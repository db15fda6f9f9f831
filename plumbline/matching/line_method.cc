// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/line_method.h"

#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <limits>

namespace plumbline {

void WeighLineMatch(const PoseProblem& problem,
                    const LineModel& line,
                    const LineWeights& weights,
                    PoseProblem::LineMatch& match) {
  AddLandmarkUncertainty(problem.camera,
                         problem.cam_from_world,
                         line.line,
                         line.information,
                         weights,
                         match.measurement);
}

double LineMatchChi2(const RectifiedCamera& camera,
                     const Rigid3& cam_from_world,
                     const PoseProblem::LineMatch& match) {
  const auto residual =
      EvaluateLine(camera, cam_from_world, ToOrthonormal(match.line_in_world), match.measurement);
  return residual ? residual->r.squaredNorm() : std::numeric_limits<double>::infinity();
}

void MeasurePiece(const RectifiedCamera& camera,
                  const Segment3& piece,
                  PoseProblem::LineMatch& match) {
  Segment2& measured = match.measurement.segment;
  const Eigen::Vector2d start = measured.start;
  const Eigen::Vector2d along = measured.end - start;
  const auto place = [&](const Eigen::Vector3d& point) -> Eigen::Vector2d {
    const double ratio = (camera.Project(point) - start).dot(along) / along.squaredNorm();
    return start + std::clamp(ratio, 0.0, 1.0) * along;
  };
  measured = {place(piece.start), place(piece.end)};
}

}  // namespace plumbline
