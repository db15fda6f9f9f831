// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/solvers/ray_match.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Squared Sampson distance of a match over its variance: chi-square with one degree of freedom.
double SampsonChi2(const Eigen::Matrix3d& essential, const RayMatch& match);

// Matches laid out for scoring many essential matrices.
class EpipolarCost {
 public:
  explicit EpipolarCost(std::span<const RayMatch> matches);

  // Sum over the matches of min(SampsonChi2, gate); stops, with part of the sum, once above limit.
  double Truncated(const Eigen::Matrix3d& essential, double gate, double limit) const;

  // Matches with SampsonChi2 below gate.
  int CountBelow(const Eigen::Matrix3d& essential, double gate) const;

 private:
  static constexpr int kBlock = 8;
  using Block = Eigen::Array<double, kBlock, 1>;
  struct Blocks {
    Block ax, ay, bx, by, variance_a, variance_b;
  };

  static Block Chi2(const Eigen::Matrix3d& essential, const Blocks& matches);

  std::vector<Blocks> blocks_;
  int padding_ = 0;  // matches at the end that are always exact
};

}  // namespace plumbline
