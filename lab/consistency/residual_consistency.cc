// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/residual_consistency.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/optimization/residuals.h"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace plumbline {
namespace {

constexpr double kAnyResidual = std::numeric_limits<double>::infinity();
// Largest variance of a projected landmark in units of the measurement's.
constexpr double kMostPredicted = 4;

double FromMiddle(const RectifiedCamera& camera, const Eigen::Vector2d& px) {
  const Eigen::Vector2d half(0.5 * camera.width, 0.5 * camera.height);
  return (px - half).norm() / half.norm();
}

// A landmark with kSize parameters as the observations so far tell of it, linearized.
template <int kSize>
class Told {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;

  // Takes whitened rows in.
  template <class Residual, class Jacobian>
  void Take(const Residual& r, const Jacobian& J) {
    information_ += J.transpose() * J;
    vector_ += J.transpose() * r;
  }

  // Prepares Innovation; returns false if not all parameters are known.
  bool Solve() {
    factor_.compute(information_);
    if (factor_.info() != Eigen::Success || factor_.rcond() < 1e-12) return false;
    step_ = -factor_.solve(vector_);
    return true;
  }

  // Sets the innovation of whitened rows and its covariance; returns false if the landmark is
  // known to too little.
  template <int kRows>
  bool Innovation(const Eigen::Matrix<double, kRows, 1>& r,
                  const Eigen::Matrix<double, kRows, kSize>& J,
                  Eigen::Matrix<double, kRows, 1>& e,
                  Eigen::Matrix<double, kRows, kRows>& S) const {
    const Eigen::Matrix<double, kRows, kRows> predicted = J * factor_.solve(J.transpose());
    if (!(predicted.diagonal().maxCoeff() <= kMostPredicted)) return false;
    e = r + J * step_;
    S = predicted + Eigen::Matrix<double, kRows, kRows>::Identity();
    return true;
  }

 private:
  Eigen::Matrix<double, kSize, kSize> information_ = Eigen::Matrix<double, kSize, kSize>::Zero();
  Vector vector_ = Vector::Zero();
  Vector step_ = Vector::Zero();
  Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> factor_;
};

struct SeenPoint {
  const PointFeature* feature = nullptr;
  Rigid3 cam_from_world;
  PointMeasurement measurement;
};

// Mean of the depths from which a landmark was seen so far.
class MeanDepth {
 public:
  void Add(double depth) {
    sum_ += math::Log(depth);
    ++count_;
  }
  // Returns a depth over the mean, less 1; 0 without one.
  double Approach(double depth) const {
    return count_ == 0 ? 0 : math::Exp(math::Log(depth) - sum_ / count_) - 1;
  }

 private:
  double sum_ = 0;
  int count_ = 0;
};

void AddPoint(const RectifiedCamera& camera,
              const std::vector<SeenPoint>& seen,
              std::vector<ConsistencySample>& samples) {
  std::vector<PointView> views;
  for (const SeenPoint& view : seen) {
    const PointMeasurement& m = view.measurement;
    views.push_back({view.cam_from_world, m.px, m.sigma_px, m.disparity});
  }
  const auto point = TriangulatePoint(camera, views, {.min_angle = 1e-6});
  if (!point) return;
  Told<3> told;
  MeanDepth depths;
  int earlier = 0;
  for (const SeenPoint& view : seen) {
    const auto residual =
        EvaluatePoint(camera, view.cam_from_world, point->position, view.measurement);
    if (!residual) return;
    ConsistencySample sample;
    sample.from_middle = FromMiddle(camera, view.measurement.px);
    sample.octave = view.feature->octave;
    sample.contrast = view.feature->response;
    sample.sigma_px = view.feature->sigma_px;
    sample.earlier = earlier++;
    const double depth = (view.cam_from_world * point->position).z();
    sample.approach = depths.Approach(depth);
    depths.Add(depth);
    if (told.Solve()) {
      Eigen::Vector2d e;
      Eigen::Matrix2d S;
      if (told.Innovation<2>(residual->r.head<2>(), residual->J_point.topRows<2>(), e, S)) {
        sample.nees = e.dot(S.inverse() * e);
        sample.dimensions = 2;
        samples.push_back(sample);
      }
      Eigen::Matrix<double, 1, 1> d, D;
      if (residual->rows == 3 &&
          told.Innovation<1>(residual->r.tail<1>(), residual->J_point.bottomRows<1>(), d, D)) {
        sample.kind = ConsistencyKind::kDisparity;
        sample.nees = d.x() * d.x() / D.x();
        sample.dimensions = 1;
        sample.sigma_px = view.measurement.disparity->sigma_px;
        samples.push_back(sample);
      }
    }
    told.Take(residual->r, residual->J_point);
  }
}

// Returns the middle and half of the difference of two distances of the ends.
Eigen::Matrix2d MiddleAndTurn() {
  Eigen::Matrix2d M;
  M << 0.5, 0.5, -0.5, 0.5;
  return M;
}

// Pose of the camera, left or right, that measured a segment.
Rigid3 CameraOf(const RectifiedCamera& camera, const SeenLine& line, const SeenSegment& segment) {
  const Rigid3 left = line.CameraFromFirst(segment);
  return segment.measurement.camera == 1 ? RightCamera(camera, left) : left;
}

void AddLine(const RectifiedCamera& camera,
             const SeenLine& line,
             std::vector<ConsistencySample>& samples) {
  const PreparedLine prepared(ToOrthonormal(line.line));
  Told<4> told;
  MeanDepth depths;
  for (const SeenSegment& segment : line.segments) {
    const auto residual =
        EvaluateLine(camera, line.CameraFromFirst(segment), prepared, segment.measurement);
    if (!residual) return;
    const auto middle = TrimmedParameter(
        camera, CameraOf(camera, line, segment), line.line, segment.measurement.segment.Midpoint());
    if (!middle) return;
    const double depth = (line.CameraFromFirst(segment) * line.line.PointAt(*middle)).z();
    if (!(depth > 0)) return;
    Eigen::Vector2d e;
    Eigen::Matrix2d S;
    if (told.Solve() && told.Innovation<2>(residual->r, residual->J_line, e, S)) {
      const bool right = segment.measurement.camera == 1;
      ConsistencySample sample =
          SampleOf(right ? ConsistencyKind::kRightLine : ConsistencyKind::kLine, camera, segment);
      sample.nees = e.dot(S.inverse() * e);
      sample.dimensions = 2;
      sample.approach = depths.Approach(depth);
      // W W^T = covariance^-1, with W the lower triangle that whitens.
      const LineTerm term = MakeLineTerm(camera, segment.measurement);
      Eigen::Matrix2d whitening;
      whitening << term.w00, 0, term.w10, term.w11;
      const Eigen::Matrix2d to_px = MiddleAndTurn() * whitening.inverse();
      sample.across_px = to_px * e;
      sample.promised_px = (to_px * S * to_px.transpose()).diagonal().cwiseSqrt();
      samples.push_back(sample);
    }
    told.Take(residual->r, residual->J_line);
    depths.Add(depth);
  }
}

}  // namespace

