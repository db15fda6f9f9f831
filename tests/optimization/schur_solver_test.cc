// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include "tests/optimization/random_scene.h"
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {

namespace symmetric_blocks_test {

constexpr int kRows = 100;

TEST(SymmetricBlocks, KeepsWhatIsAddedInAnyOrder) {
  for (const bool whole : {false, true}) {
    SymmetricBlocks blocks(kRows, whole);
    testing::Random random(1);
    std::map<std::pair<int, int>, double> expected;
    for (int i = 0; i < 2000; ++i) {
      const int a = random.Index(kRows), b = random.Index(kRows);
      const double value = random.Uniform(-1, 1);
      blocks.At(std::max(a, b), std::min(a, b))(1, 2) += value;
      expected[{std::max(a, b), std::min(a, b)}] += value;
    }
    std::map<std::pair<int, int>, double> found;
    for (int row = 0; row < kRows; ++row) {
      int last = -1;
      blocks.ForEachLeft(row, [&](int column, const Matrix6d& block) {
        EXPECT_GT(column, last);
        last = column;
        EXPECT_EQ(block.cwiseAbs().sum(), std::abs(block(1, 2)));
        if (block(1, 2) != 0) found[{row, column}] = block(1, 2);
      });
      if (blocks.Diagonal(row)(1, 2) != 0) found[{row, row}] = blocks.Diagonal(row)(1, 2);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(SymmetricBlocks, KeepsOfALargeMatrixWhatWasAskedFor) {
  SymmetricBlocks blocks(kRows, false);
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows));
  blocks.At(99, 70).setOnes();
  blocks.At(99, 3).setOnes();
  blocks.At(99, 98).setOnes();
  blocks.At(99, 3).setOnes();
  blocks.At(50, 50).setOnes();
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows) + 3);
  blocks.SetZero();
  EXPECT_EQ(blocks.count(), static_cast<std::size_t>(kRows) + 3);
  EXPECT_EQ(blocks.At(99, 3), Matrix6d::Zero());
  const BlockPattern pattern = blocks.Pattern();
  EXPECT_EQ(pattern[99], (std::vector<int>{3, 70, 98}));
  EXPECT_TRUE(pattern[50].empty());
}

TEST(SymmetricBlocks, KeepsASmallMatrixWhole) {
  const SymmetricBlocks blocks(10, true);
  EXPECT_EQ(blocks.count(), 55U);
  EXPECT_EQ(blocks.Pattern()[9].size(), 9U);
  EXPECT_EQ(SymmetricBlocks(0, true).count(), 0U);
}

}  // namespace symmetric_blocks_test

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
      const auto step = solver.LandmarkStep<kDof, double>(eliminated[l], s.couplings[l]);
      EXPECT_LT((step - expected.segment<kDof>(6 * kPoses + kDof * i)).norm(), 1e-9);
    }
  }
}

// A landmark that poses see, with random equations of full rank.
struct SeenLandmark {
  LandmarkEquations<3> equations;
  std::vector<Coupling<3>> couplings;
};

// Poses with their equations, and landmarks with random observations from some of them.
class SeenLandmarks {
 public:
  SeenLandmarks(std::size_t poses, unsigned seed) : poses_(poses), random_(seed) {}

  // Adds a landmark that these poses see, ascending.
  void Add(const std::vector<int>& seen_by, double weight = 1) {
    const auto uniform = [&] { return weight * random_.Uniform(-1, 1); };
    SeenLandmark landmark;
    for (const int pose : seen_by) {
      const Eigen::Matrix<double, kRows, 6> A = Eigen::MatrixXd::NullaryExpr(kRows, 6, uniform);
      const Eigen::Matrix<double, kRows, 3> B = Eigen::MatrixXd::NullaryExpr(kRows, 3, uniform);
      const Eigen::Matrix<double, kRows, 1> r = Eigen::VectorXd::NullaryExpr(kRows, uniform);
      poses_[static_cast<std::size_t>(pose)].H += A.transpose() * A;
      poses_[static_cast<std::size_t>(pose)].g += A.transpose() * r;
      landmark.equations.V += B.transpose() * B;
      landmark.equations.g += B.transpose() * r;
      landmark.couplings.push_back({pose, A.transpose() * B});
    }
    landmarks_.push_back(std::move(landmark));
  }
  // Adds landmarks along a path, which poses share with their neighbours, and its ends with one
  // another.
  void AddPath() {
    const int count = static_cast<int>(poses_.size());
    for (int i = 0; i < count; ++i) {
      std::vector<int> seen_by{i, (i + 1) % count, (i + 3) % count};
      std::sort(seen_by.begin(), seen_by.end());
      Add(seen_by);
    }
  }
  // Adds landmarks that poses anywhere share.
  void AddTies(int ties, double weight = 1) {
    for (int i = 0; i < ties; ++i) {
      std::set<int> seen_by;
      while (seen_by.size() < 3) seen_by.insert(random_.Index(static_cast<int>(poses_.size())));
      Add({seen_by.begin(), seen_by.end()}, weight);
    }
  }

