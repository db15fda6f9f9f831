// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/statistics.h"
#include "plumbline/features/stereo_pair_check.h"
#include "plumbline/geometry/symmetric_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plumbline {
namespace {

using Matches = std::vector<StereoPairMatch>;
using Samples = std::vector<StereoPairSample>;

// Operation that repairs an image.
enum class Undo { kNothing, kTurn, kMirrorColumns, kMirrorRows };

// Interpretation of the images. The matches are those of the set, with the images repaired.
struct Reading {
  StereoPairFault fault = StereoPairFault::kOtherCameras;
  Matches StereoPairSample::*set = &StereoPairSample::own;
  Undo left = Undo::kNothing;
  Undo right = Undo::kNothing;
  bool exchange = false;   // the left image for the right one
  bool rectified = false;  // as they are, without the calibration
};

constexpr Reading kAsDelivered{};

// In the mirrored set the columns of the right image are in reverse order already.
constexpr std::array kReadings{
    Reading{.fault = StereoPairFault::kSidesSwapped, .exchange = true},
    Reading{.fault = StereoPairFault::kRightLate, .set = &StereoPairSample::after},
    Reading{.fault = StereoPairFault::kRightEarly, .set = &StereoPairSample::before},
    Reading{.fault = StereoPairFault::kRightUpsideDown, .right = Undo::kTurn},
    Reading{.fault = StereoPairFault::kLeftUpsideDown, .left = Undo::kTurn},
    Reading{.fault = StereoPairFault::kOneMirrored, .set = &StereoPairSample::mirrored},
    Reading{.fault = StereoPairFault::kOneMirrored,
            .set = &StereoPairSample::mirrored,
            .right = Undo::kTurn},
    Reading{.fault = StereoPairFault::kOneMirrored,
            .set = &StereoPairSample::mirrored,
            .left = Undo::kMirrorColumns,
            .right = Undo::kMirrorColumns},
    Reading{.fault = StereoPairFault::kOneMirrored,
            .set = &StereoPairSample::mirrored,
            .left = Undo::kMirrorRows,
            .right = Undo::kMirrorColumns},
    Reading{.fault = StereoPairFault::kRectifiedAlready, .rectified = true}};

// A match in the rectified images.
struct RectifiedMatch {
  std::size_t left_index;
  Eigen::Vector2d left;
  double row_difference;  // left minus right
  double disparity;
};

// Error of rows and disparities that a calibration may have, relative to the width.
constexpr double kInexact = 0.01;

// Fewer samples may all be of one short moment.
constexpr int kFewSamples = 3;

// A smooth error of the rows: its value in the middle of the image, and its increments at half the
// width to the right, and as far below.
using RowError = Eigen::Vector3d;

class Evidence {
 public:
  Evidence(const Rectifier& rectifier, const Samples& samples)
      : rectifier_(rectifier),
        samples_(samples),
        size_(rectifier.camera().width, rectifier.camera().height) {}

  std::optional<StereoPairFault> Find() const;
  // Pixels that matches may be off their rows, because corners are not exact.
  double tolerance() const { return std::max(1.0, size_.x() / 750.0); }
  std::vector<RectifiedMatch> Rectified(const Matches& matches, const Reading& reading) const;
  bool Fits(const RectifiedMatch& match, const RowError& error) const {
    return std::abs(match.row_difference - At(error, match.left)) <= tolerance() &&
           match.disparity >= -2 * tolerance();
  }

 private:
  struct Counts {
    int better = 0;     // points that fit with the reading alone
    int worse = 0;      // points that fit as delivered alone
    int fit = 0;        // matches that fit with the reading
    int matches = 0;    // matches with the reading
    int in_favour = 0;  // samples
    int against = 0;
  };

