// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/symmetric_blocks.h"

namespace plumbline {

SymmetricBlocks::SymmetricBlocks(int rows, bool whole)
    : whole_(whole), rows_(static_cast<std::size_t>(rows)) {
  for (int row = 0; row < rows; ++row) {
    Row& r = rows_[static_cast<std::size_t>(row)];
    r.first = whole ? 0 : row;
    for (int column = r.first; column <= row; ++column) r.places.push_back(Keep());
  }
}

BlockPattern SymmetricBlocks::Pattern() const {
  BlockPattern pattern(rows_.size());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    ForEachLeft(static_cast<int>(row),
                [&](int column, const Matrix6d& /*block*/) { pattern[row].push_back(column); });
  }
  return pattern;
}

int SymmetricBlocks::Keep() {
  blocks_.push_back(Matrix6d::Zero());
  return static_cast<int>(blocks_.size()) - 1;
}

// Makes room for a column left of the first one. Room is made for several columns, since they are
// often asked for one after the other, to the left.
void SymmetricBlocks::Extend(int column, Row& row) {
  constexpr int kStep = 32;
  const int first = column / kStep * kStep;
  row.places.insert(row.places.begin(), static_cast<std::size_t>(row.first - first), -1);
  row.first = first;
}

}  // namespace plumbline
