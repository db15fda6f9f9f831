// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/multifrontal_cholesky.h"

#include "plumbline/base/error.h"
#include "plumbline/base/index.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// Returns the number of scalar rows of a number of blocks.
template <int kSize>
Eigen::Index Scalars(int blocks) {
  return kSize * static_cast<Eigen::Index>(blocks);
}

// Returns the rows that a front changes.
std::span<const int> Changed(const Front& front) {
  return std::span(front.rows).subspan(Index(front.pivots));
}

int CountChanged(const Front& front) { return static_cast<int>(front.rows.size()) - front.pivots; }

// Returns the end of the run of consecutive places that begins at `place[first]`.
int EndOfRun(const std::vector<int>& place, int first, int end) {
  int last = first + 1;
  while (last < end && place[Index(last)] == place[Index(last - 1)] + 1) ++last;
  return last;
}

// Eliminates the pivots. `columns` become those of L, `change` becomes the update of the other
// rows.
bool Eliminate(Eigen::MatrixXd& columns, Eigen::MatrixXd& change) {
  const Eigen::Index pivots = columns.cols();
  Eigen::Ref<Eigen::MatrixXd> top = columns.topRows(pivots);
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower>(top).info() != Eigen::Success) {
    return false;
  }
  if (change.rows() == 0) return true;
  auto below = columns.bottomRows(change.rows());
  top.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(below);
  change.selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
  return true;
}

}  // namespace

template <int kSize>
BlockCholesky<kSize>::BlockCholesky(EliminationPlan plan)
    : fronts_(std::move(plan.fronts)), panels_(fronts_.size()) {
  std::size_t rows = 0;
  for (const Front& front : fronts_) rows += Index(front.pivots);
  front_of_.resize(rows);
  pivot_of_.resize(rows);
  std::vector<int> place(rows, -1);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    panels_[f].columns.resize(Scalars<kSize>(static_cast<int>(front.rows.size())),
                              Scalars<kSize>(front.pivots));
    for (int k = 0; k < front.pivots; ++k) {
      front_of_[Index(front.rows[Index(k)])] = static_cast<int>(f);
      pivot_of_[Index(front.rows[Index(k)])] = k;
    }
    if (front.parent >= 0) panels_[Index(front.parent)].children.push_back(static_cast<int>(f));
    // All children came before their parent.
    for (std::size_t k = 0; k < front.rows.size(); ++k) {
      place[Index(front.rows[k])] = static_cast<int>(k);
    }
    for (const int child : panels_[f].children) {
      for (const int row : Changed(fronts_[Index(child)])) {
        panels_[Index(child)].in_parent.push_back(place[Index(row)]);
      }
    }
  }
  Clear();
}

template <int kSize>
void BlockCholesky<kSize>::Clear() {
  for (Panel& panel : panels_) panel.columns.setZero();
}

template <int kSize>
void BlockCholesky<kSize>::Set(int row, int column, const Block& block) {
  const auto time = [&](int r) { return std::pair(front_of_[Index(r)], pivot_of_[Index(r)]); };
  if (time(row) < time(column)) {
    Set(column, row, block.transpose());
    return;
  }
  const Front& front = fronts_[Index(front_of_[Index(column)])];
  int place = pivot_of_[Index(row)];
  if (front_of_[Index(row)] != front_of_[Index(column)]) {
    const std::span<const int> changed = Changed(front);
    const auto at = std::lower_bound(
        changed.begin(), changed.end(), row, [&](int a, int b) { return time(a) < time(b); });
    PLUMBLINE_CHECK(at != changed.end() && *at == row, "a block that the pattern does not have");
    place = front.pivots + static_cast<int>(at - changed.begin());
  }
  panels_[Index(front_of_[Index(column)])].columns.template block<kSize, kSize>(
      Scalars<kSize>(place), Scalars<kSize>(pivot_of_[Index(column)])) = block;
}

template <int kSize>
void BlockCholesky<kSize>::TakeIn(const Eigen::MatrixXd& change,
                                  const std::vector<int>& place,
                                  Eigen::MatrixXd& columns,
                                  Eigen::MatrixXd& own_change) {
  const int count = static_cast<int>(place.size());
  const int pivots = static_cast<int>(columns.cols() / kSize);
  for (int j = 0; j < count; ++j) {
    const int column = place[Index(j)];
    const bool pivot = column < pivots;
    Eigen::MatrixXd& to = pivot ? columns : own_change;
    const int shift = pivot ? 0 : pivots;
    for (int i = j; i < count;) {
      const int end = EndOfRun(place, i, count);
      to.block(Scalars<kSize>(place[Index(i)] - shift),
               Scalars<kSize>(column - shift),
               Scalars<kSize>(end - i),
               kSize) +=
          change.block(Scalars<kSize>(i), Scalars<kSize>(j), Scalars<kSize>(end - i), kSize);
      i = end;
    }
  }
}

template <int kSize>
bool BlockCholesky<kSize>::Factor(const StopCheck& stop) {
  std::vector<Eigen::MatrixXd> changes(fronts_.size());  // changes that wait for the parent
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    if (IsToStop(stop)) return false;
    const Eigen::Index size = Scalars<kSize>(CountChanged(fronts_[f]));
    Eigen::MatrixXd& change = changes[f];
    change.setZero(size, size);
    for (const int child : panels_[f].children) {
      TakeIn(changes[Index(child)], panels_[Index(child)].in_parent, panels_[f].columns, change);
      changes[Index(child)].resize(0, 0);
    }
    if (!Eliminate(panels_[f].columns, change)) return false;
  }
  return true;
}

template <int kSize>
void BlockCholesky<kSize>::Solve(Eigen::VectorXd& x) const {
  const auto top = [](const Panel& panel) { return panel.columns.topRows(panel.columns.cols()); };
  const auto below = [](const Panel& panel) {
    return panel.columns.bottomRows(panel.columns.rows() - panel.columns.cols());
  };
  const auto gather = [&](std::span<const int> rows) {
    Eigen::VectorXd part(Scalars<kSize>(static_cast<int>(rows.size())));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      part.segment<kSize>(Scalars<kSize>(static_cast<int>(k))) =
          x.segment<kSize>(Scalars<kSize>(rows[k]));
    }
    return part;
  };
  const auto scatter = [&](const Eigen::VectorXd& part, std::span<const int> rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      x.segment<kSize>(Scalars<kSize>(rows[k])) =
          part.segment<kSize>(Scalars<kSize>(static_cast<int>(k)));
    }
  };
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const std::span<const int> pivots = std::span(fronts_[f].rows).first(Index(fronts_[f].pivots));
    Eigen::VectorXd own = gather(pivots);
    top(panels_[f]).template triangularView<Eigen::Lower>().solveInPlace(own);
    scatter(own, pivots);
    Eigen::VectorXd rest = gather(Changed(fronts_[f]));
    rest.noalias() -= below(panels_[f]) * own;
    scatter(rest, Changed(fronts_[f]));
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const std::span<const int> pivots = std::span(fronts_[f].rows).first(Index(fronts_[f].pivots));
    Eigen::VectorXd own = gather(pivots);
    own.noalias() -= below(panels_[f]).transpose() * gather(Changed(fronts_[f]));
    top(panels_[f]).transpose().template triangularView<Eigen::Upper>().solveInPlace(own);
    scatter(own, pivots);
  }
}

template class BlockCholesky<6>;
template class BlockCholesky<7>;

}  // namespace plumbline
