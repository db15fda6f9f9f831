// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/residual_consistency.h"

#include "tests/lab/consistency/shares.h"
#include "tests/support/true_map.h"
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Kind = ConsistencyKind;

std::vector<ConsistencySample> SamplesWith(double noise) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 100);
  std::vector<Rigid3> poses;
  for (int frame = 0; frame < 60; frame += 6) poses.push_back(PoseOnPath(frame));
  const TrueMap scene = MakeTrueMap(world, poses, {.noise = noise});
  KeyFramePoses by_keyframe;
  for (const auto& [id, keyframe] : scene.map.keyframes()) {
    by_keyframe[id] = keyframe.frame.cam_from_world;
  }
  return ResidualSamples(scene.map, world.camera, by_keyframe);
}

TEST(ResidualSamples, AreInsideAsOftenAsPromisedWhereTheNoiseIsAsPromised) {
  const auto samples = SamplesWith(1);
  for (const Kind kind : {Kind::kPoint, Kind::kDisparity, Kind::kLine, Kind::kRightLine}) {
    EXPECT_GT(OfKind(samples, kind).size(), 400U) << NameOf(kind);
    EXPECT_NEAR(ShareInside(samples, kind), 0.9, 0.03) << NameOf(kind);
  }
}

TEST(ResidualSamples, AreOutsideWhereTheNoiseIsTwiceThePromised) {
  const auto samples = SamplesWith(2);
  // P(chi2 < quantile / 4): 1 - 0.1^(1/4) with two components, 0.589 with one.
  for (const Kind kind : {Kind::kPoint, Kind::kLine, Kind::kRightLine}) {
    EXPECT_NEAR(ShareInside(samples, kind), 0.438, 0.05) << NameOf(kind);
  }
  EXPECT_NEAR(ShareInside(samples, Kind::kDisparity), 0.589, 0.05);
}

TEST(ResidualSamples, TellTheErrorsOfSegmentsInPixels) {
  double middle = 0, turn = 0, promised = 0, promised_turn = 0;
  const auto lines = OfKind(SamplesWith(1), Kind::kLine);
  for (const ConsistencySample& sample : lines) {
    middle += sample.across_px.x() * sample.across_px.x();
    turn += sample.across_px.y() * sample.across_px.y();
    promised += sample.promised_px.x() * sample.promised_px.x();
    promised_turn += sample.promised_px.y() * sample.promised_px.y();
    EXPECT_GE(sample.length, 20);
  }
  EXPECT_NEAR(middle / promised, 1, 0.15);
  EXPECT_NEAR(turn / promised_turn, 1, 0.15);
}

TEST(ResidualSamples, KnowHowMuchNearerTheCameraCame) {
  const SyntheticWorld world = MakeSyntheticWorld(100, 0);
  const std::vector<Rigid3> poses = {Rigid3{},
                                     Inverse(Rigid3{Eigen::Quaterniond::Identity(), {0, 0, 1}})};
  const TrueMap scene = MakeTrueMap(world, poses, {.noise = 0});
  KeyFramePoses by_keyframe;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    by_keyframe[KeyFrameId{static_cast<std::int64_t>(k)}] = poses[k];
  }
  const auto points = OfKind(ResidualSamples(scene.map, world.camera, by_keyframe), Kind::kPoint);
  ASSERT_GT(points.size(), 20U);
  for (const ConsistencySample& sample : points) {
    EXPECT_EQ(sample.earlier, 1);
    // Depths of 3 to 9 m, 1 m less then.
    EXPECT_LT(sample.approach, -1 / 9.0 + 1e-9);
    EXPECT_GT(sample.approach, -1 / 3.0 - 1e-9);
  }
}

TEST(ResidualSamples, LeaveOutKeyFramesWithoutAPose) {
  const SyntheticWorld world = MakeSyntheticWorld(50, 20);
  const TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10)}, {});
  EXPECT_FALSE(ResidualSamples(scene.map,
                               world.camera,
                               {{KeyFrameId{0}, PoseOnPath(0)}, {KeyFrameId{1}, PoseOnPath(10)}})
                   .empty());
  EXPECT_TRUE(ResidualSamples(scene.map, world.camera, {{KeyFrameId{1}, PoseOnPath(10)}}).empty());
}

}  // namespace
}  // namespace plumbline
