// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/envelope_cholesky.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// The square block of a panel that ends at the diagonal.
auto DiagonalBlock(const EnvelopePanel& panel) { return panel.rows.rightCols(panel.rows.rows()); }

auto LeftOfDiagonal(const EnvelopePanel& panel) {
  return panel.rows.leftCols(panel.begin - panel.first);
}

// The entries of L in a panel's columns of an earlier one, which is factorized.
void Eliminate(const EnvelopePanel& other, EnvelopePanel& panel) {
  const Eigen::Index first = std::max(panel.first, other.first);
  const Eigen::Index width = other.begin - first;
  auto block = panel.rows.middleCols(other.begin - panel.first, other.rows.rows());
  if (width > 0) {
    block.noalias() -= panel.rows.middleCols(first - panel.first, width) *
                       other.rows.middleCols(first - other.first, width).transpose();
  }
  DiagonalBlock(other).transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(
      block);
}

bool FactorDiagonal(EnvelopePanel& panel) {
  const Eigen::Index left = panel.begin - panel.first;
  Eigen::Ref<Eigen::MatrixXd> diagonal = panel.rows.rightCols(panel.rows.rows());
  if (left > 0) {
    diagonal.selfadjointView<Eigen::Lower>().rankUpdate(panel.rows.leftCols(left), -1);
  }
  return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower>(diagonal).info() == Eigen::Success;
}

}  // namespace

double EnvelopeSize(std::span<const int> first) {
  double cost = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (int j = first[i]; j < static_cast<int>(i); ++j) {
      cost += 1 + std::max(0, j - std::max(first[i], first[static_cast<std::size_t>(j)]));
    }
  }
  return math::Cbrt(6 * cost);
}

bool FactorEnvelope(std::vector<EnvelopePanel>& panels, const StopCheck& stop) {
  for (std::size_t i = 0; i < panels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (panels[j].begin < panels[i].first) continue;
      if (IsToStop(stop)) return false;
      Eliminate(panels[j], panels[i]);
    }
    if (!FactorDiagonal(panels[i])) return false;
  }
  return true;
}

void SolveEnvelope(const std::vector<EnvelopePanel>& panels, Eigen::VectorXd& x) {
  for (const EnvelopePanel& panel : panels) {
    auto own = x.segment(panel.begin, panel.rows.rows());
    own.noalias() -= LeftOfDiagonal(panel) * x.segment(panel.first, panel.begin - panel.first);
    DiagonalBlock(panel).triangularView<Eigen::Lower>().solveInPlace(own);
  }
  for (auto panel = panels.rbegin(); panel != panels.rend(); ++panel) {
    auto own = x.segment(panel->begin, panel->rows.rows());
    DiagonalBlock(*panel).transpose().triangularView<Eigen::Upper>().solveInPlace(own);
    x.segment(panel->first, panel->begin - panel->first).noalias() -=
        LeftOfDiagonal(*panel).transpose() * own;
  }
}

}  // namespace plumbline
