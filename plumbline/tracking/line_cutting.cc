// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/line_cutting.h"

#include "plumbline/base/statistics.h"
#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr double kShortestPx = 5;

// A line of the problem that can be cut. Ratios run from the measured start to the measured end.
struct Cuttable {
  int group = 0;
  Segment3 in_world;
  CuttableLine line;
};

Eigen::Matrix3d CovarianceAt(const Rigid3& cam_from_world,
                             const LineModel& model,
                             const OrthonormalLine& orthonormal,
                             const Eigen::Matrix4d& tangent_covariance,
                             double t) {
  const Eigen::Vector3d& d = model.line.direction;
  const Eigen::Matrix<double, 3, 4> shift = ShiftJacobian(model.line, orthonormal, t);
  Eigen::Matrix3d covariance = shift * tangent_covariance * shift.transpose();
  covariance += covariance.trace() * d * d.transpose();
  const Eigen::Matrix3d R = cam_from_world.rotation.toRotationMatrix();
  return R * covariance * R.transpose();
}

// Returns the covariances of the ends of the visible part of a line; nullopt if they are unknown.
std::optional<EndCovariances> EndCovariancesFor(const PoseProblem& problem,
                                                const CutCandidate& candidate,
                                                const LineInterval& interval,
                                                const Segment3& in_world,
                                                const CuttingOptions& cutting) {
  if (cutting.ends != CuttingEnds::kInverseDepth) {
    return CovariancesOfEnds(problem.cam_from_world, *candidate.model, interval);
  }
  const Rigid3& made_from = candidate.made_from ? *candidate.made_from : problem.cam_from_world;
  const auto of_end = [&](const Eigen::Vector3d& end) {
    return CarriedInverseDepthCovariance(
        problem.camera, made_from, problem.cam_from_world, end, cutting.end_sigma);
  };
  const auto start = of_end(in_world.start), end = of_end(in_world.end);
  if (!start || !end) return std::nullopt;
  return EndCovariances{*start, *end};
}

std::optional<Cuttable> MakeCuttable(const PoseProblem& problem,
                                     const PoseProblem::LineMatch& match,
                                     const CutCandidate& candidate,
                                     const CuttingOptions& cutting) {
  const LineModel& model = *candidate.model;
  const Segment2& seen = match.measurement.segment;
  if (match.measurement.camera != 0 || seen.Length() < kShortestPx) return std::nullopt;
  const auto interval = TrimToSegment(problem.camera, problem.cam_from_world, model.line, seen);
  if (!interval) return std::nullopt;
  Cuttable out;
  out.group = match.group;
  out.in_world = SegmentOf(model.line, *interval);
  out.line.segment_in_cam = {problem.cam_from_world * out.in_world.start,
                             problem.cam_from_world * out.in_world.end};
  const Segment3& in_cam = out.line.segment_in_cam;
  if (!(in_cam.start.z() > kMinDepth && in_cam.end.z() > kMinDepth)) return std::nullopt;
  const auto ends = EndCovariancesFor(problem, candidate, *interval, out.in_world, cutting);
  if (!ends || !ends->start.allFinite() || !ends->end.allFinite()) return std::nullopt;
  out.line.start_covariance = ends->start;
  out.line.end_covariance = ends->end;
  out.line.image_line = LineThrough(seen);
  out.line.sigma_px = candidate.sigma_px;
  return out;
}

// Returns the derivatives of the whitened residuals of the points at the problem's pose. Points
// that have no projection are left out.
std::vector<PointRows> RowsOfPoints(const PoseProblem& problem) {
  std::vector<PointRows> rows;
  rows.reserve(problem.points.size());
  for (const auto& match : problem.points) {
    const auto residual = EvaluateMatch(problem.camera, problem.cam_from_world, match);
    rows.emplace_back(residual ? PointRows(residual->J_pose.topRows(residual->rows))
                               : PointRows(0, 6));
  }
  return rows;
}

// Returns the line as the camera that measured it sees it.
CuttableLine SeenBy(const RectifiedCamera& camera,
                    const CuttableLine& line,
                    const LineMeasurement& measurement,
                    double sigma_px) {
  CuttableLine seen = line;
  const Eigen::Vector3d shift(camera.ShiftInto(measurement.camera), 0, 0);
  seen.segment_in_cam = {line.segment_in_cam.start + shift, line.segment_in_cam.end + shift};
  seen.image_line = LineThrough(measurement.segment);
  seen.sigma_px = sigma_px;
  return seen;
}

Eigen::Matrix2d PieceCovariance(const RectifiedCamera& camera,
                                const CuttableLine& line,
                                const LineCut& cut,
                                const LineWeights& weights,
                                CuttingInformation information) {
  if (weights.kind == LineWeighting::kNone) {
    return weights.constant_sigma_px * weights.constant_sigma_px * Eigen::Matrix2d::Identity();
  }
  // The information as printed in the paper is no weight that a solver could use, so that pieces
  // are always weighted by the correlated or the independent one.
  const CuttingInformation counted = information == CuttingInformation::kCorrelated
                                         ? CuttingInformation::kCorrelated
                                         : CuttingInformation::kIndependent;
  const Eigen::Matrix2d covariance = CutWeight(camera, line, cut, counted).inverse();
  if (weights.kind == LineWeighting::kCovariance) return covariance;
  return 0.5 * covariance.trace() * Eigen::Matrix2d::Identity();
}

