// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/symmetric_rank_update.h"

#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

// A tile of C that is computed at once, in registers.
constexpr Eigen::Index kTileRows = 8, kTileColumns = 4;

// Products of so many columns of A are summed before they are subtracted: panels of them stay in
// the first cache.
constexpr Eigen::Index kColumnsAtOnce = 256;

// Rows of A in panels of kTileRows rows, each stored by columns; the last one is filled with zeros.
struct Panels {
  const double* values = nullptr;
  Eigen::Index rows = 0;     // of A
  Eigen::Index columns = 0;  // of A
};

struct Subtract {
  // Subtracts the products of a panel's rows with some rows of another one.
  [[gnu::always_inline]] static inline void Tile(
      const double* a, const double* b, Eigen::Index columns, double* c, Eigen::Index stride) {
    double sum[kTileColumns][kTileRows] = {};
    for (Eigen::Index k = 0; k < columns; ++k, a += kTileRows, b += kTileRows) {
      for (Eigen::Index j = 0; j < kTileColumns; ++j) {
        for (Eigen::Index i = 0; i < kTileRows; ++i) sum[j][i] += a[i] * b[j];
      }
    }
    for (Eigen::Index j = 0; j < kTileColumns; ++j) {
      for (Eigen::Index i = 0; i < kTileRows; ++i) c[j * stride + i] -= sum[j][i];
    }
  }

  // `c` has as many rows and columns as there are rows, and is stored by columns.
  [[gnu::always_inline]] static inline void Run(const Panels& panels, double* c) {
    const Eigen::Index rows = panels.rows;
    for (Eigen::Index column = 0; column < rows; column += kTileColumns) {
      const Eigen::Index first = column - column % kTileRows;
      const double* b = panels.values + first * panels.columns + (column - first);
      for (Eigen::Index row = first; row < rows; row += kTileRows) {
        const double* a = panels.values + row * panels.columns;
        if (row > first && row + kTileRows <= rows && column + kTileColumns <= rows) {
          Tile(a, b, panels.columns, c + column * rows + row, rows);
          continue;
        }
        // A tile at the diagonal or at the border of C.
        double part[kTileRows * kTileColumns] = {};
        Tile(a, b, panels.columns, part, kTileRows);
        for (Eigen::Index j = column; j < std::min(column + kTileColumns, rows); ++j) {
          for (Eigen::Index i = std::max(row, j); i < std::min(row + kTileRows, rows); ++i) {
            c[j * rows + i] += part[(j - column) * kTileRows + (i - row)];
          }
        }
      }
    }
  }
};

}  // namespace

void SubtractSquare(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& A,
                    Eigen::MatrixXd& C) {
  PLUMBLINE_CHECK(C.rows() == A.rows() && C.cols() == A.rows(), "matrices that do not fit");
  const Eigen::Index count = (A.rows() + kTileRows - 1) / kTileRows;
  std::vector<double> values;
  for (Eigen::Index first = 0; first < A.cols(); first += kColumnsAtOnce) {
    const Eigen::Index columns = std::min(kColumnsAtOnce, A.cols() - first);
    values.assign(static_cast<std::size_t>(count * kTileRows * columns), 0);
    double* to = values.data();
    for (Eigen::Index row = 0; row < A.rows(); row += kTileRows) {
      const Eigen::Index rows = std::min(kTileRows, A.rows() - row);
      for (Eigen::Index k = first; k < first + columns; ++k, to += kTileRows) {
        std::copy_n(&A.coeffRef(row, k), rows, to);
      }
    }
    RunBest<Subtract>(Panels{values.data(), A.rows(), columns}, C.data());
  }
}

}  // namespace plumbline