  const std::vector<PoseEquations>& poses() const { return poses_; }
  const std::vector<SeenLandmark>& landmarks() const { return landmarks_; }

 private:
  std::vector<PoseEquations> poses_;
  std::vector<SeenLandmark> landmarks_;
  testing::Random random_;
};

// Gives a solver the equations. Landmarks from number `ties` on may tie.
void Enter(const SeenLandmarks& seen, std::size_t ties, double lambda, SchurSolver& solver) {
  solver.Reset();
  for (std::size_t i = 0; i < seen.poses().size(); ++i) {
    solver.pose(static_cast<int>(i)) = seen.poses()[i];
  }
  for (std::size_t i = 0; i < seen.landmarks().size(); ++i) {
    if (i == ties) solver.LaterLandmarksMayTie();
    SeenLandmark landmark = seen.landmarks()[i];
    solver.Eliminate<3>(landmark.equations, lambda, landmark.couplings);
  }
}

Eigen::VectorXd Steps(const SchurSolver& solver, std::size_t poses) {
  Eigen::VectorXd steps(6 * static_cast<Eigen::Index>(poses));
  for (int i = 0; i < static_cast<int>(poses); ++i) steps.segment<6>(6 * i) = solver.step(i);
  return steps;
}

// The system of the poses with the landmarks eliminated, by dense matrices.
Eigen::VectorXd DenseSteps(const std::vector<PoseEquations>& poses,
                           const std::vector<SeenLandmark>& landmarks,
                           double lambda) {
  const auto size = 6 * static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd g(size);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    H.block<6, 6>(row, row) = poses[i].H;
    H.diagonal().segment<6>(row) *= 1 + lambda;
    g.segment<6>(row) = poses[i].g;
  }
  for (const SeenLandmark& landmark : landmarks) {
    Eigen::Matrix3d V = landmark.equations.V;
    V.diagonal() *= 1 + lambda;
    const Eigen::Matrix3d inverse = V.inverse();
    for (const auto& a : landmark.couplings) {
      g.segment<6>(6 * a.pose) -= a.W * inverse * landmark.equations.g;
      for (const auto& b : landmark.couplings) {
        H.block<6, 6>(6 * a.pose, 6 * b.pose) -= a.W * inverse * b.W.transpose();
      }
    }
  }
  return -H.llt().solve(g);
}

TEST(SchurSolver, SolvesAsWellWhereThePosesAreMany) {
  for (const std::size_t count : {200U, 201U, 260U}) {  // dense, and sparse
    SeenLandmarks seen(count, 5);
    seen.AddPath();
    SchurSolver solver(static_cast<int>(count));
    for (const double lambda : {0.1, 1e-6}) {  // the blocks stay from one to the next
      const Eigen::VectorXd expected = DenseSteps(seen.poses(), seen.landmarks(), lambda);
      Enter(seen, seen.landmarks().size(), lambda, solver);
      ASSERT_TRUE(solver.Solve(lambda));
      ASSERT_LT((Steps(solver, count) - expected).lpNorm<Eigen::Infinity>(), 1e-8) << count;
    }
  }
}

