// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/grid.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

PointGrid::PointGrid(const std::vector<Eigen::Vector2d>& positions,
                     int width,
                     int height,
                     int cell_px)
    : cell_px_(cell_px) {
  PLUMBLINE_CHECK(width > 0 && height > 0 && cell_px > 0, "size of the grid");
  columns_ = (width + cell_px - 1) / cell_px;
  rows_ = (height + cell_px - 1) / cell_px;
  // This is a counting sort by cell.
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return static_cast<std::size_t>(CellY(p.y()) * columns_ + CellX(p.x()));
  };
  cell_begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Eigen::Vector2d& p : positions) ++cell_begin_[cell_of(p) + 1];
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  std::vector<int> next(cell_begin_.begin(), cell_begin_.end() - 1);
  items_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    items_[static_cast<std::size_t>(next[cell_of(positions[i])]++)] = static_cast<int>(i);
  }
}

namespace {

// Returns the cell of a coordinate among `count`; 0 for NaN, which a file may contain and which is
// refused only after the grid was made.
int CellOf(double place, int cell_px, int count) {
  const double cell = std::floor(place / cell_px);
  return cell > 0 ? static_cast<int>(std::min(cell, count - 1.0)) : 0;
}

}  // namespace

int PointGrid::CellX(double x) const { return CellOf(x, cell_px_, columns_); }

int PointGrid::CellY(double y) const { return CellOf(y, cell_px_, rows_); }

PointGrid PointGrid::WithPositions(const std::vector<Eigen::Vector2d>& positions) const {
  return {positions, columns_ * cell_px_, rows_ * cell_px_, cell_px_};
}

}  // namespace plumbline
