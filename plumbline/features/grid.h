// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/heap_bytes.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// An index of positions over square cells, for fast queries of pixel windows. Positions outside the
// image belong to the border cells and are still found by exact distance. It does not keep the
// positions: queries ask the caller for them.
class PointGrid {
 public:
  PointGrid() = default;
  // Builds the index. It is best if `cell_px` is about the usual radius of a query. Cost: O(n).
  PointGrid(const std::vector<Eigen::Vector2d>& positions, int width, int height, int cell_px = 32);

  // Writes the indices of the positions with |dx| <= radius.x and |dy| <= radius.y, in the order of
  // the cells, into a vector that is reused (cleared first) to save allocations. `position_of`
  // returns the position of an index.
  template <class PositionOf>
  void InWindow(const Eigen::Vector2d& center,
                const Eigen::Vector2d& radius,
                const PositionOf& position_of,
                std::vector<int>* out) const;

  // Returns the index of other positions in an image of the same size, with the same cells.
  PointGrid WithPositions(const std::vector<Eigen::Vector2d>& positions) const;

  bool empty() const { return items_.empty(); }
  // Returns the memory in bytes beside the object itself.
  std::size_t Bytes() const { return HeapBytes(cell_begin_) + HeapBytes(items_); }

 private:
  int CellX(double x) const;
  int CellY(double y) const;

  std::vector<int> cell_begin_;  // first entry of each cell in items_, row by row, then the end
  std::vector<int> items_;       // indices ordered by cell, ascending inside a cell
  int cell_px_ = 32;
  int columns_ = 0;
  int rows_ = 0;
};

template <class PositionOf>
void PointGrid::InWindow(const Eigen::Vector2d& center,
                         const Eigen::Vector2d& radius,
                         const PositionOf& position_of,
                         std::vector<int>* out) const {
  out->clear();
  if (items_.empty()) return;
  const int x0 = CellX(center.x() - radius.x());
  const int x1 = CellX(center.x() + radius.x());
  const int y0 = CellY(center.y() - radius.y());
  const int y1 = CellY(center.y() + radius.y());
  for (int y = y0; y <= y1; ++y) {
    const auto begin = cell_begin_[static_cast<std::size_t>(y * columns_ + x0)];
    const auto end = cell_begin_[static_cast<std::size_t>(y * columns_ + x1) + 1];
    for (int k = begin; k < end; ++k) {
      const int i = items_[static_cast<std::size_t>(k)];
      const Eigen::Vector2d d = position_of(i) - center;
      if (std::abs(d.x()) <= radius.x() && std::abs(d.y()) <= radius.y()) out->push_back(i);
    }
  }
}

}  // namespace plumbline