  double At(const RowError& error, const Eigen::Vector2d& px) const {
    const Eigen::Vector2d centred = (px - 0.5 * size_) / (0.5 * size_.x());
    return error.x() + error.tail<2>().dot(centred);
  }
  Eigen::Vector2d Undone(const Eigen::Vector2d& px, Undo undo) const;
  std::vector<RectifiedMatch> AllOwn() const;
  RowError FitRowError(const std::vector<RectifiedMatch>& matches) const;
  double Typical(const RowError& error, const std::vector<RectifiedMatch>& matches) const;
  std::vector<char> FittingPoints(const StereoPairSample& sample,
                                  const Reading& reading,
                                  const RowError& error,
                                  Counts* counts) const;
  Counts Compare(const Reading& reading, const RowError& own_error) const;
  bool DisparitiesTell(const Reading& reading) const;
  bool IsTrue(const Reading& reading, const Counts& counts) const;
  bool SamePlaces(double distance_px, double share) const;
  bool LeftTwice() const;
  bool OtherCameras(const std::vector<RectifiedMatch>& own, const RowError& error) const;

  const Rectifier& rectifier_;
  const Samples& samples_;
  Eigen::Vector2d size_;
};

Eigen::Vector2d Evidence::Undone(const Eigen::Vector2d& px, Undo undo) const {
  const bool columns = undo == Undo::kTurn || undo == Undo::kMirrorColumns;
  const bool rows = undo == Undo::kTurn || undo == Undo::kMirrorRows;
  return {columns ? size_.x() - 1 - px.x() : px.x(), rows ? size_.y() - 1 - px.y() : px.y()};
}

std::vector<RectifiedMatch> Evidence::Rectified(const Matches& matches,
                                                const Reading& reading) const {
  std::vector<RectifiedMatch> result;
  for (const StereoPairMatch& match : matches) {
    std::optional<Eigen::Vector2d> left = Undone(match.left, reading.left);
    std::optional<Eigen::Vector2d> right = Undone(match.right, reading.right);
    if (reading.exchange) std::swap(left, right);
    if (!reading.rectified) {
      left = rectifier_.RectifyLeft(*left);
      right = rectifier_.RectifyRight(*right);
    }
    if (!left || !right) continue;
    result.push_back({match.left_index, *left, left->y() - right->y(), left->x() - right->x()});
  }
  return result;
}

std::vector<RectifiedMatch> Evidence::AllOwn() const {
  std::vector<RectifiedMatch> all;
  for (const StereoPairSample& sample : samples_) {
    const auto own = Rectified(sample.own, kAsDelivered);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

// Least squares over the matches near the last estimate, from the median on.
RowError Evidence::FitRowError(const std::vector<RectifiedMatch>& matches) const {
  constexpr int kRounds = 6;
  constexpr double kNear = 3;  // factor on the median deviation
  std::vector<double> values;
  for (const RectifiedMatch& match : matches) values.push_back(match.row_difference);
  RowError error(UpperMedian(std::move(values)), 0, 0);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> deviations;
    for (const RectifiedMatch& match : matches) {
      deviations.push_back(std::abs(match.row_difference - At(error, match.left)));
    }
    const double limit = std::max(kNear * UpperMedian(deviations), tolerance());
    // One pixel of slope is known beforehand as by a single match, so that few matches do.
    Eigen::Matrix3d normal = Eigen::Vector3d(1e-6, 1, 1).asDiagonal();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const RectifiedMatch& match : matches) {
      if (std::abs(match.row_difference - At(error, match.left)) > limit) continue;
      const Eigen::Vector2d centred = (match.left - 0.5 * size_) / (0.5 * size_.x());
      const Eigen::Vector3d terms(1, centred.x(), centred.y());
      normal += terms * terms.transpose();
      right += terms * match.row_difference;
    }
    error = SolveSymmetric<3>(normal, right);
  }
  return error;
}

double Evidence::Typical(const RowError& error, const std::vector<RectifiedMatch>& matches) const {
  std::vector<double> values;
  for (const RectifiedMatch& match : matches) values.push_back(std::abs(At(error, match.left)));
  return UpperMedian(std::move(values));
}

std::vector<char> Evidence::FittingPoints(const StereoPairSample& sample,
                                          const Reading& reading,
                                          const RowError& error,
                                          Counts* counts) const {
  std::vector<char> fitting(sample.left_points, 0);
  const Matches& matches = sample.*reading.set;
  if (counts != nullptr) counts->matches += static_cast<int>(matches.size());
  for (const RectifiedMatch& match : Rectified(matches, reading)) {
    if (!Fits(match, error)) continue;
    fitting[match.left_index] = 1;
    if (counts != nullptr) ++counts->fit;
  }
  return fitting;
}

Evidence::Counts Evidence::Compare(const Reading& reading, const RowError& own_error) const {
  Counts counts;
  for (const StereoPairSample& sample : samples_) {
    if ((sample.*reading.set).empty()) continue;
    const auto own = FittingPoints(sample, kAsDelivered, own_error, nullptr);
    const auto other = FittingPoints(sample, reading, RowError::Zero(), &counts);
    int better = 0;
    int worse = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      better += other[i] > own[i];
      worse += own[i] > other[i];
    }
    counts.better += better;
    counts.worse += worse;
    constexpr int kSome = 8;
    counts.in_favour += better >= kSome && better > 2 * worse;
    counts.against += worse >= kSome && worse > better;
  }
  return counts;
}

