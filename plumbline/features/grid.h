// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// An index of positions over square cells, for fast queries of pixel windows. Positions outside the
// image belong to the border cells and are still found by exact distance.
class PointGrid {
 public:
  PointGrid() = default;
  // Builds the index. It is best if `cell_px` is about the usual radius of a query. Cost: O(n).
  PointGrid(const std::vector<Eigen::Vector2d>& positions, int width, int height, int cell_px = 32);

  // Returns the indices of the positions with |dx| and |dy| <= radius, in the order of the cells.
  std::vector<int> InWindow(const Eigen::Vector2d& center, double radius) const;
  // Writes the indices of the positions with |dx| <= radius.x and |dy| <= radius.y into a vector
  // that is reused (cleared first) to save allocations.
  void InWindow(const Eigen::Vector2d& center,
                const Eigen::Vector2d& radius,
                std::vector<int>* out) const;

  // Returns the index of other positions in an image of the same size, with the same cells.
  PointGrid WithPositions(const std::vector<Eigen::Vector2d>& positions) const;

  bool empty() const { return positions_.empty(); }
  // Returns the memory in bytes beside the object itself.
  std::size_t Bytes() const {
    return positions_.capacity() * sizeof(Eigen::Vector2d) +
           (cell_begin_.capacity() + items_.capacity()) * sizeof(int);
  }

 private:
  int CellX(double x) const;
  int CellY(double y) const;

  std::vector<Eigen::Vector2d> positions_;
  std::vector<int> cell_begin_;  // first entry of each cell in items_, row by row, then the end
  // Indices into positions_, ordered by cell, ascending inside a cell.
  std::vector<int> items_;
  int cell_px_ = 32;
  int columns_ = 0;
  int rows_ = 0;
};

}  // namespace plumbline
