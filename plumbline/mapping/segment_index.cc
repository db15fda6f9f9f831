// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/segment_index.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {

SegmentIndex::SegmentIndex(int width, int height, std::size_t count)
    : cell_(width / double{kColumns}, height / double{kRows}),
      words_((count + kBits - 1) / kBits),
      cells_(static_cast<std::size_t>(kColumns * kRows) * words_, 0),
      directions_(static_cast<std::size_t>(kDirections) * words_, 0),
      open_(words_, 0) {}

void SegmentIndex::Add(std::size_t index, const Segment2& segment) {
  const std::size_t word = index / kBits;
  Eigen::AlignedBox2d box(segment.start);
  box.extend(segment.end);
  const Range columns = Columns(box), rows = Rows(box);
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      At(cells_, row * kColumns + column, word) |= Bit(index);
    }
  }
  const Eigen::Vector2d along = segment.end - segment.start;
  At(directions_, DirectionOf(math::Atan2(along.y(), along.x())) % kDirections, word) |= Bit(index);
  At(open_, 0, word) |= Bit(index);
}

// Returns 0 to kDirections for -pi to pi; the last direction is the first one again.
int SegmentIndex::DirectionOf(double angle) {
  const double turns = angle / (2 * std::numbers::pi) + 0.5;
  return std::clamp(static_cast<int>(std::floor(turns * kDirections)), 0, kDirections);
}

SegmentIndex::Range SegmentIndex::DirectionsAround(const Eigen::Vector2d& direction) {
  constexpr double kSpread = 0.32;  // acos(0.95), plus something for rounding
  const double turns = math::Atan2(direction.y(), direction.x()) / (2 * std::numbers::pi) + 0.5;
  const double spread = kSpread / (2 * std::numbers::pi);
  return {static_cast<int>(std::floor((turns - spread) * kDirections)),
          static_cast<int>(std::floor((turns + spread) * kDirections))};
}

// Places outside the image belong to the cells at its border.
SegmentIndex::Range SegmentIndex::Cells(double first, double last, double cell, int count) {
  const auto at = [&](double px) {
    return static_cast<int>(std::clamp(px / cell, 0.0, count - 1.0));
  };
  return {at(first), at(last)};
}

SegmentIndex::Range SegmentIndex::Columns(const Eigen::AlignedBox2d& box) const {
  return Cells(box.min().x(), box.max().x(), cell_.x(), kColumns);
}

SegmentIndex::Range SegmentIndex::Rows(const Eigen::AlignedBox2d& box) const {
  return Cells(box.min().y(), box.max().y(), cell_.y(), kRows);
}

}  // namespace plumbline