// Returns true if most points have the same position in both images as delivered.
bool Evidence::SamePlaces(double distance_px, double share) const {
  std::size_t matches = 0;
  std::size_t same = 0;
  for (const StereoPairSample& sample : samples_) {
    matches += sample.own.size();
    for (const StereoPairMatch& match : sample.own) {
      same += (match.left - match.right).squaredNorm() < distance_px * distance_px;
    }
  }
  return static_cast<double>(same) >= share * static_cast<double>(matches);
}

// True also if one of the two was compressed: they are almost equal, most points are found again,
// and none elsewhere.
bool Evidence::LeftTwice() const {
  constexpr double kAlike = 0.06;
  constexpr std::size_t kEnough = 100;
  std::size_t points = 0;
  std::size_t matches = 0;
  for (const StereoPairSample& sample : samples_) {
    if (sample.difference > kAlike) return false;
    points += sample.left_points;
    matches += sample.own.size();
  }
  return matches >= kEnough && 10 * matches >= 6 * points && SamePlaces(0.35, 0.97);
}

// Returns true if most matches are off their rows by the same smooth error, which is far from zero.
// This is the remaining explanation, for which few samples may not be enough.
bool Evidence::OtherCameras(const std::vector<RectifiedMatch>& own, const RowError& error) const {
  constexpr std::size_t kEnough = 120;
  constexpr std::size_t kMoreSamples = 5;
  const auto off = std::count_if(own.begin(), own.end(), [&](const RectifiedMatch& match) {
    return std::abs(match.row_difference - At(error, match.left)) <= 3 * tolerance() &&
           std::abs(match.row_difference) > 3 * tolerance();
  });
  return samples_.size() >= kMoreSamples && own.size() >= kEnough &&
         10 * static_cast<std::size_t>(off) >= 6 * own.size();
}

// Returns true if the disparities are of points at different depths, or large. If all points are
// far away, an error of the calibration moves all of them alike, possibly below zero.
bool Evidence::DisparitiesTell(const Reading& reading) const {
  std::vector<double> disparities;
  for (const StereoPairSample& sample : samples_) {
    for (const RectifiedMatch& match : Rectified(sample.*reading.set, reading)) {
      if (Fits(match, RowError::Zero())) disparities.push_back(match.disparity);
    }
  }
  if (disparities.empty()) return false;
  std::sort(disparities.begin(), disparities.end());
  const auto quantile = [&](std::size_t percent) {
    return disparities[(disparities.size() - 1) * percent / 100];
  };
  return quantile(95) - quantile(5) > 6 * tolerance() || quantile(50) > kInexact * size_.x();
}

