// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Spatial index of segments. Keeps a reference to them.
class SegmentGrid {
 public:
  explicit SegmentGrid(std::span<const Segment3> segments);

  // Returns the indices, ascending, of the segments no further than `radius` (metres, at most 0.1)
  // from a point. Cost: some 0.2 us plus the near segments.
  std::vector<int> Near(const Eigen::Vector3d& point, double radius) const;

 private:
  std::span<const Segment3> segments_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

// Joins collinear segments, at most `across` metres off, that overlap or leave gaps of at most
// `across`: each chain becomes one segment on the line of its longest. Order: that of the first
// segment of each chain.
std::vector<Segment3> JoinCollinear(std::span<const Segment3> segments, double across);

// Returns the parts of `segment` longer than `min_length` (metres) not covered by collinear
// segments, at most `across` metres off.
std::vector<Segment3> Uncovered(const Segment3& segment,
                                std::span<const Segment3> covers,
                                const SegmentGrid& grid_of_covers,
                                double across,
                                double min_length);

}  // namespace plumbline
