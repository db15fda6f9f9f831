// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_estimation.h"

#include "plumbline/base/statistics.h"
#include "plumbline/tracking/line_cutting.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// A pose problem, and for each of its matches the feature that it came from.
struct MatchedProblem {
  PoseProblem problem;
  std::vector<std::size_t> point_feature;
  std::vector<std::size_t> line_feature;
  std::vector<CutCandidate> cut_candidates;  // one for each line
};

void AddPoints(const Features& features, const LandmarkMatches& association, MatchedProblem& out) {
  for (std::size_t i = 0; i < association.matches.point_of_feature.size(); ++i) {
    const int match = association.matches.point_of_feature[i];
    if (match < 0) continue;
    const PointCandidate& point = association.points[static_cast<std::size_t>(match)];
    out.problem.points.push_back(
        {point.model.position, MeasurePoint(features, i), point.covariance});
    out.point_feature.push_back(i);
  }
}

void AddLine(const CutCandidate& candidate,
             const LineMeasurement& measurement,
             std::size_t feature,
             const LineSettings& options,
             MatchedProblem& out) {
  const LineModel& line = *candidate.model;
  PoseProblem::LineMatch match{line.line, measurement, static_cast<int>(feature)};
  options.method.weigh_match(out.problem, line, options.weights(), match);
  out.problem.lines.push_back(match);
  out.line_feature.push_back(feature);
  out.cut_candidates.push_back(candidate);
}

void AddLines(const Features& features,
              const LineSettings& lines,
              const LandmarkMatches& association,
              MatchedProblem& out) {
  for (std::size_t i = 0; i < association.matches.line_of_feature.size(); ++i) {
    const int match = association.matches.line_of_feature[i];
    if (match < 0) continue;
    const LineCandidate& candidate = association.lines[static_cast<std::size_t>(match)];
    CutCandidate cut{&candidate.model, features.lines[i].sigma_px, association.made_from};
    if (candidate.id.valid()) cut.made_from.reset();
    AddLine(cut, MeasureLeftLine(features, i, lines.weights()), i, lines, out);
    if (const auto right = MeasureRightLine(features, i, lines.weights())) {
      cut.sigma_px = features.line_right[i]->sigma_px;
      AddLine(cut, *right, i, lines, out);
    }
  }
}

MatchedProblem MakeProblem(const RectifiedCamera& camera,
                           const Features& features,
                           const Rigid3& cam_from_world,
                           const LineSettings& lines,
                           const LandmarkMatches& association) {
  MatchedProblem matched;
  matched.problem.camera = camera;
  matched.problem.cam_from_world = cam_from_world;
  AddPoints(features, association, matched);
  AddLines(features, lines, association, matched);
  return matched;
}

// Removes from the association all matches that are not among those to keep.
void Keep(const std::vector<bool>& points,
          const std::vector<bool>& lines,
          const MatchedProblem& matched,
          LandmarkMatches& association) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k]) association.matches.point_of_feature[matched.point_feature[k]] = -1;
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (!lines[k]) association.matches.line_of_feature[matched.line_feature[k]] = -1;
  }
}

// Counts the matches whose ends are no longer those of the whole line.
int CountPieces(const PoseProblem& whole, const PoseProblem& cut) {
  std::map<std::pair<int, int>, const Segment3*> ends;  // by line and image
  for (const auto& match : whole.lines) {
    ends[{match.group, match.measurement.camera}] = &match.ends;
  }
  return static_cast<int>(
      std::count_if(cut.lines.begin(), cut.lines.end(), [&](const PoseProblem::LineMatch& match) {
        const Segment3& before = *ends.at({match.group, match.measurement.camera});
        return match.ends.start != before.start || match.ends.end != before.end;
      }));
}

// Solves with cut lines and chosen features. Inliers are all points and whole lines that fit the
// solution.
//   cut_lines  set to the number of matches of which a piece took part
PoseOnlyResult SolveWithCutLines(const MatchedProblem& matched,
                                 const LineSettings& lines,
                                 const CuttingSettings& cutting,
                                 int& cut_lines) {
  const PoseProblem cut = WithCutLines(matched.problem, matched.cut_candidates, lines, cutting);
  cut_lines = CountPieces(matched.problem, cut);
  PoseOnlyResult result = lines.method.solve_pose(cut, {});
  const Rigid3& pose = result.cam_from_world;
  result.point_inliers = PointsThatFit(matched.problem, pose, 1);
  result.inlier_points =
      static_cast<int>(std::count(result.point_inliers.begin(), result.point_inliers.end(), true));
  result.line_inliers = LinesThatFit(matched.problem, lines.method, pose, 1);
  std::set<std::size_t> features;
  for (std::size_t k = 0; k < matched.line_feature.size(); ++k) {
    if (result.line_inliers[k]) features.insert(matched.line_feature[k]);
  }
  result.inlier_line_groups = static_cast<int>(features.size());
  return result;
}

// Returns the median depth of all matched points and of the middles of all matched lines.
double SceneDepth(const LandmarkMatches& association, const Rigid3& cam_from_world) {
  std::vector<double> depths;
  for (const int match : association.matches.point_of_feature) {
    if (match < 0) continue;
    const PointModel& point = association.points[static_cast<std::size_t>(match)].model;
    depths.push_back((cam_from_world * point.position).z());
  }
  for (const int match : association.matches.line_of_feature) {
    if (match < 0) continue;
    const LineModel& line = association.lines[static_cast<std::size_t>(match)].model;
    depths.push_back((cam_from_world * line.Interval().Midpoint()).z());
  }
  return UpperMedian(std::span<double>(depths));
}

}  // namespace

PoseEstimate PoseEstimator::Estimate(const Features& features,
                                     const Rigid3& initial,
                                     const PosePrior& prior,
                                     LandmarkMatches& association) const {
  MatchedProblem matched = MakeProblem(camera_, features, initial, lines_, association);
  matched.problem.prior = prior;
  const bool all_whole = cutting_.method == "none";
  int cut_lines = 0;
  const PoseOnlyResult result = all_whole ? lines_.method.solve_pose(matched.problem, {})
                                          : SolveWithCutLines(matched, lines_, cutting_, cut_lines);
  Keep(result.point_inliers, result.line_inliers, matched, association);
  const double depth = SceneDepth(association, result.cam_from_world);
  return {result.cam_from_world,
          result.information,
          depth,
          SigmaOfPose(result.information, depth),
          result.inlier_points,
          result.inlier_line_groups,
          result.converged,
          cut_lines};
}

void PoseEstimator::DropDisagreeing(const Features& features,
                                    const Rigid3& cam_from_world,
                                    double gate_scale,
                                    LandmarkMatches& association) const {
  const MatchedProblem matched =
      MakeProblem(camera_, features, cam_from_world, lines_, association);
  Keep(PointsThatFit(matched.problem, cam_from_world, gate_scale),
       LinesThatFit(matched.problem, lines_.method, cam_from_world, gate_scale),
       matched,
       association);
}

}  // namespace plumbline
