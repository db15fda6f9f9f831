// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/pose_trials.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

double MedianTranslation(const std::vector<PoseTrial>& trials, PoseVariant variant) {
  std::vector<double> errors;
  for (const PoseTrial& trial : trials) errors.push_back(trial.at(variant).translation_m);
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() / 2];
}

std::vector<PoseTrial> Trials(const SceneOptions& options, std::uint64_t count) {
  std::vector<PoseTrial> trials;
  for (std::uint64_t i = 0; i < count; ++i) trials.push_back(TryPoses(options, i));
  return trials;
}

TEST(PoseTrials, ErrorsAreSmallWhereTheMeasurementsAreGood) {
  const auto trials = Trials({SceneKind::kHomogeneousPoints, 0.0005, 15}, 20);
  for (const auto& [variant, name] : EnumNames(std::type_identity<PoseVariant>{})) {
    EXPECT_LT(MedianTranslation(trials, variant), 0.05) << name;
  }
}

TEST(PoseTrials, WeightsHelpWhereErrorsDiffer) {
  const auto trials = Trials({SceneKind::kStereo, 0.15, 15}, 200);
  const double full = MedianTranslation(trials, PoseVariant::kFull);
  EXPECT_LT(MedianTranslation(trials, PoseVariant::kWeighted), 0.97 * full);
  EXPECT_GT(MedianTranslation(trials, PoseVariant::kDrop), full);
  EXPECT_LT(MedianTranslation(trials, PoseVariant::kAdjusted), 0.8 * full);
}

TEST(PoseTrials, CuttingLosesNothingUnlessToAPointWithCovariances) {
  const auto trials = Trials({SceneKind::kHomogeneousPoints, 0.005, 15}, 200);
  const auto ratio = [&](PoseVariant variant) {
    double sum = 0;
    for (const PoseTrial& trial : trials) {
      sum += std::log(trial.at(variant).translation_m /
                      trial.at(PoseVariant::kWeighted).translation_m);
    }
    return std::exp(sum / static_cast<double>(trials.size()));
  };
  EXPECT_NEAR(ratio(PoseVariant::kLongCutCorrelated), 1, 0.01);
  EXPECT_GT(ratio(PoseVariant::kCutCorrelated), 1.03);
}

TEST(PoseTrials, LessMotionIsFoundThanThereWasUnlessPointsAreAdjusted) {
  const auto trials = Trials({SceneKind::kStereo, 0.15, 20}, 200);
  const auto mean = [&](PoseVariant variant) {
    double sum = 0;
    for (const PoseTrial& trial : trials) sum += trial.at(variant).along_motion_m;
    return sum / static_cast<double>(trials.size());
  };
  EXPECT_LT(mean(PoseVariant::kFull), -0.02);
  EXPECT_LT(mean(PoseVariant::kWeighted), -0.02);
  EXPECT_NEAR(mean(PoseVariant::kAdjusted), 0, 0.01);
}

TEST(PoseTrials, AreTheSameForTheSameIndex) {
  const SceneOptions options{SceneKind::kStereo, 0.05, 6};
  const PoseTrial a = TryPoses(options, 5), b = TryPoses(options, 5);
  for (const auto& [variant, error] : a) {
    EXPECT_EQ(error.translation_m, b.at(variant).translation_m);
    EXPECT_EQ(error.rotation_deg, b.at(variant).rotation_deg);
  }
}

}  // namespace
}  // namespace plumbline
