// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/match_points.h"

#include "plumbline/features/grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace plumbline {
namespace {

struct Best {
  int index = -1;
  int distance = 257;
  int second = 257;
};

bool SimilarShape(const PointFeature& a, const PointFeature& b, const PointMatchOptions& options) {
  if (std::abs(a.octave - b.octave) > options.max_octave_step) return false;
  if (options.max_angle_deg <= 0) return true;
  const double difference = std::remainder(a.angle - b.angle, 2 * std::numbers::pi);
  return std::abs(difference) <= options.max_angle_deg * std::numbers::pi / 180;
}

// The best of `candidates` (indices into `set`) for each of `queries`.
class CandidateSearch {
 public:
  CandidateSearch(const std::vector<PointFeature>& set, double radius)
      : set_(set), all_(set.size()) {
    std::iota(all_.begin(), all_.end(), 0);
    if (radius <= 0 || set.empty()) return;
    std::vector<Eigen::Vector2d> positions;
    positions.reserve(set.size());
    Eigen::Vector2d extent = Eigen::Vector2d::Ones();
    for (const PointFeature& p : set) {
      positions.push_back(p.px);
      extent = extent.cwiseMax(p.px);
    }
    const int cell = std::clamp(static_cast<int>(radius), 8, 256);
    grid_ = PointGrid(
        positions, static_cast<int>(extent.x()) + 1, static_cast<int>(extent.y()) + 1, cell);
  }

  Best Find(const PointFeature& query, const PointMatchOptions& options) {
    const std::vector<int>* candidates = &all_;
    if (options.radius_px > 0) {
      grid_.InWindow(query.px, Eigen::Vector2d::Constant(options.radius_px), &near_);
      candidates = &near_;
    }
    Best best;
    for (const int i : *candidates) {
      const PointFeature& other = set_[static_cast<std::size_t>(i)];
      if (!SimilarShape(query, other, options)) continue;
      const int distance = HammingDistance(query.descriptor, other.descriptor);
      if (distance < best.distance) {
        best.second = best.distance;
        best.distance = distance;
        best.index = i;
      } else {
        best.second = std::min(best.second, distance);
      }
    }
    return best;
  }

 private:
  const std::vector<PointFeature>& set_;
  std::vector<int> all_;
  std::vector<int> near_;
  PointGrid grid_;
};

}  // namespace

std::vector<PointMatch> MatchPoints(const std::vector<PointFeature>& a,
                                    const std::vector<PointFeature>& b,
                                    const PointMatchOptions& options) {
  CandidateSearch in_b(b, options.radius_px);
  CandidateSearch in_a(a, options.radius_px);
  std::vector<PointMatch> matches;
  std::vector<int> owner(b.size(), -1);  // index into matches
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Best best = in_b.Find(a[i], options);
    if (best.index < 0 || best.distance > options.max_distance) continue;
    if (options.ratio < 1 && best.distance >= options.ratio * best.second) continue;
    const auto j = static_cast<std::size_t>(best.index);
    if (options.mutual && in_a.Find(b[j], options).index != static_cast<int>(i)) continue;
    if (owner[j] >= 0) {  // only without the mutual test
      PointMatch& earlier = matches[static_cast<std::size_t>(owner[j])];
      if (best.distance >= earlier.distance) continue;
      earlier.a = -1;
    }
    owner[j] = static_cast<int>(matches.size());
    matches.push_back({static_cast<int>(i), best.index, best.distance});
  }
  std::erase_if(matches, [](const PointMatch& m) { return m.a < 0; });
  return matches;
}

}  // namespace plumbline
