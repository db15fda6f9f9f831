// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/ba_terms.h"

#include <gtest/gtest.h>

namespace plumbline::testing {

// The blocks that one observation adds, each expected to be w J^T J or w J^T r.
template <int kDof>
struct Blocks {
  LandmarkEquations<kDof> landmark;
  PoseEquations pose;
  Eigen::Matrix<double, 6, kDof> W = Eigen::Matrix<double, 6, kDof>::Zero();
};

template <int kDof, class JPose, class JLandmark, class Residual>
void ExpectBlocks(const Blocks<kDof>& blocks,
                  const JPose& J_pose,
                  const JLandmark& J_landmark,
                  const Residual& r,
                  double w,
                  double tolerance = 1e-10) {
  const auto lower = [](const auto& m) {
    return Eigen::MatrixXd(Eigen::MatrixXd(m).triangularView<Eigen::Lower>());
  };
  const auto near = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LT((a - b).norm(), tolerance * (1 + b.norm())) << a << "\nexpected\n" << b;
  };
  near(lower(blocks.pose.H), lower(w * J_pose.transpose() * J_pose));
  near(blocks.pose.g, w * J_pose.transpose() * r);
  near(lower(blocks.landmark.V), lower(w * J_landmark.transpose() * J_landmark));
  near(blocks.landmark.g, w * J_landmark.transpose() * r);
  near(blocks.W, w * J_pose.transpose() * J_landmark);
}

inline BaPose PoseAt(const Rigid3& cam_from_world) {
  BaPose pose;
  pose.Set(cam_from_world);
  return pose;
}

}  // namespace plumbline::testing
