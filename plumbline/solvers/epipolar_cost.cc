// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/epipolar_cost.h"

#include <cstddef>

#include <Eigen/Geometry>

namespace plumbline {

double SampsonChi2(const Eigen::Matrix3d& essential, const RayMatch& match) {
  const Eigen::Vector3d in_b = essential * match.a.homogeneous();
  const Eigen::Vector3d in_a = essential.transpose() * match.b.homogeneous();
  const double error = match.b.homogeneous().dot(in_b);
  const double variance = match.sigma_b * match.sigma_b * in_b.head<2>().squaredNorm() +
                          match.sigma_a * match.sigma_a * in_a.head<2>().squaredNorm();
  return variance > 0 ? error * error / variance : 0;  // 0 if both points are epipoles
}

EpipolarCost::EpipolarCost(std::span<const RayMatch> matches) {
  const std::size_t count = (matches.size() + kBlock - 1) / kBlock;
  padding_ = static_cast<int>(count * kBlock - matches.size());
  Blocks exact;  // matches of infinite variance
  exact.ax = exact.ay = exact.bx = exact.by = Block::Zero();
  exact.variance_a = exact.variance_b = Block::Constant(1e200);
  blocks_.assign(count, exact);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    Blocks& block = blocks_[i / kBlock];
    const auto k = static_cast<Eigen::Index>(i % kBlock);
    block.ax(k) = matches[i].a.x();
    block.ay(k) = matches[i].a.y();
    block.bx(k) = matches[i].b.x();
    block.by(k) = matches[i].b.y();
    block.variance_a(k) = matches[i].sigma_a * matches[i].sigma_a;
    block.variance_b(k) = matches[i].sigma_b * matches[i].sigma_b;
  }
}

EpipolarCost::Block EpipolarCost::Chi2(const Eigen::Matrix3d& E, const Blocks& m) {
  const Block in_b_x = E(0, 0) * m.ax + E(0, 1) * m.ay + E(0, 2);
  const Block in_b_y = E(1, 0) * m.ax + E(1, 1) * m.ay + E(1, 2);
  const Block in_b_z = E(2, 0) * m.ax + E(2, 1) * m.ay + E(2, 2);
  const Block in_a_x = E(0, 0) * m.bx + E(1, 0) * m.by + E(2, 0);
  const Block in_a_y = E(0, 1) * m.bx + E(1, 1) * m.by + E(2, 1);
  const Block error = m.bx * in_b_x + m.by * in_b_y + in_b_z;
  const Block variance = m.variance_b * (in_b_x.square() + in_b_y.square()) +
                         m.variance_a * (in_a_x.square() + in_a_y.square());
  return error.square() / (variance + 1e-200);
}

double EpipolarCost::Truncated(const Eigen::Matrix3d& essential, double gate, double limit) const {
  double sum = 0;
  for (const Blocks& block : blocks_) {
    sum += Chi2(essential, block).min(gate).sum();
    if (sum > limit) break;
  }
  return sum;
}

int EpipolarCost::CountBelow(const Eigen::Matrix3d& essential, double gate) const {
  int count = -padding_;
  for (const Blocks& block : blocks_) {
    count += static_cast<int>((Chi2(essential, block) < gate).count());
  }
  return count;
}

}  // namespace plumbline
