// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/segment.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Index of segments of an image by position and direction. Each cell of a coarse grid, and each
// range of directions, has a set of segments, with one bit for each segment.
class SegmentIndex {
 public:
  // An empty index for `count` segments of an image of width x height pixels.
  SegmentIndex(int width, int height, std::size_t count);

  void Add(std::size_t index, const Segment2& segment);
  // Removes a segment from later searches.
  void Remove(std::size_t index) { At(open_, 0, index / kBits) &= ~Bit(index); }

  // Calls visit(index), ascending, for all segments whose bounding box meets `box` and whose
  // direction is within 18.2 degrees (a cosine of 0.95) of the unit vector. It is also called for
  // some other segments.
  template <class Visit>
  void ForEachNear(const Eigen::AlignedBox2d& box,
                   const Eigen::Vector2d& direction,
                   const Visit& visit) const {
    const Range columns = Columns(box), rows = Rows(box);
    const Range directions = DirectionsAround(direction);
    for (std::size_t word = 0; word < words_; ++word) {
      std::uint64_t near = 0, parallel = 0;
      for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = columns.first; column <= columns.last; ++column) {
          near |= At(cells_, row * kColumns + column, word);
        }
      }
      for (int k = directions.first; k <= directions.last; ++k) {
        parallel |= At(directions_, (k + kDirections) % kDirections, word);
      }
      for (std::uint64_t bits = near & parallel & At(open_, 0, word); bits != 0; bits &= bits - 1) {
        visit(word * kBits + static_cast<std::size_t>(std::countr_zero(bits)));
      }
    }
  }

 private:
  static constexpr int kColumns = 16, kRows = 8, kDirections = 16;
  static constexpr std::size_t kBits = 64;
  struct Range {
    int first = 0, last = 0;
  };

  static std::uint64_t Bit(std::size_t index) { return std::uint64_t{1} << (index % kBits); }
  std::uint64_t& At(std::vector<std::uint64_t>& bits, int set, std::size_t word) const {
    return bits[static_cast<std::size_t>(set) * words_ + word];
  }
  std::uint64_t At(const std::vector<std::uint64_t>& bits, int set, std::size_t word) const {
    return bits[static_cast<std::size_t>(set) * words_ + word];
  }
  static int DirectionOf(double angle);
  static Range DirectionsAround(const Eigen::Vector2d& direction);
  static Range Cells(double first, double last, double cell, int count);
  Range Columns(const Eigen::AlignedBox2d& box) const;
  Range Rows(const Eigen::AlignedBox2d& box) const;

  Eigen::Vector2d cell_;                           // size of a cell, pixels
  std::size_t words_ = 0;                          // number of words in each set
  std::vector<std::uint64_t> cells_, directions_;  // sets of segments
  std::vector<std::uint64_t> open_;                // one set: the segments not removed
};

}  // namespace plumbline
