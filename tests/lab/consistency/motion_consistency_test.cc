// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/motion_consistency.h"

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"

#include "tests/lab/consistency/shares.h"
#include "tests/support/random_geometry.h"
#include "tests/support/synthetic_world.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::int64_t kFrameNs = 50'000'000;

struct Flight {
  Trajectory truth, estimate;
  PoseCovariances covariances;
};

// 600 poses with independent errors, `noise` times as large as their covariance says, in another
// world and unit (metres_per_unit) than the truth.
Flight Fly(double noise, double metres_per_unit) {
  Rng rng(3, "motion_consistency");
  const Rigid3 other_from_true{ExpSo3({0.3, -0.8, 0.5}), {3, -2, 7}};
  Matrix6d covariance = Matrix6d::Identity() * 1e-4;
  covariance.bottomRightCorner<3, 3>() *= 0.01;
  Matrix6d to_unit = Matrix6d::Identity();
  to_unit.topLeftCorner<3, 3>() /= metres_per_unit;
  Flight flight;
  for (int k = 0; k < 600; ++k) {
    const std::int64_t stamp = k * kFrameNs;
    const Rigid3 truth = Inverse(PoseOnPath(k));
    const Rigid3 exact = other_from_true * truth;
    // The covariance is along the axes of the estimate's world.
    Rigid3 estimate;
    estimate.translation =
        (exact.translation - RandomVector<3>(rng, noise * 1e-2)) / metres_per_unit;
    estimate.rotation = ExpSo3(RandomVector<3>(rng, noise * 1e-3)) * exact.rotation;
    flight.truth.push_back({stamp, truth});
    flight.estimate.push_back({stamp, estimate});
    flight.covariances[stamp] = to_unit * covariance * to_unit;
  }
  return flight;
}

std::vector<ConsistencySample> SamplesOf(const Flight& flight, double metres_per_unit) {
  return MotionSamples(ConsistencyKind::kCausal1s,
                       {flight.estimate, flight.covariances, metres_per_unit},
                       flight.truth,
                       4 * kFrameNs,
                       kNsPerSecond);
}

TEST(MotionSamples, AreInsideAsOftenAsPromisedInAnyWorldAndUnit) {
  for (const double unit : {1.0, 0.4}) {
    const auto samples = SamplesOf(Fly(1, unit), unit);
    EXPECT_EQ(samples.size(), 581U);
    EXPECT_NEAR(ShareInside(samples, ConsistencyKind::kCausal1s), 0.9, 0.04) << unit;
  }
}

TEST(MotionSamples, AreOutsideWhereTheErrorsAreLarger) {
  EXPECT_LT(ShareInside(SamplesOf(Fly(3, 1), 1), ConsistencyKind::kCausal1s), 0.05);
}

TEST(MotionSamples, NeedACovarianceAndATrueMotionOfThatLength) {
  Flight flight = Fly(1, 1);
  flight.covariances.erase(0);
  EXPECT_EQ(SamplesOf(flight, 1).size(), 580U);
  flight.truth.resize(10);
  EXPECT_TRUE(SamplesOf(flight, 1).empty());
}

}  // namespace
}  // namespace plumbline
