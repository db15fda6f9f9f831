// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_calibration.h"

#include "plumbline/association/measurements.h"
#include "plumbline/geometry/line_triangulation.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

constexpr double kPriorSigmaPx = 0.5;  // of each coefficient
// Of a single displacement, beside the error of its prediction: noise of the disparity, and what a
// landmark's looks do to all its disparities alike.
constexpr double kNoisePx = 0.5;
constexpr double kHuber = 1.345;              // sigma
constexpr double kMaxPredictionSigmaPx = 0.3;  // worse predictions tell nothing
constexpr double kMaxDisplacementPx = 3;       // more is a wrong match
constexpr std::size_t kMinViews = 3;

std::vector<PointView> LeftViews(const Map& map, const MapPoint& point) {
  std::vector<PointView> views;
  for (const auto& [id, feature] : point.observations) {
    const Frame& frame = map.Find(id)->frame;
    const PointFeature& f = frame.features().points[static_cast<std::size_t>(feature)];
    views.push_back({frame.cam_from_world, f.px, f.sigma_px, std::nullopt});
  }
  return views;
}

std::vector<LineView> LeftViews(const Map& map, const MapLine& line) {
  std::vector<LineView> views;
  for (const auto& [id, feature] : line.observations) {
    const Frame& frame = map.Find(id)->frame;
    const LineFeature& f = frame.features().lines[static_cast<std::size_t>(feature)];
    views.push_back({frame.cam_from_world, f.segment, f.sigma_px});
  }
  return views;
}

// The line through the left segments of all its keyframes.
std::optional<LineEstimate> LineOfLeftViews(const RectifiedCamera& camera,
                                            const Map& map,
                                            const MapLine& line) {
  constexpr double kMinPlaneAngle = 0.002;
  const auto found =
      TriangulateLine(camera,
                      LeftViews(map, line),
                      {.min_plane_angle = kMinPlaneAngle,
                       .max_residual_sigma = std::numeric_limits<double>::infinity()});
  return found ? std::optional(found->estimate) : std::nullopt;
}

}  // namespace

StereoCalibrator::StereoCalibrator(const RectifiedCamera& camera) : camera_(camera) {}

void StereoCalibrator::Observe(const Map& map, const KeyFrame& keyframe) {
  if (camera_.baseline == 0) return;
  const StereoCorrection current = Estimate();
  ObservePoints(map, keyframe, current);
  ObserveLines(map, keyframe, current);
}

StereoCorrection StereoCalibrator::Estimate() const {
  if (information_(0, 0) == 0) return {};
  const Matrix6d prior = Matrix6d::Identity() / (kPriorSigmaPx * kPriorSigmaPx);
  Vector6d k = (information_ + prior).llt().solve(weighted_);
  const Eigen::Matrix<double, 1, 5> mean_terms =
      information_.block<1, 5>(0, 1) / information_(0, 0);
  k(0) = -mean_terms.dot(k.tail<5>());
  return {camera_, k};
}

void StereoCalibrator::Add(const StereoCorrection& current,
                           const Eigen::Vector2d& px,
                           double displacement,
                           double variance,
                           double share) {
  const double sigma = std::sqrt(variance + kNoisePx * kNoisePx);
  const double surprise = std::abs(displacement - current.At(px));
  if (surprise > kMaxDisplacementPx) return;
  const double weight = share * std::min(1.0, kHuber * sigma / surprise) / (sigma * sigma);
  const Vector6d terms = StereoCorrection::Terms(camera_, px);
  information_ += weight * terms * terms.transpose();
  weighted_ += weight * displacement * terms;
}

void StereoCalibrator::ObservePoints(const Map& map,
                                     const KeyFrame& keyframe,
                                     const StereoCorrection& current) {
  constexpr double kMinParallax = 0.002;
  const Frame& frame = keyframe.frame;
  const Eigen::RowVector3d depth_row = frame.cam_from_world.rotation.toRotationMatrix().row(2);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const auto& disparity = frame.features().point_disparity[i];
    const MapPoint* point = frame.points[i].valid() ? map.Find(frame.points[i]) : nullptr;
    if (!disparity || point == nullptr || point->observations.size() < kMinViews) continue;
    const auto found =
        TriangulatePoint(camera_, LeftViews(map, *point), {.min_parallax = kMinParallax});
    if (!found) continue;
    const double z = (frame.cam_from_world * found->point.position).z();
    const double predicted = camera_.DisparityFromDepth(z);
    const double relative = depth_row * found->point.covariance * depth_row.transpose();
    const double variance = predicted * predicted * relative / (z * z);
    if (!(variance <= kMaxPredictionSigmaPx * kMaxPredictionSigmaPx)) continue;
    const Eigen::Vector2d px =
        frame.features().points[i].px - Eigen::Vector2d(disparity->px, 0);
    const double applied = frame.indexed->correction.At(px);
    Add(current, px, disparity->px + applied - predicted, variance, 1);
  }
}

void StereoCalibrator::ObserveLines(const Map& map,
                                    const KeyFrame& keyframe,
                                    const StereoCorrection& current) {
  constexpr double kMinSine = 0.3;
  constexpr double kShareOfEnd = 0.5;  // both ends of a line have much of their error in common
  const Frame& frame = keyframe.frame;
  for (std::size_t i = 0; i < frame.lines.size(); ++i) {
    const auto& right = frame.features().line_right[i];
    const MapLine* line = frame.lines[i].valid() ? map.Find(frame.lines[i]) : nullptr;
    if (!right || line == nullptr || line->observations.size() < kMinViews ||
        std::abs(right->segment.Direction().y()) < kMinSine) {
      continue;
    }
    const auto found = LineOfLeftViews(camera_, map, *line);
    if (!found) continue;
    const LineMeasurement measured{right->segment, Eigen::Matrix2d::Identity(), true};
    const auto residual =
        EvaluateLine(camera_, frame.cam_from_world, ToOrthonormal(found->line), measured);
    if (!residual) continue;
    const Eigen::Matrix2d spread =
        residual->J_line * found->covariance * residual->J_line.transpose();
    // Across the line to along the row: by the x of the projected line's normal, whose sign is that
    // of the residual's.
    const PluckerLine in_right =
        Transform(RightCamera(camera_, frame.cam_from_world), found->line);
    const Eigen::Vector3d image_line = camera_.ProjectMoment(in_right.moment);
    const double nx = image_line.x() / image_line.head<2>().norm();
    const std::array<Eigen::Vector2d, 2> ends{right->segment.start, right->segment.end};
    for (int end = 0; end < 2; ++end) {
      const double variance = spread(end, end) / (nx * nx);
      if (!(variance <= kMaxPredictionSigmaPx * kMaxPredictionSigmaPx)) continue;
      const Eigen::Vector2d& px = ends[static_cast<std::size_t>(end)];
      const double applied = frame.indexed->correction.At(px);
      Add(current, px, applied - residual->r(end) / nx, variance, kShareOfEnd);
    }
  }
}

}  // namespace plumbline
