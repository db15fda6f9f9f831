// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/collinear.h"

#include "plumbline/base/error.h"
#include "worlds/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.5;  // metres

std::uint64_t KeyOf(const Vector3d& point) {
  const auto index = [](double x) { return static_cast<std::int64_t>(std::floor(x / kCell)); };
  return HashCell(
      index(point.x()), index(point.y()), MixBits(static_cast<std::uint64_t>(index(point.z()))));
}

// Returns true if the shorter segment lies along the line of the longer.
bool AreCollinear(const Segment3& a, const Segment3& b, double across) {
  const Segment3& longer = a.Length() >= b.Length() ? a : b;
  const Segment3& shorter = a.Length() >= b.Length() ? b : a;
  const Vector3d along = longer.Direction();
  for (const Vector3d& end : {shorter.start, shorter.end}) {
    if ((end - longer.start).cross(along).norm() > across) return false;
  }
  // A segment hardly longer than the tolerance is collinear with any.
  return UndirectedAngle(along, shorter.Direction()) < 0.02;
}

int Root(std::vector<int>& parents, int i) {
  while (parents[static_cast<std::size_t>(i)] != i) i = parents[static_cast<std::size_t>(i)];
  return i;
}

// The stretches on the axis, merged if they overlap or nearly touch.
std::vector<Stretch> Merged(std::vector<Stretch> stretches, double gap) {
  std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
    return a.from < b.from || (a.from == b.from && a.to < b.to);
  });
  std::vector<Stretch> merged;
  for (const Stretch& stretch : stretches) {
    if (!merged.empty() && stretch.from <= merged.back().to + gap) {
      merged.back().to = std::max(merged.back().to, stretch.to);
    } else {
      merged.push_back(stretch);
    }
  }
  return merged;
}

Segment3 PartOf(const Segment3& segment, const Stretch& stretch) {
  const Vector3d along = segment.Direction();
  return {segment.start + stretch.from * along, segment.start + stretch.to * along};
}

// Segments that hang together, each chain in the place of its first; other places are empty.
std::vector<std::vector<int>> FindChains(std::span<const Segment3> segments, double across) {
  const SegmentGrid grid(segments);
  const auto count = static_cast<int>(segments.size());
  std::vector<int> parents(segments.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (int i = 0; i < count; ++i) {
    const Segment3& segment = segments[static_cast<std::size_t>(i)];
    // Of two that overlap, an end of one lies on the other.
    for (const Vector3d& end : {segment.start, segment.end}) {
      for (const int j : grid.Near(end, across)) {
        const bool same =
            j != i && AreCollinear(segment, segments[static_cast<std::size_t>(j)], across);
        if (!same) continue;
        const int a = Root(parents, i), b = Root(parents, j);
        parents[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
    }
  }
  std::vector<std::vector<int>> chains(segments.size());
  for (int i = 0; i < count; ++i) {
    chains[static_cast<std::size_t>(Root(parents, i))].push_back(i);
  }
  return chains;
}

}  // namespace

SegmentGrid::SegmentGrid(std::span<const Segment3> segments) : segments_(segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment3& segment = segments[i];
    const int steps = 1 + static_cast<int>(segment.Length() / (0.5 * kCell));
    for (int s = 0; s <= steps; ++s) {
      const double share = static_cast<double>(s) / steps;
      std::vector<int>& cell = cells_[KeyOf(segment.start + share * (segment.end - segment.start))];
      if (cell.empty() || cell.back() != static_cast<int>(i)) cell.push_back(static_cast<int>(i));
    }
  }
}

std::vector<int> SegmentGrid::Near(const Vector3d& point, double radius) const {
  PLUMBLINE_CHECK(radius >= 0 && radius <= 0.2 * kCell, "radius of a search among segments");
  // Every point of a segment has a sample at most a quarter of a cell away.
  const double reach = 0.25 * kCell + radius;
  std::vector<int> near;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d offset((corner & 1) != 0 ? reach : -reach,
                          (corner & 2) != 0 ? reach : -reach,
                          (corner & 4) != 0 ? reach : -reach);
    const auto cell = cells_.find(KeyOf(point + offset));
    if (cell == cells_.end()) continue;
    for (const int i : cell->second) {
      if (Distance(segments_[static_cast<std::size_t>(i)], point) <= radius) near.push_back(i);
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

std::vector<Segment3> JoinCollinear(std::span<const Segment3> segments, double across) {
  std::vector<Segment3> joined;
  for (const std::vector<int>& chain : FindChains(segments, across)) {
    if (chain.empty()) continue;
    const auto longest = std::max_element(chain.begin(), chain.end(), [&](int a, int b) {
      return segments[static_cast<std::size_t>(a)].Length() <
             segments[static_cast<std::size_t>(b)].Length();
    });
    const Segment3& axis = segments[static_cast<std::size_t>(*longest)];
    std::vector<Stretch> stretches;
    for (const int i : chain) {
      const Segment3& segment = segments[static_cast<std::size_t>(i)];
      const double a = axis.Direction().dot(segment.start - axis.start);
      const double b = axis.Direction().dot(segment.end - axis.start);
      stretches.push_back({std::min(a, b), std::max(a, b)});
    }
    for (const Stretch& part : Merged(std::move(stretches), across)) {
      joined.push_back(PartOf(axis, part));
    }
  }
  return joined;
}

std::vector<Segment3> Uncovered(const Segment3& segment,
                                std::span<const Segment3> covers,
                                const SegmentGrid& grid_of_covers,
                                double across,
                                double min_length) {
  // Covers that overlap it pass one of its ends or end along it: both are near one of these places.
  std::vector<int> near;
  const double length = segment.Length();
  const int steps = 1 + static_cast<int>(length / (0.2 * kCell));
  for (int i = 0; i <= steps; ++i) {
    const Vector3d place =
        segment.start + static_cast<double>(i) / steps * (segment.end - segment.start);
    const std::vector<int> here = grid_of_covers.Near(place, 0.1 * kCell + across);
    near.insert(near.end(), here.begin(), here.end());
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<Stretch> covered;
  for (const int i : near) {
    const Segment3& cover = covers[static_cast<std::size_t>(i)];
    if (!AreCollinear(segment, cover, across)) continue;
    if (const auto stretch = StretchWithin(segment, cover, across)) covered.push_back(*stretch);
  }
  std::vector<Segment3> parts;
  double from = 0;
  covered = Merged(std::move(covered), 0);
  covered.push_back({length, length});
  for (const Stretch& stretch : covered) {
    if (stretch.from - from > min_length) parts.push_back(PartOf(segment, {from, stretch.from}));
    from = std::max(from, stretch.to);
  }
  return parts;
}

}  // namespace plumbline
