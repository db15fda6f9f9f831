// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_calibration.h"

#include "plumbline/geometry/triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// Of each coefficient, relative to the width of the image: a rig's angles and lenses are off by so
// much whatever the number of pixels.
constexpr double kPriorSigma = 4e-4;
// Of a single displacement, beside the error of its prediction: noise of the disparity, and what a
// landmark's looks do to all its disparities alike.
constexpr double kNoisePx = 0.5;
constexpr double kHuber = 1.345;               // sigma
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

}  // namespace

StereoCalibrator::StereoCalibrator(const RectifiedCamera& camera) : camera_(camera) {}

void StereoCalibrator::Observe(const Map& map, const KeyFrame& keyframe) {
  if (camera_.baseline == 0) return;
  constexpr double kMinParallax = 0.002;
  const StereoCorrection current = Estimate();
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
    const Eigen::Vector2d px = frame.features().points[i].px - Eigen::Vector2d(disparity->px, 0);
    const double applied = frame.indexed->correction.At(px);
    Add(current, px, disparity->px + applied - predicted, variance);
  }
}

StereoCorrection StereoCalibrator::Estimate() const {
  if (information_(0, 0) == 0) return {};
  const double prior_sigma_px = kPriorSigma * camera_.width;
  const Matrix6d prior = Matrix6d::Identity() / (prior_sigma_px * prior_sigma_px);
  Vector6d k = (information_ + prior).llt().solve(weighted_);
  const Eigen::Matrix<double, 1, 5> mean_terms =
      information_.block<1, 5>(0, 1) / information_(0, 0);
  k(0) = -mean_terms.dot(k.tail<5>());
  return {camera_, k};
}

void StereoCalibrator::Add(const StereoCorrection& current,
                           const Eigen::Vector2d& px,
                           double displacement,
                           double variance) {
  const double sigma = std::sqrt(variance + kNoisePx * kNoisePx);
  const double surprise = std::abs(displacement - current.At(px));
  if (surprise > kMaxDisplacementPx) return;
  const double weight = std::min(1.0, kHuber * sigma / surprise) / (sigma * sigma);
  const Vector6d terms = StereoCorrection::Terms(camera_, px);
  information_ += weight * terms * terms.transpose();
  weighted_ += weight * displacement * terms;
}

}  // namespace plumbline
