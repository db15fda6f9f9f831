// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/parallel_lines.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

Eigen::Vector3d RandomDirection(Rng& rng) {
  return Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()).normalized();
}

// A direction measured with the same error in all directions, in either sense.
LineDirection Measured(Rng& rng, const Eigen::Vector3d& truth, double sigma) {
  const Eigen::Vector3d error(rng.Normal(sigma), rng.Normal(sigma), rng.Normal(sigma));
  const double sense = rng.Uniform() < 0.5 ? -1 : 1;
  const Eigen::Vector3d d = sense * (truth + error).normalized();
  return {d, sigma * sigma * (Eigen::Matrix3d::Identity() - d * d.transpose())};
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.cross(b).norm(); }

// Against the directions of lines moved by random tangents.
TEST(DirectionOf, HasTheCovarianceOfMovedLines) {
  Rng rng(1, "direction");
  const PluckerLine line = LineThroughPoints({1, -2, 4}, {2, 1, 5});
  Eigen::Matrix4d A;
  for (int i = 0; i < 16; ++i) A(i) = rng.Normal();
  const Eigen::Matrix4d covariance =
      1e-6 * (A * A.transpose() + Eigen::Matrix4d(Eigen::Vector4d(1, 2, 3, 4).asDiagonal()));
  const auto direction = DirectionOf(line, covariance.inverse());
  ASSERT_TRUE(direction);
  const Eigen::Matrix4d L = covariance.llt().matrixL();
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector4d x(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
    const Eigen::Vector3d moved = ToPlucker(Retract(ToOrthonormal(line), L * x)).direction;
    const Eigen::Vector3d error = moved - line.direction;
    sampled += error * error.transpose() / kSamples;
  }
  EXPECT_LT((sampled - direction->covariance).norm(), 0.05 * direction->covariance.norm());
  EXPECT_FALSE(DirectionOf(line, Eigen::Matrix4d::Zero()));
}

TEST(CommonDirections, FindsThreeAmongRandomLines) {
  Rng rng(2, "directions");
  const double sigma = 0.3 * kRadians;
  std::vector<Eigen::Vector3d> truths;
  for (int i = 0; i < 3; ++i) truths.push_back(RandomDirection(rng));
  std::vector<LineDirection> lines;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 40 - 10 * i; ++k) {
      lines.push_back(Measured(rng, truths[static_cast<std::size_t>(i)], sigma));
    }
  }
  for (int k = 0; k < 60; ++k) lines.push_back(Measured(rng, RandomDirection(rng), sigma));
  const auto found = CommonDirections(lines);
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    // sigma covers both components of the error.
    EXPECT_LT(Angle(found[i].direction, truths[i]), 3 * found[i].sigma) << i;
    EXPECT_GT(found[i].sigma, sigma / std::sqrt(40.0)) << i;
    EXPECT_LT(found[i].sigma, 2 * sigma / std::sqrt(20.0)) << i;
  }
}

TEST(CommonDirections, NeedsFiveWellKnownLines) {
  Rng rng(3, "few");
  const Eigen::Vector3d truth = RandomDirection(rng);
  std::vector<LineDirection> lines;
  for (int i = 0; i < 4; ++i) lines.push_back(Measured(rng, truth, 0.1 * kRadians));
  for (int i = 0; i < 50; ++i) lines.push_back(Measured(rng, truth, 2 * kRadians));
  EXPECT_TRUE(CommonDirections(lines).empty());
  lines.push_back(Measured(rng, truth, 0.1 * kRadians));
  EXPECT_EQ(CommonDirections(lines).size(), 1U);
  EXPECT_TRUE(CommonDirections(std::vector<LineDirection>{}).empty());
}

TEST(ParallelTo, KeepsToTheLimitOfChi2) {
  Rng rng(4, "limit");
  const CommonDirection axis{RandomDirection(rng), 0};
  const double sigma = 0.3 * kRadians;
  const double actual = std::hypot(sigma, ParallelSigma());
  int parallel = 0;
  constexpr int kLines = 4000;
  for (int i = 0; i < kLines; ++i) {
    LineDirection line = Measured(rng, axis.direction, actual);
    line.covariance *= sigma * sigma / (actual * actual);
    parallel += ParallelTo(line, {axis}).has_value() ? 1 : 0;
  }
  EXPECT_NEAR(parallel, 0.95 * kLines, 0.015 * kLines);
}

TEST(ParallelTo, RefusesWhatMeansLittle) {
  Rng rng(5, "vague");
  const CommonDirection axis{Eigen::Vector3d::UnitZ(), 0};
  const CommonDirection beside{Eigen::Vector3d(std::sin(kRadians), 0, std::cos(kRadians)), 0};
  const auto line = [](double x_deg, double y_deg) {
    const Eigen::Vector3d variances(
        std::pow(x_deg * kRadians, 2), std::pow(y_deg * kRadians, 2), 0);
    return LineDirection{-Eigen::Vector3d::UnitZ(), variances.asDiagonal()};
  };
  EXPECT_EQ(ParallelTo(line(0.1, 0.1), {beside, axis}), 1U);
  EXPECT_FALSE(ParallelTo(line(0.5, 0.5), {beside, axis})) << "both would pass";
  EXPECT_TRUE(ParallelTo(line(5, 0.1), {axis})) << "well known in one of the two directions";
  EXPECT_FALSE(ParallelTo(line(5, 5), {axis})) << "too vague";
  EXPECT_FALSE(ParallelTo(line(0.1, 0.1), {}));
  EXPECT_FALSE(ParallelTo({Eigen::Vector3d::UnitX(), Eigen::Matrix3d::Zero()}, {axis}));
}

}  // namespace
}  // namespace plumbline
