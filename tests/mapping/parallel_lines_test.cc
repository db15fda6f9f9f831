// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/parallel_lines.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/random.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/se3.h"

#include "tests/mapping/vertical_lines.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

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

// Returns the index of the first of the lines with most others within 2 deg; no value where all
// have fewer than four others.
std::optional<std::size_t> MostAmong(const std::vector<LineDirection>& lines) {
  std::optional<std::size_t> most;
  std::ptrdiff_t votes = 4;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto near = std::count_if(lines.begin(), lines.end(), [&](const LineDirection& line) {
      return std::abs(lines[i].direction.dot(line.direction)) >= math::Cos(2 * kRadians);
    });
    if (near <= votes) continue;
    votes = near;
    most = i;
  }
  return most;
}

// Looks at all lines in every step.
CommonDirection MeanOfAgreeing(const Eigen::Vector3d& start,
                               const std::vector<LineDirection>& lines,
                               std::vector<LineDirection>& others) {
  CommonDirection mean{start, 0};
  for (int step = 0; step < 4; ++step) {
    const Eigen::Matrix<double, 3, 2> across = BasisAcross(mean.direction);
    others.clear();
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (const LineDirection& line : lines) {
      const double cosine = mean.direction.dot(line.direction);
      const Eigen::Vector2d angle = (cosine < 0 ? -1 : 1) * (across.transpose() * line.direction);
      Eigen::Matrix2d covariance = across.transpose() * line.covariance * across;
      covariance.diagonal().array() += ParallelSigma() * ParallelSigma();
      const double chi2 = angle.dot(covariance.inverse() * angle);
      if (!(std::abs(cosine) >= 0.9 && chi2 <= Chi2Limit95(2))) {
        others.push_back(line);
        continue;
      }
      const Eigen::Matrix2d weight = covariance.inverse();
      H += weight;
      g += weight * angle;
    }
    if (others.size() == lines.size()) break;
    const Eigen::Matrix2d covariance = H.inverse();
    mean.direction = (mean.direction + across * covariance * g).normalized();
    mean.sigma = std::sqrt(covariance.trace());
  }
  return mean;
}

TEST(CommonDirections, AreThoseOfComparingAllLines) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed, "all_pairs");
    // The component by which lines are sorted is 0 around the third direction and 1 around the
    // fourth.
    std::vector<Eigen::Vector3d> truths{Eigen::Vector3d::UnitX(),
                                        Eigen::Vector3d(0.02, 0.999, 0).normalized(),
                                        Eigen::Vector3d(0.8, 0, -0.36).normalized(),
                                        {0.36, 0.48, 0.8}};
    for (int i = 0; i < 3; ++i) truths.push_back(RandomDirection(rng));
    std::vector<LineDirection> lines;
    for (int k = 0; k < 280; ++k) {
      // Many pairs differ by about 2 deg, which decides whether they are near each other.
      const double sigma = rng.Uniform(0.2, 0.7) * kRadians;
      lines.push_back(Measured(rng, truths[rng.Index(truths.size())], sigma));
    }
    for (int k = 0; k < 120; ++k) {
      lines.push_back(Measured(rng, RandomDirection(rng), 0.5 * kRadians));
    }
    const std::vector<CommonDirection> found = CommonDirections(lines);
    EXPECT_GE(found.size(), 4U);
    std::vector<LineDirection> left = lines;
    std::size_t group = 0;
    while (const auto seed_line = MostAmong(left)) {
      std::vector<LineDirection> others;
      const CommonDirection mean = MeanOfAgreeing(left[*seed_line].direction, left, others);
      if (left.size() - others.size() < 5) {
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(*seed_line));
        continue;
      }
      ASSERT_LT(group, found.size());
      EXPECT_EQ(found[group].direction, mean.direction);
      EXPECT_EQ(found[group].sigma, mean.sigma);
      ++group;
      left = std::move(others);
    }
    EXPECT_EQ(group, found.size());
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

std::vector<LineDirection> DirectionsOfAll(const Map& map) {
  std::vector<LineDirection> lines;
  for (const auto& [id, line] : map.lines()) {
    if (line.observations.size() < 3) continue;
    if (const auto direction = DirectionOf(line.line, line.information)) {
      lines.push_back(*direction);
    }
  }
  return lines;
}

TEST(CommonDirections, TakesAllLinesOfASmallMapAndSpreadOnesOfALargeOne) {
  const SyntheticWorld world = WorldOfVerticalLines(0, 60);
  for (const int keyframes : {50, 250}) {
    std::vector<Rigid3> poses;
    for (int k = 0; k < keyframes; ++k) poses.push_back(PoseOnPath(k));
    const Map map = MakeTrueMap(world, poses, {.points = false}).map;
    const auto of_all = CommonDirections(DirectionsOfAll(map));
    const auto found = CommonDirections(map);
    ASSERT_EQ(of_all.size(), 1U);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LT(Angle(found[0].direction, of_all[0].direction), 1e-3 * kRadians);
    if (keyframes > 200) continue;
    EXPECT_EQ(found[0].direction, of_all[0].direction);
    EXPECT_EQ(found[0].sigma, of_all[0].sigma);
  }
}

// The 4000 lines of keyframes that have none in common.
TEST(CommonDirections, OfAMapWithMoreLinesAreAsGood) {
  Rng rng(6, "many_lines");
  const Eigen::Vector3d truths[] = {RandomDirection(rng), RandomDirection(rng)};
  Map map;
  const SyntheticWorld world = MakeSyntheticWorld(0, 0);
  MapEdit edit;
  for (int k = 0; k < 300; ++k) {
    SyntheticFrame sensed;
    Features features;
    features.lines.resize(40);
    features.line_right.resize(40);
    sensed.line_truth.resize(40);
    sensed.indexed = IndexFeatures(world.camera, std::move(features));
    AddKeyFrameTo(map, Rigid3{}, sensed);
  }
  for (int i = 0; i < 4000; ++i) {
    MapLine line;
    line.id = LineId{i};
    const Eigen::Vector3d error = RandomVector<3>(rng, 0.1 * kRadians);
    const Eigen::Vector3d start = RandomVector<3>(rng, 10);
    line.line = LineThroughPoints(start, start + truths[i % 2] + error);
    line.end = 1;
    line.information = 1e6 * Eigen::Matrix4d::Identity();
    for (int k = 0; k < 3; ++k) line.observations.emplace(KeyFrameId{3 * (i / 40) + k}, i % 40);
    edit.push_back(edit::AddLine{line});
  }
  map.Apply(edit);
  ASSERT_EQ(map.lines().size(), 4000U);
  const auto found = CommonDirections(map);
  ASSERT_EQ(found.size(), 2U);
  for (const Eigen::Vector3d& truth : truths) {
    const double best =
        std::min(Angle(found[0].direction, truth), Angle(found[1].direction, truth));
    EXPECT_LT(best, 0.03 * kRadians);
  }
  EXPECT_GT(found[0].sigma, CommonDirections(DirectionsOfAll(map))[0].sigma);
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
