// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/still_features.h"

#include "plumbline/features/types.h"
#include "plumbline/map/frame.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr std::size_t kGap = 5;  // keyframes
constexpr std::size_t kFewestPairs = 5;
constexpr double kStillPx = 1;
// Of the features of a keyframe: a camera at rest has more, a view of the scene alone has fewer.
constexpr double kRestShare = 0.6, kManyShare = 0.02;
constexpr double kManyFeatures = 8;

using Cell = std::pair<int, int>;
Cell CellOf(const Eigen::Vector2d& px) {
  return {static_cast<int>(std::floor(px.x())), static_cast<int>(std::floor(px.y()))};
}

using Cells = std::multimap<Cell, const PointFeature*>;

// Returns the number of features that, displaced by an offset, are where a feature of the same
// octave was before.
std::size_t CountAt(const Cells& before,
                    const std::vector<PointFeature>& now,
                    const Eigen::Vector2d& offset) {
  std::size_t count = 0;
  for (const PointFeature& feature : now) {
    const Eigen::Vector2d px = feature.px + offset;
    const Cell centre = CellOf(px);
    bool found = false;
    for (int i = 0; i < 9 && !found; ++i) {
      const auto range = before.equal_range({centre.first + i % 3 - 1, centre.second + i / 3 - 1});
      for (auto at = range.first; at != range.second && !found; ++at) {
        found = at->second->octave == feature.octave && (at->second->px - px).norm() <= kStillPx;
      }
    }
    count += found ? 1 : 0;
  }
  return count;
}

// Returns how many features are as near to one of before by chance: the mean of those displaced to
// four sides, farther than a feature is uncertain.
double CountByChance(const Cells& before, const std::vector<PointFeature>& now) {
  constexpr double kAway = 9;
  std::size_t count = 0;
  for (const Eigen::Vector2d& side :
       {Eigen::Vector2d(kAway, 0), {-kAway, 0}, {0, kAway}, {0, -kAway}}) {
    count += CountAt(before, now, side);
  }
  return 0.25 * static_cast<double>(count);
}

}  // namespace

bool StillFeatures::Likely() const { return pairs >= kFewestPairs && 2 * with_still > pairs; }

void StillFeatureFinder::Add(std::vector<PointFeature> points) {
  if (last_.size() < kGap) {
    last_.push_back(std::move(points));
    ++number_;
    return;
  }
  std::vector<PointFeature>& before = last_[number_++ % kGap];
  Cells cells;
  for (const PointFeature& feature : before) cells.emplace(CellOf(feature.px), &feature);
  const auto all = static_cast<double>(points.size());
  auto still = static_cast<double>(CountAt(cells, points, Eigen::Vector2d::Zero()));
  const auto many = [&] { return still >= kManyFeatures && still >= kManyShare * all; };
  const bool rests = still > kRestShare * all || points.empty();
  if (!rests && many()) still -= CountByChance(cells, points);
  before = std::move(points);
  if (rests) return;
  ++found_.pairs;
  if (!many()) return;
  ++found_.with_still;
  shares_ += still / all;
}

StillFeatures StillFeatureFinder::Result() const {
  StillFeatures result = found_;
  if (result.with_still > 0) result.share = shares_ / static_cast<double>(result.with_still);
  return result;
}

StillFeatures FindStillFeatures(const Map& map) {
  StillFeatureFinder finder;
  std::optional<SessionId> session;
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (session && keyframe.session != *session) finder.Restart();
    session = keyframe.session;
    finder.Add(MeasuredFeatures(*keyframe.frame.indexed).points);
  }
  return finder.Result();
}

std::optional<std::string> StillFeaturesNote(const StillFeatures& still) {
  if (!still.Likely()) return std::nullopt;
  return std::to_string(std::lround(100 * still.share)) +
         " % of the points stand still in the image while the camera moves: is there text or a "
         "part "
         "of the robot in the picture? --mask FILE leaves it out";
}

}  // namespace plumbline
