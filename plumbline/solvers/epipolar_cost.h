// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/solvers/ray_match.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Returns the squared Sampson distance of a match over its variance: chi-square with one degree of
// freedom.
double SampsonChi2(const Eigen::Matrix3d& essential, const RayMatch& match);

// Matches in a layout for scoring many essential matrices.
class EpipolarCost {
 public:
  explicit EpipolarCost(std::span<const RayMatch> matches);

  // Returns the sum over the matches of min(SampsonChi2, gate); stops with a partial sum once it
  // exceeds `limit`.
  double Truncated(const Eigen::Matrix3d& essential, double gate, double limit) const;

  // Returns the number of matches with SampsonChi2 below gate.
  int CountBelow(const Eigen::Matrix3d& essential, double gate) const;

 private:
  static constexpr int kBlock = 8;
  using Block = Eigen::Array<double, kBlock, 1>;
  struct Blocks {
    Block ax, ay, bx, by, variance_a, variance_b;
  };

  static Block Chi2(const Eigen::Matrix3d& essential, const Blocks& matches);

  std::vector<Blocks> blocks_;
  // Matches at the end that only fill the last block; their residual is always 0.
  int padding_ = 0;
};

}  // namespace plumbline
