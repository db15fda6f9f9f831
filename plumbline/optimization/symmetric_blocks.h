// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/elimination_plan.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {

// The lower triangle of a symmetric matrix of 6 x 6 blocks. A small matrix is stored whole; of a
// large one, the diagonal blocks and those accessed by At.
class SymmetricBlocks {
 public:
  SymmetricBlocks(int rows, bool whole);

  bool whole() const { return whole_; }
  // Returns the number of stored blocks, including those on the diagonal.
  std::size_t count() const { return blocks_.size(); }
  // Sets all blocks to zero; they remain stored.
  void SetZero() { std::fill(blocks_.begin(), blocks_.end(), Matrix6d::Zero()); }

  // Returns the block at row >= column >= 0 for writing; zero at its first access. Valid until the
  // next call.
  Matrix6d& At(int row, int column) {
    Row& r = rows_[static_cast<std::size_t>(row)];
    if (column < r.first) Extend(column, r);
    int& place = r.places[static_cast<std::size_t>(column - r.first)];
    if (place < 0) place = Keep();
    return blocks_[static_cast<std::size_t>(place)];
  }
  const Matrix6d& Diagonal(int row) const {
    return blocks_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(row)].places.back())];
  }

  // Calls visit(column, block) for the stored blocks of a row left of the diagonal, ordered by
  // column.
  template <class Visit>
  void ForEachLeft(int row, const Visit& visit) const {
    const Row& r = rows_[static_cast<std::size_t>(row)];
    for (int column = r.first; column < row; ++column) {
      const int place = r.places[static_cast<std::size_t>(column - r.first)];
      if (place >= 0) visit(column, blocks_[static_cast<std::size_t>(place)]);
    }
  }
  BlockPattern Pattern() const;

 private:
  struct Row {
    int first = 0;
    // Index in blocks_ of each column from `first` to the diagonal; -1 if not stored.
    std::vector<int> places;
  };

  int Keep();
  static void Extend(int column, Row& row);

  bool whole_;
  std::vector<Row> rows_;
  std::vector<Matrix6d> blocks_;
};

}  // namespace plumbline
