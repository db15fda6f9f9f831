// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/stereo_calibration.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/geometry/triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// Prior deviation of each coefficient, relative to the width of the image: the angles and lenses of
// a rig are off by about this much, whatever the number of pixels.
constexpr double kCoefficientSigma = 4e-4;
// Largest deviation of a prediction, relative to the width of the image. A prediction from views
// that are close together errs alike for all points of a keyframe, by as much as the poses of the
// views; a map that such predictions have bent would then confirm them.
constexpr double kMaxPredictionSigma = 2.5e-4;
// Deviation of a single displacement in addition to the error of its prediction: the noise of the
// disparity, and the error that the appearance of a landmark causes in all its disparities alike.
constexpr double kNoisePx = 0.5;
constexpr double kHuber = 1.345;          // threshold of the loss, in deviations
constexpr double kMaxDisplacementPx = 3;  // a larger displacement is a wrong match
constexpr std::size_t kMinKeyFrames = 3;
// A correction counts only as far as its root mean square exceeds this: smaller ones may come from
// the biases of corners whose correlation windows show an edge in depth.
constexpr double kBiasPx = 0.04;

// Normal equations of the coefficients of the correction and, as the last unknown, the error of the
// scale around one keyframe.
struct KeyFrameEvidence {
  Eigen::Matrix<double, 7, 7> information = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> weighted = Eigen::Matrix<double, 7, 1>::Zero();

  // Adds a displacement measured at a pixel with these terms. `surprise` is its difference from the
  // current correction; if that is too large, the match is wrong.
  void Add(const Vector6d& terms,
           double predicted,
           double displacement,
           double surprise,
           double variance) {
    if (std::abs(surprise) > kMaxDisplacementPx) return;
    const double sigma = std::sqrt(variance + kNoisePx * kNoisePx);
    const double weight = std::min(1.0, kHuber * sigma / std::abs(surprise)) / (sigma * sigma);
    Eigen::Matrix<double, 7, 1> row;
    row << terms, predicted;
    information += weight * row * row.transpose();
    weighted += weight * displacement * row;
  }
};

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

// Removes the noise from coefficients. In a basis whose parts are independent, both over the
// evidence and in their errors, each part is shrunk by 1 - variance / square, or to zero.
//   covariance    of the coefficients
//   mean_squares  matrix of the quadratic form from coefficients to the mean square of the
//                 correction over all evidence
Vector5d WithoutNoise(const Vector5d& coefficients,
                      const Matrix5d& covariance,
                      const Matrix5d& mean_squares) {
  const Eigen::LLT<Matrix5d> root(covariance);
  const Matrix5d lower = root.matrixL();
  const Matrix5d basis = lower * EigenpairsOf<5>(lower.transpose() * mean_squares * lower).vectors;
  Vector5d parts = basis.inverse() * coefficients;  // each part has a variance of 1
  for (double& part : parts) part *= std::max(0.0, 1 - 1 / (part * part));
  return basis * parts;
}

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
  if (!MeasuresDepth(camera_)) return;
  constexpr double kMinParallax = 0.002;
  const double max_sigma_px = kMaxPredictionSigma * camera_.width;
  const StereoCorrection current = Estimate();
  const Frame& frame = keyframe.frame;
  KeyFrameEvidence evidence;
  const Eigen::RowVector3d depth_row = frame.cam_from_world.rotation.toRotationMatrix().row(2);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const auto& disparity = frame.features().point_disparity[i];
    const MapPoint* point = frame.points[i].valid() ? map.Find(frame.points[i]) : nullptr;
    if (!disparity || point == nullptr || point->observations.size() < kMinKeyFrames) continue;
    const auto found =
        TriangulatePoint(camera_, LeftViews(map, *point), {.min_angle = kMinParallax});
    if (!found) continue;
    const double z = (frame.cam_from_world * found->position).z();
    const double predicted = camera_.DisparityFromDepth(z);
    const double depth_variance = depth_row * found->covariance * depth_row.transpose();
    const double variance = predicted * predicted * depth_variance / (z * z);
    if (!(variance <= max_sigma_px * max_sigma_px)) continue;
    const Eigen::Vector2d px = frame.features().points[i].px - Eigen::Vector2d(disparity->px, 0);
    const double displacement = disparity->px + frame.indexed->correction.stereo.At(px) - predicted;
    evidence.Add(StereoCorrection::Terms(camera_, px),
                 predicted,
                 displacement,
                 displacement - current.At(px),
                 variance);
  }
  if (evidence.information(6, 6) == 0) return;
  const Vector6d coupling = evidence.information.col(6).head<6>() / evidence.information(6, 6);
  const Matrix6d moments = evidence.information.topLeftCorner<6, 6>();
  evidence_.information += moments - coupling * evidence.information.row(6).head<6>();
  evidence_.weighted += evidence.weighted.head<6>() - coupling * evidence.weighted(6);
  evidence_.moments += moments;
}

StereoCorrection StereoCalibrator::Estimate() const {
  const auto& [information, weighted, moments] = evidence_;
  if (moments(0, 0) == 0) return {};
  const double prior_sigma_px = kCoefficientSigma * camera_.width;
  const Matrix6d prior = Matrix6d::Identity() / (prior_sigma_px * prior_sigma_px);
  const Matrix6d covariance = (information + prior).llt().solve(Matrix6d::Identity());
  const Vector6d learned = covariance * weighted;
  const Vector5d means = moments.col(0).tail<5>() / moments(0, 0);
  const Matrix5d mean_squares =
      moments.bottomRightCorner<5, 5>() / moments(0, 0) - means * means.transpose();
  const Vector5d bends =
      WithoutNoise(learned.tail<5>(), covariance.bottomRightCorner<5, 5>(), mean_squares);
  const double square = bends.dot(mean_squares * bends);
  if (square <= kBiasPx * kBiasPx) return {};
  Vector6d k;
  k << -means.dot(bends), bends;
  return {camera_, (1 - kBiasPx * kBiasPx / square) * k};
}

void StereoChange::Begin(const Map& map, const StereoCorrection& correction) {
  state_ = State{map.id(), correction};
  change_ = {};
}

void StereoChange::GiveUp() {
  state_.reset();
  change_ = {};
}

void StereoChange::FollowJoins(const Atlas& atlas) {
  if (state_ && atlas.Find(state_->map) == nullptr) GiveUp();
}

void StereoChange::Step(Map& map) {
  const auto freed = static_cast<std::ptrdiff_t>(std::min(kSlice, retired_.size()));
  retired_.erase(retired_.begin(), retired_.begin() + freed);
  if (!Running(map)) return;
  const FeatureCorrection correction{state_->correction, map.correction().lens};
  auto keyframe = map.keyframes().lower_bound(state_->next);
  for (std::size_t i = 0; i < kSlice && keyframe != map.keyframes().end(); ++i, ++keyframe) {
    const auto& [id, added] = *keyframe;
    change_.ready.emplace_back(id, WithCorrection(added.frame.indexed, correction));
    state_->next = KeyFrameId{id.value + 1};
  }
  if (keyframe != map.keyframes().end()) return;
  if (map.keyframes().size() > kSlice) {
    for (const auto& [id, changed] : map.keyframes()) retired_.push_back(changed.frame.indexed);
  }
  change_.correction = correction;
  map.Apply({std::move(change_)});
  GiveUp();
}

}  // namespace plumbline
