// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_viewers.h"

#include "lab/line_maps/line_map_error.h"
#include "plumbline/base/random.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace line_viewers_test {

// 90 degrees wide, a little less high.
Camera WideCamera() {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 100;
  intrinsics.cx = 100;
  intrinsics.cy = 75;
  intrinsics.width = 201;
  intrinsics.height = 151;
  return Camera(intrinsics);
}

EvaluatedPose PoseAt(std::int64_t stamp_ns, const Eigen::Vector3d& position) {
  EvaluatedPose pose;
  pose.stamp_ns = stamp_ns;
  pose.reference.translation = position;
  return pose;
}

// Keyframes at frames 0, 1 and 2, in the same place.
LineViewers ThreeViewers() {
  const std::vector<std::int64_t> frames = {10, 20, 30, 40}, keyframes = {10, 20, 30};
  const std::vector<EvaluatedPose> poses = {
      PoseAt(10, {0, 0, 0}), PoseAt(20, {0, 0, 0}), PoseAt(30, {0, 0, 0})};
  LineViewers viewers = ViewersOf(WideCamera(), frames, keyframes, poses);
  viewers.min_frames = 3;
  return viewers;
}

TEST(ViewersOf, AreKeyFramesWithAFrameAndAPose) {
  const std::vector<std::int64_t> frames = {10, 20, 30}, keyframes = {10, 25, 30};
  const std::vector<EvaluatedPose> poses = {PoseAt(10, {1, 0, 0}), PoseAt(20, {2, 0, 0})};
  const LineViewers viewers = ViewersOf(WideCamera(), frames, keyframes, poses);
  ASSERT_EQ(viewers.frames.size(), 1U);
  EXPECT_EQ(viewers.frames[0].frame, 0);
  EXPECT_DOUBLE_EQ(viewers.frames[0].camera_from_world.translation.x(), -1);
}

// Its border is 101 degrees from the middle, where nothing is in front of the camera any more.
TEST(ViewersOf, TakeAFisheyeThatSeesBehindItself) {
  CameraIntrinsics intrinsics;
  intrinsics.fx = intrinsics.fy = 180;
  intrinsics.cx = 319.5;
  intrinsics.cy = 239.5;
  intrinsics.width = 640;
  intrinsics.height = 480;
  intrinsics.model = DistortionModel::kEquidistant;
  const std::vector<std::int64_t> frames = {10}, keyframes = {10};
  const std::vector<EvaluatedPose> poses = {PoseAt(10, {0, 0, 0})};
  const LineViewers viewers = ViewersOf(Camera(intrinsics), frames, keyframes, poses);
  const Eigen::Vector3d nearly_beside(20, 0, 1), below(0, 3, 1);
  for (const Eigen::Vector3d& side : viewers.image_sides) {
    EXPECT_GT(side.dot(nearly_beside), 0);
    EXPECT_GT(side.dot(below), 0);
  }
}

TEST(SeenStretches, EndAtTheBordersOfTheImage) {
  // At depth 2 the image is 4 m wide, 3 m high.
  const auto seen = SeenStretches({{{-5, 0, 2}, {5, 0, 2}}}, ThreeViewers());
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(seen[0].from, 3, 1e-9);
  EXPECT_NEAR(seen[0].to, 7, 1e-9);
  const auto upright = SeenStretches({{{0, -5, 2}, {0, 5, 2}}}, ThreeViewers());
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_NEAR(upright[0].Length(), 3, 1e-9);
  EXPECT_TRUE(SeenStretches({{{-5, 0, -2}, {5, 0, -2}}}, ThreeViewers()).empty());
}

TEST(SeenStretches, EndWhereTheLineIsTooFar) {
  const auto seen = SeenStretches({{{0, 0, 1}, {0.001, 0, 20}}}, ThreeViewers());
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(seen[0].from, 0, 1e-9);
  EXPECT_NEAR(seen[0].to, 5, 1e-6);
}

TEST(SeenStretches, NeedEnoughFramesThatSeeTheLine) {
  const Segment3 segment{{-1, 0, 2}, {1, 0, 2}};
  const auto seen_in = [&](std::vector<FrameRange> frames) {
    return !SeenStretches({segment, TrueLineKind::kGeometry, std::move(frames)}, ThreeViewers())
                .empty();
  };
  EXPECT_TRUE(seen_in({{0, 2}}));
  EXPECT_TRUE(seen_in({{0, 0}, {1, 2}}));
  EXPECT_FALSE(seen_in({{0, 1}}));
  EXPECT_FALSE(seen_in({{1, 9}}));  // frame 3 is no keyframe
}

// Against projecting points.
TEST(SeenStretches, AgreeWithProjection) {
  Rng rng(2, "visibility");
  const Camera camera = WideCamera();
  int inside = 0;
  for (int trial = 0; trial < 100; ++trial) {
    LineViewers viewers = ThreeViewers();
    viewers.min_frames = 1;
    viewers.frames.resize(1);
    viewers.frames[0].camera_from_world = RandomRigid(rng, 3, 3);
    const Segment3 segment{RandomVector<3>(rng, 3), RandomVector<3>(rng, 3)};
    const auto seen = SeenStretches({segment}, viewers);
    for (double t = 0.01; t < 1; t += 0.05) {
      const Eigen::Vector3d point = segment.start + t * (segment.end - segment.start);
      const Eigen::Vector3d local = viewers.frames[0].camera_from_world * point;
      const auto px = camera.Project(local);
      const bool expected = px && camera.Contains(*px) && local.norm() <= viewers.max_distance;
      bool found = false;
      for (const Stretch& s : seen) {
        found |= s.from <= t * segment.Length() && t * segment.Length() <= s.to;
      }
      EXPECT_EQ(found, expected);
      inside += expected;
    }
  }
  EXPECT_GT(inside, 30);
}

TEST(LineMapErrorWithViewers, AsksForWhatTheKeyFramesSee) {
  LineMapErrorOptions options;
  options.viewers = ThreeViewers();
  const std::vector<TrueLine> truth = {{{{-5, 0, 2}, {5, 0, 2}}}, {{{-5, 0, 9}, {5, 0, 9}}}};
  const std::vector<Segment3> estimate = {{{-2, 0, 2}, {0, 0, 2}}, {{3, 0, 2}, {5, 0, 2}}};
  const LineMapError error = CompareLineMaps(truth, estimate, {}, options);
  EXPECT_EQ(error.asked_lines, 1U);
  EXPECT_NEAR(error.asked_length, 4, 1e-9);
  EXPECT_NEAR(*error.at[2].recall, 2.05 / 4, 1e-9);  // the estimate covers 5 cm beyond its end
  EXPECT_NEAR(*error.at[2].precision, 1, 1e-9);      // all of a true line covers
}

}  // namespace line_viewers_test
}  // namespace plumbline
