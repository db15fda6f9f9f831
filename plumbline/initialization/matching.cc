// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/matching.h"

#include "plumbline/base/units.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace plumbline {
namespace {

constexpr int kMaxOctaveStep = 2;  // of the scale: 1.44 with the usual 1.2 an octave

std::vector<PointFeature> Moved(std::vector<PointFeature> points, const ImageMotion& motion) {
  for (PointFeature& point : points) point.px = motion(point.px);
  return points;
}

double Turn(const Features& a, const Features& b, const PointMatch& match) {
  return b.points[static_cast<std::size_t>(match.b)].angle -
         a.points[static_cast<std::size_t>(match.a)].angle;
}

// The turn of the camera about its axis: the centre of the window that holds most turns of matches.
double CameraRoll(const Features& a,
                  const Features& b,
                  std::span<const PointMatch> matches,
                  double half_width) {
  constexpr int kBins = 180;
  const auto bin_of = [](double turn) {
    const double part = turn / (2 * std::numbers::pi);
    return static_cast<int>((part - std::floor(part)) * kBins) % kBins;
  };
  std::vector<int> count(kBins, 0);
  for (const PointMatch& match : matches)
    ++count[static_cast<std::size_t>(bin_of(Turn(a, b, match)))];
  const int reach = static_cast<int>(half_width / (2 * std::numbers::pi) * kBins);
  int best = -1;
  int best_bin = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    int sum = 0;
    for (int k = -reach; k <= reach; ++k) {
      sum += count[static_cast<std::size_t>((bin + k + kBins) % kBins)];
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
                    std::vector<PointMatch>& matches) {
  const double roll = CameraRoll(a, b, matches, limit);
  std::erase_if(matches, [&](const PointMatch& match) {
    return std::abs(std::remainder(Turn(a, b, match) - roll, 2 * std::numbers::pi)) > limit;
  });
}

ImageMotion MotionOf(const Features& a, const Features& b, std::span<const PointMatch> matches) {
  std::vector<PixelPair> pairs;
  for (const PointMatch& match : matches) {
    pairs.push_back({a.points[static_cast<std::size_t>(match.a)].px,
                     b.points[static_cast<std::size_t>(match.b)].px});
  }
  return ImageMotion(pairs);
}

void DropFarFromPrediction(const Features& a,
                           const Features& b,
                           const ImageMotion& motion,
                           double limit_px,
                           std::vector<PointMatch>& matches) {
  std::erase_if(matches, [&](const PointMatch& match) {
    const Eigen::Vector2d expected = motion(a.points[static_cast<std::size_t>(match.a)].px);
    return (b.points[static_cast<std::size_t>(match.b)].px - expected).norm() > limit_px;
  });
}

std::vector<LineMatch> MatchMovedLines(const Features& reference,
                                       const Features& frame,
                                       const ImageMotion& motion,
                                       const ReferenceMatchOptions& options) {
  std::vector<LineFeature> moved = reference.lines;
  for (LineFeature& line : moved) line.segment = motion(line.segment);
  LineMatchOptions search;
  search.max_angle_deg = options.max_roll_error_deg;
  search.max_offset_px = options.max_line_offset_px;
  search.max_shift_px = options.window_px;
  return MatchLines(moved, frame.lines, search);
}

}  // namespace

ReferenceMatches MatchToReference(const Features& reference,
                                  const Features& frame,
                                  const ImageMotion& guess,
                                  const ReferenceMatchOptions& options) {
  const double max_turn = options.max_roll_error_deg * kDegree;
  PointMatchOptions search;
  search.max_distance = options.first_max_distance;
  search.ratio = options.first_ratio;
  search.max_octave_step = kMaxOctaveStep;
  search.radius_px = guess.known() ? options.guessed_window_px : options.first_window_px;
  ReferenceMatches result;
  result.points = MatchPoints(Moved(reference.points, guess), frame.points, search);
  DropOtherTurns(reference, frame, max_turn, result.points);
  const ImageMotion rough = MotionOf(reference, frame, result.points);
  DropFarFromPrediction(reference, frame, rough, options.window_px, result.points);
  const ImageMotion motion = MotionOf(reference, frame, result.points);

  search.radius_px = options.window_px;
  search.max_distance = options.max_distance;
  search.ratio = options.ratio;
  result.points = MatchPoints(Moved(reference.points, motion), frame.points, search);
  DropOtherTurns(reference, frame, max_turn, result.points);
  result.motion = MotionOf(reference, frame, result.points);
  result.lines = MatchMovedLines(reference, frame, result.motion, options);
  return result;
}

std::vector<RayMatch> RayMatchesOf(const RectifiedCamera& camera,
                                   const Features& a,
                                   const Features& b,
                                   std::span<const PointMatch> matches) {
  const double focal = 0.5 * (camera.fx + camera.fy);
  std::vector<RayMatch> rays;
  rays.reserve(matches.size());
  for (const PointMatch& match : matches) {
    const PointFeature& in_a = a.points[static_cast<std::size_t>(match.a)];
    const PointFeature& in_b = b.points[static_cast<std::size_t>(match.b)];
    rays.push_back({camera.Unproject(in_a.px).head<2>(),
                    camera.Unproject(in_b.px).head<2>(),
                    in_a.sigma_px / focal,
                    in_b.sigma_px / focal});
  }
  return rays;
}

}  // namespace plumbline
