// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_explanation.h"

#include "tests/initialization/window_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::MakeWindowScene;
using testing::RotationErrorDeg;
using testing::WindowScene;

Explanation At(const Rigid3& newest, double cost) {
  Explanation explanation;
  explanation.solution.cam_from_reference = {newest};
  explanation.cost = cost;
  return explanation;
}

TEST(Insert, KeepsTheCheaperOfTwoThatAreTheSame) {
  const Rigid3 pose = CurvedMotion(1).front();
  const Rigid3 larger{pose.rotation, 3 * pose.translation};
  const Rigid3 turned{ExpSo3({0, 0.006, 0}) * pose.rotation, pose.translation};
  std::vector<Explanation> explanations;
  InsertExplanation(At(pose, 5), explanations);
  InsertExplanation(At(larger, 4), explanations);  // the unit is free
  InsertExplanation(At(pose, 6), explanations);
  InsertExplanation(At(turned, 2), explanations);
  SortByCost(explanations);
  ASSERT_EQ(explanations.size(), 2U);
  EXPECT_EQ(explanations[0].cost, 2);
  EXPECT_EQ(explanations[1].cost, 4);
  EXPECT_EQ(explanations[1].solution.cam_from_reference[0].translation, larger.translation);
}

TEST(Adjust, EndsAtTheTruth) {
  const WindowScene scene = MakeWindowScene(1, CurvedMotion(3), {.points = 60});
  Explanation explanation;
  explanation.solution = scene.truth;
  Eigen::Quaterniond& turned = explanation.solution.cam_from_reference.back().rotation;
  turned = ExpSo3({0.003, 0, 0.002}) * turned;
  AdjustExplanation(scene.tracks, explanation);
  EXPECT_LT(RotationErrorDeg(explanation.solution.cam_from_reference.back(),
                             scene.truth.cam_from_reference.back()),
            1e-2);
  EXPECT_LT(explanation.cost, 1e-3);
  EXPECT_EQ(explanation.cost, explanation.fit.cost);
}

}  // namespace
}  // namespace plumbline