// Landmarks that poses far apart share fill the factor of the whole system.
TEST(SchurSolver, IteratesWhereLaterLandmarksTieManyPoses) {
  constexpr std::size_t kMany = 600;
  for (const double weight : {1.0, 100.0}) {
    SeenLandmarks seen(kMany, 6);
    seen.AddPath();
    seen.AddTies(400, weight);
    SchurSolver solver(kMany), direct(kMany);
    for (const double lambda : {0.1, 1e-6}) {
      Enter(seen, kMany, lambda, solver);
      ASSERT_TRUE(solver.Solve(lambda));
      EXPECT_TRUE(solver.iterative());
      Enter(seen, seen.landmarks().size(), lambda, direct);
      ASSERT_TRUE(direct.Solve(lambda));
      EXPECT_FALSE(direct.iterative());
      const Eigen::VectorXd expected = Steps(direct, kMany);
      EXPECT_LT((Steps(solver, kMany) - expected).norm(), 0.02 * expected.norm()) << weight;
    }
  }
}

TEST(SchurSolver, FactorizesWhatFewLandmarksTie) {
  constexpr std::size_t kMany = 260;
  SeenLandmarks seen(kMany, 7);
  seen.AddPath();
  seen.AddTies(5);
  SchurSolver solver(kMany);
  Enter(seen, kMany, 1e-6, solver);
  ASSERT_TRUE(solver.Solve(1e-6));
  EXPECT_FALSE(solver.iterative());
  const Eigen::VectorXd expected = DenseSteps(seen.poses(), seen.landmarks(), 1e-6);
  EXPECT_LT((Steps(solver, kMany) - expected).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(SchurSolver, AddsWhatCouplesTwoPoses) {
  testing::Random random(9);
  const Eigen::Matrix<double, 20, 12> J =
      Eigen::MatrixXd::NullaryExpr(20, 12, [&] { return random.Uniform(-1, 1); });
  const Eigen::Matrix<double, 20, 1> r =
      Eigen::VectorXd::NullaryExpr(20, [&] { return random.Uniform(-1, 1); });
  SchurSolver solver(2);
  for (int i = 0; i < 2; ++i) {
    solver.pose(i).H = J.middleCols<6>(6 * i).transpose() * J.middleCols<6>(6 * i);
    solver.pose(i).g = J.middleCols<6>(6 * i).transpose() * r;
  }
  solver.AddCoupling(1, 0, J.rightCols<6>().transpose() * J.leftCols<6>());
  ASSERT_TRUE(solver.Solve(0));
  const Eigen::VectorXd expected = -(J.transpose() * J).ldlt().solve(J.transpose() * r);
  EXPECT_LT((Steps(solver, 2) - expected).norm(), 1e-9);
}

TEST(SchurSolver, ManyPosesWithoutObservationsStayOrAreRefused) {
  constexpr int kMany = 300;
  SchurSolver solver(kMany);
  solver.pose(7).H.setIdentity();
  solver.pose(7).g.setOnes();
  ASSERT_TRUE(solver.Solve(1));
  EXPECT_EQ(solver.step(8).norm(), 0);
  EXPECT_LT((solver.step(7) + 0.5 * Vector6d::Ones()).norm(), 1e-12);
  solver.pose(9).H = -Matrix6d::Identity();
  EXPECT_FALSE(solver.Solve(0));
}

TEST(SchurSolver, ALandmarkWithoutInformationIsHeldStill) {
  SchurSolver solver(1);
  solver.pose(0).H.setIdentity();
  solver.pose(0).g.setOnes();
  std::vector<Coupling<3>> couplings{{0, Eigen::Matrix<double, 6, 3>::Zero()}};
  const auto eliminated = solver.Eliminate<3>({}, 1e-3, couplings);
  EXPECT_FALSE(eliminated.regular);
  ASSERT_TRUE(solver.Solve(0));
  EXPECT_EQ((solver.LandmarkStep<3, double>(eliminated, couplings)), Eigen::Vector3d::Zero());
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

// With 250 poses the solver plans the order of elimination before it factors, and both steps ask
// whether they are to stop.
TEST(SchurSolver, SolvesAfterItWasStopped) {
  constexpr int kMany = 250;
  SchurSolver solver(kMany);
  for (int i = 0; i < kMany; ++i) {
    solver.pose(i).H.setIdentity();
    solver.pose(i).g.setConstant(i);
  }
  EXPECT_FALSE(solver.Solve(0, [] { return true; }));
  ASSERT_TRUE(solver.Solve(0));
  for (int i = 0; i < kMany; ++i) {
    EXPECT_LT((solver.step(i) + Vector6d::Constant(i)).norm(), 1e-9) << i;
  }
}

}  // namespace

}  // namespace plumbline
