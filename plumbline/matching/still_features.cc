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
constexpr int kStillBits = 50;  // of 256
// Of the features of a keyframe: a camera at rest has more, a view of the scene alone has fewer.
constexpr double kRestShare = 0.6, kManyShare = 0.02;
constexpr std::size_t kManyFeatures = 8;

using Cell = std::pair<int, int>;
Cell CellOf(const Eigen::Vector2d& px) {
  return {static_cast<int>(std::floor(px.x())), static_cast<int>(std::floor(px.y()))};
}

std::size_t CountStill(const std::vector<PointFeature>& before,
                       const std::vector<PointFeature>& now) {
  std::multimap<Cell, const PointFeature*> cells;
  for (const PointFeature& feature : before) cells.emplace(CellOf(feature.px), &feature);
  std::size_t still = 0;
  for (const PointFeature& feature : now) {
    const Cell centre = CellOf(feature.px);
    bool found = false;
    for (int i = 0; i < 9 && !found; ++i) {
      const auto range = cells.equal_range({centre.first + i % 3 - 1, centre.second + i / 3 - 1});
      for (auto at = range.first; at != range.second && !found; ++at) {
        found = (at->second->px - feature.px).norm() <= kStillPx &&
                HammingDistance(at->second->descriptor, feature.descriptor) <= kStillBits;
      }
    }
    still += found ? 1 : 0;
  }
  return still;
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
  const std::size_t still = CountStill(before, points);
  const double share =
      points.empty() ? 1 : static_cast<double>(still) / static_cast<double>(points.size());
  before = std::move(points);
  if (share > kRestShare) return;
  ++found_.pairs;
  if (still < kManyFeatures || share < kManyShare) return;
  ++found_.with_still;
  shares_ += share;
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
