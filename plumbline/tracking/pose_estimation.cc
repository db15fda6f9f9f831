// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_estimation.h"

#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// A pose problem and the feature each of its matches came from.
struct MatchedProblem {
  PoseProblem problem;
  std::vector<std::size_t> point_feature;
  std::vector<std::size_t> line_feature;
};

void AddPoints(const Features& features, const FrameAssociation& association, MatchedProblem& out) {
  for (std::size_t i = 0; i < association.point_of_feature.size(); ++i) {
    const int match = association.point_of_feature[i];
    if (match < 0) continue;
    const PointModel& point = association.points[static_cast<std::size_t>(match)].model;
    out.problem.points.push_back({point.position, MeasurePoint(features, i)});
    out.point_feature.push_back(i);
  }
}

void AddLines(const Features& features,
              LineWeighting weighting,
              const FrameAssociation& association,
              MatchedProblem& out) {
  for (std::size_t i = 0; i < association.line_of_feature.size(); ++i) {
    const int match = association.line_of_feature[i];
    if (match < 0) continue;
    const LineModel& line = association.lines[static_cast<std::size_t>(match)].model;
    const auto add = [&](LineMeasurement measurement) {
      AddLandmarkUncertainty(out.problem.camera,
                             out.problem.cam_from_world,
                             line.line,
                             line.information,
                             weighting,
                             measurement);
      out.problem.lines.push_back({line.line, measurement, static_cast<int>(i)});
      out.line_feature.push_back(i);
    };
    add(MeasureLeftLine(features, i, weighting));
    if (const auto right = MeasureRightLine(features, i, weighting)) add(*right);
  }
}

}  // namespace

PoseEstimate EstimatePose(const RectifiedCamera& camera,
                          const Features& features,
                          const Rigid3& initial,
                          LineWeighting weighting,
                          const PoseOnlyOptions& options,
                          FrameAssociation& association) {
  MatchedProblem matched;
  matched.problem.camera = camera;
  matched.problem.cam_from_world = initial;
  AddPoints(features, association, matched);
  AddLines(features, weighting, association, matched);
  const PoseOnlyResult result = SolvePose(matched.problem, options);
  for (std::size_t k = 0; k < matched.point_feature.size(); ++k) {
    if (!result.point_inliers[k]) association.point_of_feature[matched.point_feature[k]] = -1;
  }
  for (std::size_t k = 0; k < matched.line_feature.size(); ++k) {
    if (!result.line_inliers[k]) association.line_of_feature[matched.line_feature[k]] = -1;
  }
  return {result.cam_from_world,
          result.information,
          result.inlier_points,
          result.inlier_line_groups,
          result.converged};
}

}  // namespace plumbline