// Matches of one pair of images may all be taken in another way: a point that fits as delivered
// alone is a mistake. Of the right images of two frames each shows points that the other does not;
// were they alike, `better` and `worse` would differ by a deviation of their square root.
bool Evidence::IsTrue(const Reading& reading, const Counts& counts) const {
  constexpr int kEnough = 45;  // points, over all samples
  constexpr double kDeviations = 6;
  if (counts.better < kEnough || 10 * counts.fit < 6 * counts.matches) return false;
  if (counts.in_favour < kFewSamples || counts.against > 0) return false;
  if (reading.exchange && !DisparitiesTell(reading)) return false;
  if (reading.set == &StereoPairSample::own) return counts.better >= 10 * counts.worse;
  const int both = counts.better + counts.worse;
  return 2 * counts.better >= 5 * counts.worse &&
         counts.better - counts.worse >= kDeviations * std::sqrt(static_cast<double>(both));
}

std::optional<StereoPairFault> Evidence::Find() const {
  if (samples_.size() < kFewSamples) return std::nullopt;
  if (LeftTwice()) return StereoPairFault::kLeftTwice;
  const std::vector<RectifiedMatch> own = AllOwn();
  const RowError error = FitRowError(own);
  const bool inexact = Typical(error, own) > kInexact * size_.x();
  const RowError own_error = inexact ? RowError(RowError::Zero()) : error;
  for (const Reading& reading : kReadings) {
    if (!IsTrue(reading, Compare(reading, own_error))) continue;
    const bool in_place = SamePlaces(1.5, 0.8);
    return reading.rectified && in_place ? StereoPairFault::kLeftTwice : reading.fault;
  }
  if (inexact && OtherCameras(own, error)) return StereoPairFault::kOtherCameras;
  return std::nullopt;
}

}  // namespace

std::string Describe(StereoPairFault fault) {
  switch (fault) {
    case StereoPairFault::kLeftTwice:
      return "the right images are the left ones: is the left side given twice?";
    case StereoPairFault::kSidesSwapped:
      return "the right images fit as left ones: are the sides swapped?";
    case StereoPairFault::kRightLate:
      return "the right images fit the left ones of the frame before: are the two sides paired "
             "wrongly?";
    case StereoPairFault::kRightEarly:
      return "the right images fit the left ones of the frame after: are the two sides paired "
             "wrongly?";
    case StereoPairFault::kRightUpsideDown:
      return "the right images fit when turned by 180 degrees: are they upside down?";
    case StereoPairFault::kLeftUpsideDown:
      return "the left images fit when turned by 180 degrees: are they upside down?";
    case StereoPairFault::kOneMirrored:
      return "the images fit when those of one side are mirrored: is one side flipped?";
    case StereoPairFault::kRectifiedAlready:
      return "the images fit as they are, without the calibration: are they rectified already?";
    case StereoPairFault::kOtherCameras:
      return "the right images are off the rows of the left ones by the calibration: is it that of "
             "other cameras, or of other images of them (rectified or not)?";
  }
  return {};
}

std::size_t CountFitting(const Rectifier& rectifier, const StereoPairSample& sample) {
  const Samples none;
  const Evidence evidence(rectifier, none);
  const std::vector<RectifiedMatch> own = evidence.Rectified(sample.own, kAsDelivered);
  return static_cast<std::size_t>(
      std::count_if(own.begin(), own.end(), [&](const RectifiedMatch& match) {
        return evidence.Fits(match, RowError::Zero());
      }));
}

std::optional<StereoPairFault> FindStereoPairFault(const Rectifier& rectifier,
                                                   const std::vector<StereoPairSample>& samples) {
  return Evidence(rectifier, samples).Find();
}

}  // namespace plumbline