void UsePiece(const RectifiedCamera& camera,
              const Cuttable& cuttable,
              const LineCut& cut,
              const LineSettings& lines,
              const CuttingOptions& cutting,
              double sigma_px,
              PoseProblem::LineMatch& match) {
  LineMeasurement& measurement = match.measurement;
  const CuttableLine seen = SeenBy(camera, cuttable.line, measurement, sigma_px);
  measurement.covariance = PieceCovariance(camera, seen, cut, lines.weights(), cutting.information);
  match.ends = CutSegment(cuttable.in_world, cut);
  const auto measure = lines.method.measure_piece;
  if (measure != nullptr) measure(camera, CutSegment(seen.segment_in_cam, cut), match);
}

}  // namespace

std::optional<Eigen::Matrix3d> CarriedInverseDepthCovariance(const RectifiedCamera& camera,
                                                             const Rigid3& made_from,
                                                             const Rigid3& cam_from_world,
                                                             const Eigen::Vector3d& in_world,
                                                             double sigma) {
  const Eigen::Vector3d in_maker = made_from * in_world;
  if (!(in_maker.z() > kMinDepth)) return std::nullopt;
  const double sigma_px = sigma * 0.5 * (camera.fx + camera.fy);
  const Eigen::Matrix3d R =
      (cam_from_world.rotation * made_from.rotation.conjugate()).toRotationMatrix();
  return R * CovarianceFromInverseDepth(camera, in_maker, sigma_px, sigma) * R.transpose();
}

EndCovariances CovariancesOfEnds(const Rigid3& cam_from_world,
                                 const LineModel& line,
                                 const LineInterval& interval) {
  const OrthonormalLine orthonormal = ToOrthonormal(line.line);
  const Eigen::Matrix4d covariance =
      RegularizedInformation(line.information).llt().solve(Eigen::Matrix4d::Identity());
  return {CovarianceAt(cam_from_world, line, orthonormal, covariance, interval.start),
          CovarianceAt(cam_from_world, line, orthonormal, covariance, interval.end)};
}

PoseProblem WithCutLines(const PoseProblem& problem,
                         const std::vector<CutCandidate>& candidates,
                         const LineSettings& lines,
                         const CuttingSettings& cutting) {
  CuttingProblem to_cut{problem.camera, {}, Matrix6d::Zero()};
  std::vector<Cuttable> cuttable;
  std::map<int, std::size_t> place;  // place of a group in `cuttable`
  for (std::size_t i = 0; i < problem.lines.size(); ++i) {
    const auto made = MakeCuttable(problem, problem.lines[i], candidates[i], cutting);
    if (!made) continue;
    place[made->group] = cuttable.size();
    cuttable.push_back(*made);
    to_cut.lines.push_back(made->line);
  }
  const ChosenFeatures choice = cutting.choose(to_cut, RowsOfPoints(problem), cutting);
  PoseProblem out = problem;
  out.points.clear();
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (choice.points[i]) out.points.push_back(problem.points[i]);
  }
  out.lines.clear();
  for (std::size_t i = 0; i < problem.lines.size(); ++i) {
    PoseProblem::LineMatch match = problem.lines[i];
    const auto at = place.find(match.group);
    if (at == place.end()) {  // could not be offered
      if (choice.others) out.lines.push_back(match);
      continue;
    }
    const LineCut& cut = choice.lines[at->second];
    if (!cut.used) continue;
    if (cut != LineCut{} || choice.trim) {
      const Cuttable& whole = cuttable[at->second];
      UsePiece(problem.camera, whole, cut, lines, cutting, candidates[i].sigma_px, match);
    }
    out.lines.push_back(match);
  }
  return out;
}

std::vector<bool> PointsThatFit(const PoseProblem& problem,
                                const Rigid3& cam_from_world,
                                double gate_scale) {
  std::vector<bool> fits;
  for (const auto& match : problem.points) {
    const auto residual = EvaluateMatch(problem.camera, cam_from_world, match);
    fits.push_back(residual &&
                   residual->r.squaredNorm() <= gate_scale * Chi2Limit95(residual->rows));
  }
  return fits;
}

std::vector<bool> LinesThatFit(const PoseProblem& problem,
                               const LineMethod& method,
                               const Rigid3& cam_from_world,
                               double gate_scale) {
  struct Group {
    double chi2 = 0;
    int dof = 0;
  };
  std::map<int, Group> groups;
  for (const auto& match : problem.lines) {
    Group& group = groups[match.group];
    group.chi2 += method.match_chi2(problem.camera, cam_from_world, match);
    group.dof += 2;
  }
  std::vector<bool> fits;
  for (const auto& match : problem.lines) {
    const Group& group = groups[match.group];
    fits.push_back(group.chi2 <= gate_scale * Chi2Limit95(group.dof));
  }
  return fits;
}

}  // namespace plumbline