std::optional<SeenLine> SeeLine(const Map& map,
                                const RectifiedCamera& camera,
                                const KeyFramePoses& poses,
                                const MapLine& line) {
  SeenLine seen;
  std::vector<LineView> views;
  int earlier = 0;
  for (const auto& [id, feature] : line.observations) {
    const auto pose = poses.find(id);
    if (pose == poses.end()) continue;
    const Features& features = map.Find(id)->frame.features();
    const auto i = static_cast<std::size_t>(feature);
    if (seen.segments.empty()) seen.first_from_world = pose->second;
    const LineFeature& left = features.lines[i];
    seen.segments.push_back({id,
                             pose->second,
                             MeasureLeftLine(features, i, LineWeighting::kCovariance),
                             &left,
                             left.sigma_px,
                             earlier});
    const Rigid3 from_first = seen.CameraFromFirst(seen.segments.back());
    views.push_back({from_first, left.segment, left.sigma_px});
    if (const auto right = MeasureRightLine(features, i, LineWeighting::kCovariance)) {
      const double sigma = features.line_right[i]->sigma_px;
      seen.segments.push_back({id, pose->second, *right, &left, sigma, earlier});
      views.push_back({RightCamera(camera, from_first), right->segment, sigma});
    }
    ++earlier;
  }
  if (views.size() < 2) return std::nullopt;
  const auto found =
      TriangulateLine(camera, views, {.min_angle = 1e-4, .max_residual_sigma = kAnyResidual});
  if (!found) return std::nullopt;
  OrthonormalLine adjusted = ToOrthonormal(found->line);
  constexpr int kSteps = 4;
  for (int k = 0; k <= kSteps; ++k) {
    Eigen::Vector4d vector = Eigen::Vector4d::Zero();
    seen.information.setZero();
    for (const SeenSegment& segment : seen.segments) {
      const auto residual = EvaluateLine(
          camera, seen.CameraFromFirst(segment), PreparedLine(adjusted), segment.measurement);
      if (!residual) return std::nullopt;
      seen.information += residual->J_line.transpose() * residual->J_line;
      vector += residual->J_line.transpose() * residual->r;
    }
    const Eigen::LDLT<Eigen::Matrix4d> factor(seen.information);
    if (factor.info() != Eigen::Success || factor.rcond() < 1e-12) return std::nullopt;
    if (k < kSteps) adjusted = Retract(adjusted, -factor.solve(vector));
  }
  seen.line = ToPlucker(adjusted);
  return seen;
}

ConsistencySample SampleOf(ConsistencyKind kind,
                           const RectifiedCamera& camera,
                           const SeenSegment& segment) {
  ConsistencySample sample;
  sample.kind = kind;
  sample.length = segment.measurement.segment.Length();
  sample.contrast = segment.feature->response;
  sample.from_middle = FromMiddle(camera, segment.measurement.segment.Midpoint());
  sample.octave = segment.feature->octave;
  sample.earlier = segment.earlier;
  sample.sigma_px = segment.sigma_px;
  return sample;
}

std::vector<ConsistencySample> ResidualSamples(const Map& map,
                                               const RectifiedCamera& camera,
                                               const KeyFramePoses& poses) {
  std::vector<ConsistencySample> samples;
  for (const auto& [id, point] : map.points()) {
    std::vector<SeenPoint> seen;
    for (const auto& [keyframe, feature] : point.observations) {
      const auto pose = poses.find(keyframe);
      if (pose == poses.end()) continue;
      const Features& features = map.Find(keyframe)->frame.features();
      const auto i = static_cast<std::size_t>(feature);
      seen.push_back({&features.points[i], pose->second, MeasurePoint(features, i)});
    }
    AddPoint(camera, seen, samples);
  }
  for (const auto& [id, line] : map.lines()) {
    const auto seen = SeeLine(map, camera, poses, line);
    if (seen) AddLine(camera, *seen, samples);
  }
  return samples;
}

}  // namespace plumbline
