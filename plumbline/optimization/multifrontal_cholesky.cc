// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/multifrontal_cholesky.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/ids.h"
#include "plumbline/optimization/symmetric_rank_update.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace plumbline {

namespace {

// The columns of the factor, numbered in the order of elimination. Each lists its rows below the
// diagonal, ascending.
using Columns = std::vector<std::vector<int>>;

// Returns the number of multiplications of blocks to eliminate `pivots` rows that update `below`
// others.
double Multiplications(double pivots, double below) {
  const auto full = [](double rows) { return (rows - 1) * rows * (rows + 1) / 6; };
  return full(pivots + below) - full(below);
}

// Returns the multiplications of a front, plus the work of moving its entries about, counted as
// multiplications.
double Work(double pivots, double below) {
  constexpr double kMovingOneBlock = 2;
  const double rows = pivots + below;
  return Multiplications(pivots, below) + 0.5 * kMovingOneBlock * rows * rows;
}

std::vector<int> MinimumDegreeOrder(const BlockPattern& pattern) {
  using Matrix = Eigen::SparseMatrix<double>;
  const auto size = static_cast<Eigen::Index>(pattern.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < static_cast<int>(size); ++row) {
    entries.emplace_back(row, row, 1);
    for (const int column : pattern[Index(row)]) {
      entries.emplace_back(row, column, 1);
      entries.emplace_back(column, row, 1);
    }
  }
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(size);
  Eigen::AMDOrdering<int>()(matrix, permutation);
  const auto& indices = permutation.indices();
  return {indices.data(), indices.data() + indices.size()};
}

// Returns the columns of the factor for an order of elimination. `order` lists the rows by the time
// of their elimination. When stopped, columns are missing.
Columns Fill(const BlockPattern& pattern, const std::vector<int>& order, const StopCheck& stop) {
  std::vector<int> time(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) time[Index(order[k])] = static_cast<int>(k);
  Columns columns(order.size());
  for (std::size_t row = 0; row < pattern.size(); ++row) {
    for (const int column : pattern[row]) {
      const auto [early, late] = std::minmax(time[row], time[Index(column)]);
      columns[Index(early)].push_back(late);
    }
  }
  for (std::vector<int>& column : columns) {
    if (IsToStop(stop)) break;
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    if (column.empty()) continue;
    // The first row below the diagonal is the parent: it also gets all rows that the column has
    // below it.
    std::vector<int>& parent = columns[Index(column.front())];
    parent.insert(parent.end(), column.begin() + 1, column.end());
  }
  return columns;
}

// Groups columns that are eliminated together. Each group stands at its last column; the others'
// entries are empty. A column joins that of its first row below the diagonal if one larger front is
// less work than two, although some of its entries are then zero.
std::vector<std::vector<int>> MergeColumns(const Columns& columns) {
  const auto below = [&](int column) { return static_cast<double>(columns[Index(column)].size()); };
  std::vector<std::vector<int>> merged(columns.size()), children(columns.size());
  for (int parent = 0; parent < static_cast<int>(columns.size()); ++parent) {
    std::vector<int>& own = children[Index(parent)];
    std::stable_sort(own.begin(), own.end(), [&](int a, int b) { return below(a) > below(b); });
    std::vector<int>& pivots = merged[Index(parent)];
    for (const int child : own) {
      const auto count = static_cast<double>(pivots.size() + 1);
      const auto of_child = static_cast<double>(merged[Index(child)].size());
      if (Work(count + of_child, below(parent)) >
          Work(count, below(parent)) + Work(of_child, below(child))) {
        continue;
      }
      pivots.insert(pivots.end(), merged[Index(child)].begin(), merged[Index(child)].end());
      merged[Index(child)].clear();
    }
    pivots.push_back(parent);
    if (!columns[Index(parent)].empty()) {
      children[Index(columns[Index(parent)].front())].push_back(parent);
    }
  }
  return merged;
}

// Returns an order with children before parents and each subtree in one piece. The parent of each
// node must have a greater index.
std::vector<int> Postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(parent.size());
  std::vector<int> order, open;
  for (int node = size - 1; node >= 0; --node) {
    (parent[Index(node)] < 0 ? open : children[Index(parent[Index(node)])]).push_back(node);
  }
  // The reverse order is a walk that meets parents first and the last children first.
  std::reverse(open.begin(), open.end());
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    order.push_back(node);
    auto& own = children[Index(node)];
    open.insert(open.end(), own.rbegin(), own.rend());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

std::vector<Front> MakeFronts(const Columns& columns, const std::vector<int>& order) {
  const std::vector<std::vector<int>> merged = MergeColumns(columns);
  std::vector<int> heads, front_of(columns.size());
  for (std::size_t column = 0; column < merged.size(); ++column) {
    for (const int pivot : merged[column]) front_of[Index(pivot)] = static_cast<int>(heads.size());
    if (!merged[column].empty()) heads.push_back(static_cast<int>(column));
  }
  std::vector<int> parent(heads.size(), -1);
  for (std::size_t f = 0; f < heads.size(); ++f) {
    const std::vector<int>& below = columns[Index(heads[f])];
    if (!below.empty()) parent[f] = front_of[Index(below.front())];
  }
  const std::vector<int> sequence = Postorder(parent);
  std::vector<int> place(heads.size());
  for (std::size_t k = 0; k < sequence.size(); ++k) place[Index(sequence[k])] = static_cast<int>(k);
  std::vector<Front> fronts;
  for (const int f : sequence) {
    const int head = heads[Index(f)];
    Front front;
    front.pivots = static_cast<int>(merged[Index(head)].size());
    front.parent = parent[Index(f)] < 0 ? -1 : place[Index(parent[Index(f)])];
    for (const int column : merged[Index(head)]) front.rows.push_back(order[Index(column)]);
    for (const int column : columns[Index(head)]) front.rows.push_back(order[Index(column)]);
    fronts.push_back(std::move(front));
  }
  return fronts;
}

}  // namespace

EliminationPlan PlanElimination(const BlockPattern& pattern, const StopCheck& stop) {
  if (pattern.empty() || IsToStop(stop)) return {};
  const std::vector<int> order = MinimumDegreeOrder(pattern);
  const Columns columns = Fill(pattern, order, stop);
  if (IsToStop(stop)) return {};
  EliminationPlan plan{MakeFronts(columns, order), 0};
  for (const auto& column : columns) {
    plan.multiplications += Multiplications(1, static_cast<double>(column.size()));
  }
  return plan;
}

EliminationPlan PlanInOneFront(int rows) {
  const double size = rows;
  if (rows == 0) return {};
  EliminationPlan plan{{Front{std::vector<int>(Index(rows)), rows, -1}}, Multiplications(size, 0)};
  std::iota(plan.fronts[0].rows.begin(), plan.fronts[0].rows.end(), 0);
  return plan;
}

double FullSize(const EliminationPlan& plan) { return math::Cbrt(6 * plan.multiplications); }

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
  SubtractSquare(below, change);
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
