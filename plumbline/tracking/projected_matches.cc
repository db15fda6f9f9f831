// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/projected_matches.h"

#include "plumbline/geometry/trimming.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/optimization/pose_solver.h"
#include "plumbline/tracking/projected_ends.h"

#include <limits>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// The ends of a match, ready for use, as PoseSolver asks of it.
class PoseEnds {
 public:
  struct Linearization {
    ProjectedEndsLinearization at;
    Segment3 ends;  // in the left camera
  };

  PoseEnds(const RectifiedCamera& camera, const PoseProblem::LineMatch& match)
      : ends_(match.ends), term_(MakeProjectedEndsTerm(camera, match.measurement)) {}

  bool Linearize(const RectifiedCamera&,
                 const Rigid3& pose,
                 const Eigen::Matrix3d&,
                 Linearization& out) const {
    out.ends = {pose * ends_.start, pose * ends_.end};
    return LinearizeProjectedEnds(term_, out.ends, out.at);
  }
  std::pair<Vector6d, Vector6d> PoseRows(const Linearization& lin) const {
    const auto [a, b] = plumbline::PoseRows(lin.at, lin.ends);
    return {a, b};
  }
  bool Distances(const RectifiedCamera&,
                 const Eigen::Matrix3d& R,
                 const Eigen::Vector3d& t,
                 Eigen::Vector2d& r) const {
    return WhitenedEndDistances(term_, {R * ends_.start + t, R * ends_.end + t}, r);
  }

 private:
  Segment3 ends_;  // in the world
  ProjectedEndsTerm term_;
};

Segment3 VisibleEnds(const PoseProblem& problem, const LineModel& line) {
  const Segment3 world = line.Interval();
  const Segment3 in_cam{problem.cam_from_world * world.start, problem.cam_from_world * world.end};
  const auto segment = ProjectSegment(problem.camera, in_cam);
  if (!segment) return world;
  const auto interval = TrimToSegment(problem.camera, problem.cam_from_world, line.line, *segment);
  return interval ? SegmentOf(line.line, *interval) : world;
}

}  // namespace

LineMethod ProductLineMethod(const LineOptions& options) {
  LineMethod method;
  if (options.reconstruction == "n_view_checked") method.line_from_views = CheckedLineFromViews;
  if (options.residual != "projected_ends") return method;
  method.only_odometry = true;
  method.weigh_match = WeighProjectedMatch;
  method.solve_pose = SolvePoseByProjectedEnds;
  method.match_chi2 = ProjectedMatchChi2;
  method.measure_piece = nullptr;
  return method;
}

void UseProjectedEnds(const RectifiedCamera& camera,
                      const Rigid3& cam_from_world,
                      const LineAndEnds& line,
                      const std::optional<Eigen::Matrix4d>& information,
                      const LineWeights& weights,
                      LineMeasurement& measurement) {
  if (weights.kind == LineWeighting::kNone) return;
  LineMeasurement unit = measurement;
  unit.covariance = Eigen::Matrix2d::Identity();
  measurement.covariance = ProjectedEndsCovariance(camera, cam_from_world, line.ends, measurement);
  const LineInterval interval{line.line.ParameterOf(line.ends.start),
                              line.line.ParameterOf(line.ends.end)};
  const auto residual =
      EvaluateProjectedEnds(camera, cam_from_world, ToOrthonormal(line.line), interval, unit);
  if (residual && information) {
    const Eigen::Matrix<double, 4, 2> spread =
        RegularizedInformation(*information).llt().solve(residual->J_line.transpose());
    measurement.covariance += residual->J_line * spread;
  }
  if (weights.kind != LineWeighting::kScalar) return;
  measurement.covariance = 0.5 * measurement.covariance.trace() * Eigen::Matrix2d::Identity();
}

void WeighProjectedMatch(const PoseProblem& problem,
                         const LineModel& line,
                         const LineWeights& weights,
                         PoseProblem::LineMatch& match) {
  match.ends = VisibleEnds(problem, line);
  UseProjectedEnds(problem.camera,
                   problem.cam_from_world,
                   {line.line, match.ends},
                   line.information,
                   weights,
                   match.measurement);
}

PoseOnlyResult SolvePoseByProjectedEnds(const PoseProblem& problem,
                                        const PoseOnlyOptions& options) {
  return PoseSolver<PoseEnds>(problem, options).Solve(problem.cam_from_world);
}

double ProjectedMatchChi2(const RectifiedCamera& camera,
                          const Rigid3& cam_from_world,
                          const PoseProblem::LineMatch& match) {
  Eigen::Vector2d r;
  const Segment3 seen{cam_from_world * match.ends.start, cam_from_world * match.ends.end};
  const bool valid =
      WhitenedEndDistances(MakeProjectedEndsTerm(camera, match.measurement), seen, r);
  return valid ? r.squaredNorm() : std::numeric_limits<double>::infinity();
}

}  // namespace plumbline
