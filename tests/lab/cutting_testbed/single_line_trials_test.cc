// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/single_line_trials.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

int Agreeing(AscentStarts starts) {
  int agreeing = 0;
  for (std::uint64_t index = 0; index < 20; ++index) {
    const CuttingScene scene = MakeCuttingScene({SceneKind::kHomogeneousPoints, 0.005, 6}, index);
    const auto trials = TrySingleLines(scene, CuttingInformation::kIndependent, starts, 6);
    EXPECT_EQ(trials.size(), 6U);
    agreeing += static_cast<int>(
        std::count_if(trials.begin(), trials.end(), [](auto& t) { return t.Agrees(); }));
  }
  return agreeing;
}

TEST(SingleLineTrials, ThreeStartsAgreeWithBruteForceWhereOthersDoNot) {
  const int three = Agreeing(AscentStarts::kThree);
  EXPECT_GE(three, 119);  // of 120
  EXPECT_LT(Agreeing(AscentStarts::kFull), three);
  EXPECT_LT(Agreeing(AscentStarts::kPaper), three);
}

TEST(SingleLineTrials, CountsFlatSurfacesAsAgreement) {
  SingleLineTrial trial{{0.2, 0.8}, {0.205, 0.792}, 0.5};
  EXPECT_TRUE(trial.RatiosAgree());
  trial.ascent = {0.3, 0.8};
  EXPECT_FALSE(trial.Agrees());
  trial.shortfall = 0.9e-3;
  EXPECT_TRUE(trial.Agrees());
  EXPECT_FALSE(trial.RatiosAgree());
}

TEST(SurfaceExample, HasItsMaximumWhereTheShapeSays) {
  const SceneOptions options{SceneKind::kHomogeneousPoints, 0.005, 10};
  for (const auto shape : {SurfaceShape::kFullLength, SurfaceShape::kPiece, SurfaceShape::kPoint}) {
    const SurfaceExample example = FindSurface(options, shape);
    Eigen::Index row = 0, column = 0;
    const double greatest = example.surface.maxCoeff(&row, &column);
    const auto at = [&](double ratio) { return static_cast<Eigen::Index>(50 * ratio + 0.5); };
    EXPECT_DOUBLE_EQ(example.surface(at(example.best.y()), at(example.best.x())), greatest);
    EXPECT_NEAR((example.surface - example.surface.transpose()).norm(), 0, 1e-9);
    EXPECT_EQ(shape == SurfaceShape::kPoint, example.best.x() == example.best.y());
  }
}

}  // namespace
}  // namespace plumbline
