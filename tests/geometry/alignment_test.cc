// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/alignment.h"

#include "plumbline/geometry/se3.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {

namespace {

const Eigen::Matrix3d kTurn = ExpSo3(Eigen::Vector3d(0.4, -1.1, 2.0)).toRotationMatrix();

Eigen::Matrix3d CorrelationOf(const Eigen::Matrix3d& sources, const Eigen::Matrix3d& turn) {
  return turn * sources * sources.transpose();
}

TEST(FitRotation, FindsTheRotationOfVectors) {
  const Eigen::Matrix3d sources{{1, 0.2, 0}, {0, 2, 0.1}, {0.3, 0, 0.5}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, kTurn));
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
  EXPECT_GT(fit.singular_values(2), 0);
}

TEST(FitRotation, FindsItFromVectorsInAPlane) {
  const Eigen::Matrix3d sources{{1, 0.2, 0}, {0, 2, 0}, {0, 0, 0}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, kTurn));
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
  EXPECT_NEAR(fit.singular_values(2), 0, 1e-12);
  EXPECT_GT(fit.singular_values(1), 0.1);
}

TEST(FitRotation, GivesNoReflectionForMirroredVectors) {
  const Eigen::Vector3d kMirror(1, 1, -1);
  const Eigen::Matrix3d mirrored = kTurn * kMirror.asDiagonal();
  const Eigen::Matrix3d sources{{3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  const RotationFit fit = FitRotation(CorrelationOf(sources, mirrored));
  EXPECT_NEAR(fit.rotation.determinant(), 1, 1e-12);
  EXPECT_NEAR(fit.singular_values(2), -1, 1e-12);
  // No rotation fits all three mirrored vectors. The best one fits the two longest of them.
  EXPECT_LT((fit.rotation - kTurn).norm(), 1e-12);
}

using Points = std::vector<Eigen::Vector3d>;

Points RandomPoints(Rng& rng, int count, const Eigen::Vector3d& spread = {2, 1, 0.5}) {
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(spread.cwiseProduct(RandomVector<3>(rng)) + Eigen::Vector3d(5, -3, 8));
  }
  return points;
}

Points Moved(const Similarity3& S, const Points& points) {
  Points moved;
  for (const Eigen::Vector3d& p : points) moved.push_back(S * p);
  return moved;
}

double Difference(const Similarity3& a, const Similarity3& b) {
  return (a.Matrix() - b.Matrix()).norm();
}

TEST(AlignPoints, RecoversAnExactMotion) {
  Rng rng(1);
  for (int i = 0; i < 30; ++i) {
    const Points source = RandomPoints(rng, 3 + i);
    Similarity3 truth = ToSimilarity(RandomRigid(rng, 3.14, 5));
    const auto rigid = AlignPoints(source, Moved(truth, source), AlignmentScale::kFixed);
    ASSERT_TRUE(rigid);
    EXPECT_LT(Difference(rigid->target_from_source, truth), 1e-11);
    EXPECT_LT(rigid->rmse, 1e-12);
    truth.scale = rng.Uniform(0.01, 20);
    const auto similar = AlignPoints(source, Moved(truth, source), AlignmentScale::kFree);
    ASSERT_TRUE(similar);
    EXPECT_LT(Difference(similar->target_from_source, truth), 1e-10);
  }
}

TEST(AlignPoints, PlanarPointsGetARotationNotAMirror) {
  Rng rng(2);
  for (int i = 0; i < 20; ++i) {
    const Points source = RandomPoints(rng, 20, {2, 1, 0});
    const Similarity3 truth = ToSimilarity(RandomRigid(rng));
    const auto result = AlignPoints(source, Moved(truth, source), AlignmentScale::kFree);
    ASSERT_TRUE(result);
    EXPECT_LT(Difference(result->target_from_source, truth), 1e-11);
  }
}

// No rotation makes a mirror image fit; the best one turns the flattest direction over.
TEST(AlignPoints, MirroredPointsGetTheBestRotation) {
  Rng rng(3);
  const Points source = RandomPoints(rng, 200, {2, 1, 0.1});
  Points mirrored = source;
  for (Eigen::Vector3d& p : mirrored) p.z() = -p.z();
  const auto result = AlignPoints(source, mirrored, AlignmentScale::kFixed);
  ASSERT_TRUE(result);
  EXPECT_LT(LogSo3(result->target_from_source.rotation).norm(), 0.1);
  EXPECT_NEAR(result->rmse, 0.2, 0.04);
}

TEST(AlignPoints, MinimisesTheSumOfSquares) {
  Rng rng(4);
  const Points source = RandomPoints(rng, 15);
  Points target = Moved(ToSimilarity(RandomRigid(rng)), source);
  for (Eigen::Vector3d& p : target) p += RandomVector<3>(rng, 0.2);
  using Cost = Eigen::Matrix<double, 1, 1>;
  for (const AlignmentScale scale : {AlignmentScale::kFixed, AlignmentScale::kFree}) {
    const auto result = AlignPoints(source, target, scale);
    ASSERT_TRUE(result);
    const auto cost = [&](const Vector7d& x) -> Cost {
      double sum = 0;
      const Similarity3 S = RetractLeft(result->target_from_source, x);
      for (std::size_t i = 0; i < source.size(); ++i) {
        sum += (target[i] - S * source[i]).squaredNorm();
      }
      return Cost(sum);
    };
    const Eigen::Matrix<double, 1, 7> gradient =
        NumericJacobian(cost, Vector7d(Vector7d::Zero()), 1e-4);
    const int free = scale == AlignmentScale::kFree ? 7 : 6;
    EXPECT_LT(gradient.head(free).norm(), 1e-6);
    EXPECT_NEAR(result->rmse, std::sqrt(cost(Vector7d::Zero())(0) / 15), 1e-12);
  }
}

TEST(AlignPoints, NamesDegenerateSets) {
  Rng rng(6);
  const Points two = RandomPoints(rng, 2);
  EXPECT_EQ(AlignPoints(two, two, AlignmentScale::kFixed).error(), AlignmentFailure::kTooFewPoints);
  const Points one_place(5, Eigen::Vector3d(1e3, 2, 3));
  const Points spread = RandomPoints(rng, 5);
  EXPECT_EQ(AlignPoints(one_place, spread, AlignmentScale::kFixed).error(),
            AlignmentFailure::kCoincident);
  EXPECT_EQ(AlignPoints(spread, one_place, AlignmentScale::kFree).error(),
            AlignmentFailure::kCoincident);
  Points line;
  for (int i = 0; i < 5; ++i)
    line.emplace_back(Eigen::Vector3d(1, 2, 3) + i * Eigen::Vector3d(3, 1, 2));
  EXPECT_EQ(AlignPoints(line, line, AlignmentScale::kFixed).error(), AlignmentFailure::kCollinear);
  line[3].x() += 0.01;
  EXPECT_TRUE(AlignPoints(line, line, AlignmentScale::kFixed));
}

}  // namespace

}  // namespace plumbline
