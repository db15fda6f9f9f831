// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include "tests/optimization/random_scene.h"
#include <array>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kPoses = 3;
constexpr int kDof = 4;
constexpr int kLandmarks = 5;
constexpr int kSize = 6 * kPoses + kDof * kLandmarks;
constexpr int kRows = 8;  // of each observation

// A random least-squares problem in which landmark i couples to the poses i % 3 and (i + 1) % 3,
// as one dense system and as blocks.
struct System {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(kSize);
  std::array<PoseEquations, kPoses> poses;
  std::array<LandmarkEquations<kDof>, kLandmarks> landmarks;
  std::array<std::vector<Coupling<kDof>>, kLandmarks> couplings;
};

System RandomSystem(unsigned seed) {
  testing::Random random(seed);
  const auto uniform = [&random]() { return random.Uniform(-1, 1); };
  System s;
  for (int i = 0; i < kLandmarks; ++i) {
    const auto l = static_cast<std::size_t>(i);
    for (const int pose : {std::min(i % 3, (i + 1) % 3), std::max(i % 3, (i + 1) % 3)}) {
      const Eigen::Matrix<double, kRows, 6> A = Eigen::MatrixXd::NullaryExpr(kRows, 6, uniform);
      const Eigen::Matrix<double, kRows, kDof> B =
          Eigen::MatrixXd::NullaryExpr(kRows, kDof, uniform);
      const Eigen::Matrix<double, kRows, 1> r = Eigen::VectorXd::NullaryExpr(kRows, uniform);
      s.poses[static_cast<std::size_t>(pose)].H += A.transpose() * A;
      s.poses[static_cast<std::size_t>(pose)].g += A.transpose() * r;
      s.landmarks[l].V += B.transpose() * B;
      s.landmarks[l].g += B.transpose() * r;
      s.couplings[l].push_back({pose, A.transpose() * B});
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kRows, kSize);
      J.middleCols<6>(6 * pose) = A;
      J.middleCols<kDof>(6 * kPoses + kDof * i) = B;
      s.H += J.transpose() * J;
      s.g += J.transpose() * r;
    }
  }
  return s;
}

TEST(SchurSolver, GivesTheStepOfTheWholeDampedSystem) {
  for (const double lambda : {1e-6, 0.1, 10.0}) {
    System s = RandomSystem(1);
    Eigen::MatrixXd damped = s.H;
    damped.diagonal() *= 1 + lambda;
    const Eigen::VectorXd expected = -damped.ldlt().solve(s.g);
    SchurSolver solver(kPoses);
    for (int i = 0; i < kPoses; ++i) solver.pose(i) = s.poses[static_cast<std::size_t>(i)];
    std::array<EliminatedLandmark<kDof>, kLandmarks> eliminated;
    for (std::size_t i = 0; i < kLandmarks; ++i) {
      eliminated[i] = solver.Eliminate<kDof>(s.landmarks[i], lambda, s.couplings[i]);
      EXPECT_TRUE(eliminated[i].regular);
    }
    ASSERT_TRUE(solver.Solve(lambda));
    for (int i = 0; i < kPoses; ++i) {
      EXPECT_LT((solver.step(i) - expected.segment<6>(6 * i)).norm(), 1e-9);
    }
    for (int i = 0; i < kLandmarks; ++i) {
      const auto l = static_cast<std::size_t>(i);
      const auto step = solver.LandmarkStep<kDof>(eliminated[l], s.couplings[l]);
      EXPECT_LT((step - expected.segment<kDof>(6 * kPoses + kDof * i)).norm(), 1e-9);
    }
  }
}

TEST(SchurSolver, ALandmarkWithoutInformationIsHeldStill) {
  SchurSolver solver(1);
  solver.pose(0).H.setIdentity();
  solver.pose(0).g.setOnes();
  std::vector<Coupling<3>> couplings{{0, Eigen::Matrix<double, 6, 3>::Zero()}};
  const auto eliminated = solver.Eliminate<3>({}, 1e-3, couplings);
  EXPECT_FALSE(eliminated.regular);
  ASSERT_TRUE(solver.Solve(0));
  EXPECT_EQ((solver.LandmarkStep<3>(eliminated, couplings)), Eigen::Vector3d::Zero());
  EXPECT_LT((solver.step(0) + Vector6d::Ones()).norm(), 1e-12);
}

TEST(SchurSolver, RefusesAnIndefiniteSystem) {
  SchurSolver solver(1);
  solver.pose(0).H = -Matrix6d::Identity();
  EXPECT_FALSE(solver.Solve(0));
}

TEST(SchurSolver, ResetEmptiesTheEquations) {
  SchurSolver solver(2);
  solver.pose(1).H.setIdentity();
  solver.pose(1).g.setOnes();
  solver.Reset();
  ASSERT_TRUE(solver.Solve(1));
  EXPECT_EQ(solver.step(1).norm(), 0);
}

}  // namespace
}  // namespace plumbline
