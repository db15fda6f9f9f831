// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_pair_check.h"

#include "plumbline/features/match_points.h"
#include "plumbline/features/orb.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/image/pyramid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace plumbline {
namespace {

// Frames that are next to each other tell the same; later ones are there for a camera that stands
// still, or sees nothing, at the beginning.
constexpr std::array<std::size_t, 7> kSamples{1, 6, 11, 16, 21, 60, 180};

bool IsSample(std::size_t position) {
  return std::find(kSamples.begin(), kSamples.end(), position) != kSamples.end();
}

// Points of an image as delivered: fine levels only, which place them well.
std::vector<PointFeature> PairPoints(const GrayImage& image) {
  constexpr int kFineLevels = 4;
  constexpr int kCount = 300;
  const OrbOptions options;
  return ExtractOrb(BuildPyramid(image, kFineLevels, options.scale_factor),
                    ValidRegion(image.width(), image.height()),
                    kCount,
                    options);
}

// The image as a mirror shows it.
GrayImage MirroredColumns(const GrayImage& image) {
  GrayImage result(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::reverse_copy(image.row(y), image.row(y) + image.width(), result.row(y));
  }
  return result;
}

// See StereoPairSample::difference. Every fourth row is looked at.
double RelativeDifference(const GrayImage& left, const GrayImage& right) {
  constexpr int kStep = 4;
  std::int64_t sum = 0;
  std::int64_t count = 0;
  const auto for_pixels = [&](const auto& visit) {
    for (int y = 0; y < left.height(); y += kStep) {
      for (int x = 0; x < left.width(); ++x) visit(left.at(x, y), right.at(x, y));
    }
  };
  for_pixels([&](int a, int /*b*/) {
    sum += a;
    ++count;
  });
  const auto mean = static_cast<int>(sum / std::max<std::int64_t>(count, 1));
  std::int64_t difference = 0;
  std::int64_t deviation = 0;
  for_pixels([&](int a, int b) {
    difference += std::abs(a - b);
    deviation += std::abs(a - mean);
  });
  return static_cast<double>(difference) /
         static_cast<double>(std::max<std::int64_t>(deviation, 1));
}

}  // namespace

bool StereoPairCheck::LooksAt(std::size_t position) {
  return IsSample(position) || IsSample(position + 1) || (position > 0 && IsSample(position - 1));
}

std::optional<StereoPairFault> StereoPairCheck::Add(std::size_t position,
                                                    const SensorFrame& frame) {
  if (done_ || !LooksAt(position) || !Usable(frame)) return std::nullopt;
  const bool follows = right_before_ && position == position_before_ + 1;
  if (!follows) right_before_.reset();
  std::optional<StereoPairFault> fault;
  if (std::exchange(waits_, false)) {
    if (follows && fits_badly_) samples_.back().after = MatchWith(*frame.right);
    fault = FindStereoPairFault(rectifier_, samples_);
    done_ = fault.has_value();
  }
  if (IsSample(position)) Begin(frame);
  right_before_ = *frame.right;
  position_before_ = position;
  return fault;
}

void StereoPairCheck::Begin(const SensorFrame& frame) {
  // Below this share of matches that fit a sample is looked at more closely.
  constexpr double kGoodShare = 0.75;
  constexpr std::size_t kFewMatches = 20;
  StereoPairSample& sample = samples_.emplace_back();
  left_ = PairPoints(frame.left);
  sample.left_points = left_.size();
  sample.own = MatchWith(*frame.right);
  sample.difference = RelativeDifference(frame.left, *frame.right);
  waits_ = true;
  const std::size_t fitting = CountFitting(rectifier_, sample);
  fits_badly_ = static_cast<double>(fitting) < kGoodShare * static_cast<double>(sample.own.size());
  if (fits_badly_ && right_before_) sample.before = MatchWith(*right_before_);
  if (fitting < kFewMatches) sample.mirrored = MatchWith(MirroredColumns(*frame.right));
}

std::vector<StereoPairMatch> StereoPairCheck::MatchWith(const GrayImage& right) const {
  PointMatchOptions options;
  options.max_octave_step = 1;
  const std::vector<PointFeature> points = PairPoints(right);
  std::vector<StereoPairMatch> matches;
  for (const FeatureMatch& match : MatchPoints(left_, points, options)) {
    const auto left = static_cast<std::size_t>(match.a);
    matches.push_back({left, left_[left].px, points[static_cast<std::size_t>(match.b)].px});
  }
  return matches;
}

bool StereoPairCheck::Usable(const SensorFrame& frame) const {
  const RectifiedCamera& camera = rectifier_.camera();
  const auto fits = [&](const GrayImage& image) {
    return image.width() == camera.width && image.height() == camera.height;
  };
  return rectifier_.calibration().right && frame.right && fits(frame.left) && fits(*frame.right);
}

}  // namespace plumbline
