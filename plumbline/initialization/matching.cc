// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/matching.h"

#include "plumbline/base/ids.h"
#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {
namespace {

constexpr std::size_t kNearest = 7;
// Scales of the robust loss, one after the other. The first is as large as the error that turns and
// changes of scale cause in a mere shift. The last is larger than the parallax that an affine map
// leaves, and smaller than the error of a wrong match.
constexpr std::array<double, 8> kScalesPx{160, 80, 40, 20, 10, 10, 10, 10};

Eigen::Vector2d MedianShift(std::span<const PixelPair> matches) {
  std::vector<double> x;
  std::vector<double> y;
  for (const PixelPair& m : matches) {
    x.push_back(m.to.x() - m.from.x());
    y.push_back(m.to.y() - m.from.y());
  }
  return {UpperMedian(std::move(x)), UpperMedian(std::move(y))};
}

// Half width of the window around a position without known motion.
constexpr double kFirstWindowPx = 100;
// Half width of the window around the place that a guessed motion predicts.
constexpr double kGuessedWindowPx = 50;
// Half width of the window around the place that the first matches predict.
constexpr double kWindowPx = 25;
constexpr int kFirstMaxDistance = 60;  // Hamming, of 256 bits
constexpr int kMaxDistance = 70;
// Largest ratio of the best to the second best distance in the window.
constexpr double kFirstRatio = 0.8;
constexpr double kRatio = 0.9;
// Largest difference of octaves; two are a scale of 1.44 with the usual factor of 1.2.
constexpr int kMaxOctaveStep = 2;
// Largest difference between the turn of an orientation and the roll of the camera.
constexpr double kMaxRollErrorDeg = 15;
// Largest distance of a line's midpoint from its predicted place, across the line.
constexpr double kMaxLineOffsetPx = 15;

std::vector<PointFeature> Moved(std::vector<PointFeature> points, const ImageMotion& motion) {
  for (PointFeature& point : points) point.px = motion(point.px);
  return points;
}

double Turn(const Features& a, const Features& b, const FeatureMatch& match) {
  return double{b.points[Index(match.b)].angle} - double{a.points[Index(match.a)].angle};
}

// Returns the turn of the camera about its axis: the centre of the window that holds the turns of
// most matches.
double CameraRoll(const Features& a,
                  const Features& b,
                  std::span<const FeatureMatch> matches,
                  double half_width) {
  constexpr int kBins = 180;
  const auto bin_of = [](double turn) {
    const double part = turn / (2 * std::numbers::pi);
    return static_cast<int>((part - std::floor(part)) * kBins) % kBins;
  };
  std::vector<int> count(kBins, 0);
  for (const FeatureMatch& match : matches) ++count[Index(bin_of(Turn(a, b, match)))];
  const int reach = static_cast<int>(half_width / (2 * std::numbers::pi) * kBins);
  int best = -1;
  int best_bin = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    int sum = 0;
    for (int k = -reach; k <= reach; ++k) {
      sum += count[Index((bin + k + kBins) % kBins)];
    }
    if (sum <= best) continue;
    best = sum;
    best_bin = bin;
  }
  return (best_bin + 0.5) * 2 * std::numbers::pi / kBins;
}

void DropOtherTurns(const Features& a,
                    const Features& b,
                    double limit,
                    std::vector<FeatureMatch>& matches) {
  const double roll = CameraRoll(a, b, matches, limit);
  std::erase_if(matches, [&](const FeatureMatch& match) {
    return std::abs(std::remainder(Turn(a, b, match) - roll, 2 * std::numbers::pi)) > limit;
  });
}

ImageMotion MotionOf(const Features& a, const Features& b, std::span<const FeatureMatch> matches) {
  std::vector<PixelPair> pairs;
  for (const FeatureMatch& match : matches) {
    pairs.push_back({a.points[Index(match.a)].px, b.points[Index(match.b)].px});
  }
  return ImageMotion(pairs);
}

void DropFarFromPrediction(const Features& a,
                           const Features& b,
                           const ImageMotion& motion,
                           double limit_px,
                           std::vector<FeatureMatch>& matches) {
  std::erase_if(matches, [&](const FeatureMatch& match) {
    const Eigen::Vector2d expected = motion(a.points[Index(match.a)].px);
    return (b.points[Index(match.b)].px - expected).norm() > limit_px;
  });
}

