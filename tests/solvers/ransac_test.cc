// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/ransac.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The value near most of some numbers, each number a sample.
class NearMost {
 public:
  using Model = double;
  static constexpr std::size_t kSampleSize = 1;

  explicit NearMost(std::vector<double> values) : values_(std::move(values)) {}
  std::size_t size() const { return values_.size(); }
  std::vector<double> Solve(const std::array<std::size_t, 1>& sample) const {
    ++solved;
    return {values_[sample[0]]};
  }
  double Cost(double model, double limit) const {
    double sum = 0;
    for (const double value : values_) {
      sum += std::min(1.0, std::abs(value - model));
      if (sum > limit) break;
    }
    return sum;
  }
  double InlierRatio(double model) const {
    const auto near = std::count_if(values_.begin(), values_.end(), [model](double value) {
      return std::abs(value - model) < 1;
    });
    return static_cast<double>(near) / static_cast<double>(size());
  }
  double Improve(double model) const {
    double sum = 0;
    int count = 0;
    for (const double value : values_) {
      if (std::abs(value - model) > 1) continue;
      sum += value;
      ++count;
    }
    return sum / count;
  }
  bool Same(double a, double b) const { return std::abs(a - b) < 2; }

  mutable int solved = 0;

 private:
  std::vector<double> values_;
};

// 60 about 10, 40 about 20, 20 far from everything.
std::vector<double> TwoGroups() {
  Rng rng(1);
  std::vector<double> values;
  for (int i = 0; i < 60; ++i) values.push_back(10 + rng.Uniform(-0.5, 0.5));
  for (int i = 0; i < 40; ++i) values.push_back(20 + rng.Uniform(-0.5, 0.5));
  for (int i = 0; i < 20; ++i) values.push_back(100 + 10 * i);
  return values;
}

TEST(SamplesNeeded, LeaveOneInAThousandUndrawn) {
  EXPECT_EQ(SamplesNeeded(1, 5, 500), 1);
  EXPECT_EQ(SamplesNeeded(0, 5, 500), 500);
  const int needed = SamplesNeeded(0.8, 5, 500);
  EXPECT_LE(std::pow(1 - std::pow(0.8, 5), needed), 0.001);
  EXPECT_GT(std::pow(1 - std::pow(0.8, 5), needed - 1), 0.001);
}

TEST(DrawSample, HasDifferentIndices) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    auto sample = DrawSample<4>(5, rng);
    std::sort(sample.begin(), sample.end());
    EXPECT_EQ(std::adjacent_find(sample.begin(), sample.end()), sample.end());
    EXPECT_LT(sample.back(), 5U);
  }
}

TEST(Ransac, FindsTheBestImprovedAndKeepsRivals) {
  const NearMost problem(TwoGroups());
  Rng rng(1);
  const auto one = Ransac<NearMost>(problem, 500, 1).Run({}, rng);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(one.front().model, problem.Improve(10), 1e-12);
  const auto both = Ransac<NearMost>(problem, 500, 1.6).Run({}, rng);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NEAR(both[0].model, 10, 0.1);
  EXPECT_NEAR(both[1].model, 20, 0.5);
  EXPECT_LT(both[0].cost, both[1].cost);
}

TEST(Ransac, AGoodGuessSavesSamples) {
  const NearMost without(TwoGroups());
  const NearMost with(TwoGroups());
  Rng rng(1);
  Ransac<NearMost>(without, 3, 1).Run({}, rng);
  EXPECT_EQ(without.solved, 3);
  const auto best = Ransac<NearMost>(with, 0, 1).Run(std::array{10.2}, rng);
  EXPECT_NEAR(best.front().model, 10, 0.1);
}

TEST(Ransac, TooFewForASampleGivesNothing) {
  const NearMost problem({});
  Rng rng(1);
  EXPECT_TRUE(Ransac<NearMost>(problem, 500, 1).Run({}, rng).empty());
}

}  // namespace
}  // namespace plumbline
