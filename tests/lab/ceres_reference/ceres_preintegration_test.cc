// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_preintegration.h"

#include "plumbline/geometry/se3.h"

#include "tests/inertial/invented_motion.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(PreintegrateByJets, GivesTheMotionAndTheDerivativesOfPreintegrate) {
  const InertialBias bias{{0.02, -0.01, 0.03}, {0.1, 0.2, -0.15}};
  const std::int64_t from = kMotionStart + 1'234'567, to = from + 743'210'987;
  for (const double rate : {50.0, 200.0, 1000.0}) {
    const std::vector<InertialSample> samples = IdealSamples(rate);
    const Preintegral ours = Preintegrate(samples, from, to, bias, {}).value();
    const Preintegral twin = PreintegrateByJets(samples, from, to, bias);
    EXPECT_LT(AngularDistance(ours.rotation, twin.rotation), 1e-12);
    EXPECT_LT((ours.velocity - twin.velocity).norm(), 1e-12);
    EXPECT_LT((ours.position - twin.position).norm(), 1e-12);
    EXPECT_LT((ours.by_bias - twin.by_bias).cwiseAbs().maxCoeff(), 1e-10);
    // Ours is that of the motion, the twin's that of the steps: equal as far as these are fine.
    EXPECT_LT((ours.by_time_offset - twin.by_time_offset).norm(),
              400 / (rate * rate) * twin.by_time_offset.norm());
  }
}

}  // namespace
}  // namespace plumbline