std::vector<FeatureMatch> MatchMovedLines(const Features& reference,
                                          const Features& frame,
                                          const ImageMotion& motion) {
  std::vector<LineFeature> moved = reference.lines;
  for (LineFeature& line : moved) line.segment = motion(line.segment);
  LineMatchOptions search;
  search.max_angle_deg = kMaxRollErrorDeg;
  search.max_offset_px = kMaxLineOffsetPx;
  search.max_shift_px = kWindowPx;
  return MatchLines(moved, frame.lines, search);
}

}  // namespace

ImageMotion::ImageMotion(std::span<const PixelPair> matches) {
  if (matches.empty()) return;
  for (const PixelPair& m : matches) origin_ += m.from / static_cast<double>(matches.size());
  shift_ = origin_ + MedianShift(matches);
  for (const double scale : kScalesPx) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    for (const PixelPair& m : matches) {
      const double error = (Affine(m.from) - m.to).squaredNorm() / (scale * scale);
      const double weight = 1 / ((1 + error) * (1 + error));  // Geman-McClure
      const Eigen::Vector3d row = (m.from - origin_).homogeneous();
      normal += weight * row * row.transpose();
      right += weight * row * m.to.transpose();
    }
    const Eigen::LLT<Eigen::Matrix3d> factor(normal);
    if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-9)) break;
    const Eigen::Matrix<double, 3, 2> solution = factor.solve(right);
    linear_ = solution.topRows<2>().transpose();
    shift_ = solution.row(2).transpose();
  }
  for (const PixelPair& m : matches) {
    places_.push_back(m.from);
    leftovers_.emplace_back(m.to - Affine(m.from));
  }
}

Eigen::Vector2d ImageMotion::operator()(const Eigen::Vector2d& px) const {
  if (places_.size() < kNearest) return Affine(px);
  std::array<double, kNearest> distances;
  std::array<std::size_t, kNearest> nearest{};
  distances.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < places_.size(); ++i) {  // the nearest are kept in order by insertion
    const double distance = (places_[i] - px).squaredNorm();
    if (!(distance < distances.back())) continue;
    std::size_t k = kNearest - 1;
    for (; k > 0 && distances[k - 1] > distance; --k) {
      distances[k] = distances[k - 1];
      nearest[k] = nearest[k - 1];
    }
    distances[k] = distance;
    nearest[k] = i;
  }
  std::array<double, kNearest> x;
  std::array<double, kNearest> y;
  for (std::size_t k = 0; k < kNearest; ++k) {
    x[k] = leftovers_[nearest[k]].x();
    y[k] = leftovers_[nearest[k]].y();
  }
  return Affine(px) + Eigen::Vector2d(UpperMedian(x), UpperMedian(y));
}

ReferenceMatches MatchToReference(const Features& reference,
                                  const Features& frame,
                                  const ImageMotion& guess) {
  const double max_turn = kMaxRollErrorDeg * kDegree;
  PointMatchOptions search;
  search.max_distance = kFirstMaxDistance;
  search.ratio = kFirstRatio;
  search.max_octave_step = kMaxOctaveStep;
  search.radius_px = guess.known() ? kGuessedWindowPx : kFirstWindowPx;
  ReferenceMatches result;
  result.points = MatchPoints(Moved(reference.points, guess), frame.points, search);
  DropOtherTurns(reference, frame, max_turn, result.points);
  const ImageMotion rough = MotionOf(reference, frame, result.points);
  DropFarFromPrediction(reference, frame, rough, kWindowPx, result.points);
  const ImageMotion motion = MotionOf(reference, frame, result.points);

  search.radius_px = kWindowPx;
  search.max_distance = kMaxDistance;
  search.ratio = kRatio;
  result.points = MatchPoints(Moved(reference.points, motion), frame.points, search);
  DropOtherTurns(reference, frame, max_turn, result.points);
  result.motion = MotionOf(reference, frame, result.points);
  result.lines = MatchMovedLines(reference, frame, result.motion);
  return result;
}

}  // namespace plumbline
