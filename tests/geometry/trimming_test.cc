// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/trimming.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Ends of lines in the camera frame: horizontal, vertical and oblique images, through the principal
// point, receding in depth.
std::vector<Segment3> CameraSegments() {
  return {{{-1, 0.5, 3}, {1, 0.5, 3}},     // horizontal image
          {{0.7, -1, 3}, {0.7, 1, 3}},     // vertical image
          {{-1, 0, 4}, {1, 0, 4}},         // horizontal through the principal point
          {{0, -1, 4}, {0, 1, 4}},         // vertical through the principal point
          {{-1, -1, 4}, {1, 1, 4}},        // oblique through the principal point
          {{0.5, 0.4, 1}, {0.5, 0.4, 6}},  // parallel to the optical axis
          {{-1, 0.3, 2}, {2, -0.6, 5}}};
}

TEST(TrimToSegment, FindsTheEndsThatTheSegmentCameFrom) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(1);
  for (const Segment3& in_camera : CameraSegments()) {
    const Rigid3 cam_from_world = RandomRigid(rng, 3, 4);
    const Rigid3 world_from_cam = Inverse(cam_from_world);
    const Segment3 in_world{world_from_cam * in_camera.start, world_from_cam * in_camera.end};
    const PluckerLine line = LineThroughPoints(in_world.start, in_world.end);
    const Segment2 image{camera.Project(in_camera.start), camera.Project(in_camera.end)};
    const auto interval = TrimToSegment(camera, cam_from_world, line, image);
    ASSERT_TRUE(interval) << in_camera.start.transpose();
    EXPECT_LT(interval->start, interval->end);
    const Segment3 found = SegmentOf(line, *interval);
    EXPECT_LT((found.start - in_world.start).norm(), 1e-10);
    EXPECT_LT((found.end - in_world.end).norm(), 1e-10);
    const auto reversed = TrimToSegment(camera, cam_from_world, line, image.Reversed());
    ASSERT_TRUE(reversed);
    EXPECT_DOUBLE_EQ(reversed->start, interval->end);
  }
}

TEST(TrimToSegment, ProjectsAPixelBesideTheLineAtRightAngles) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(2);
  for (const Segment3& in_camera : CameraSegments()) {
    const PluckerLine line = LineThroughPoints(in_camera.start, in_camera.end);
    const Eigen::Vector2d middle = camera.Project(in_camera.Midpoint());
    const Eigen::Vector3d l =
        LineThrough({camera.Project(in_camera.start), camera.Project(in_camera.end)});
    for (const double offset : {-7.0, 2.0, 30.0}) {
      const auto parameter =
          TrimmedParameter(camera, Rigid3{}, line, middle + offset * l.head<2>());
      ASSERT_TRUE(parameter);
      EXPECT_LT((camera.Project(line.PointAt(*parameter)) - middle).norm(), 1e-9);
    }
  }
}

TEST(TrimmedParameter, RefusesPointsBehindTheCamera) {
  const RectifiedCamera camera = TestCamera();
  // Seen in the left half, vanishing at the principal point; beyond it the line is behind.
  const PluckerLine line = LineThroughPoints({-1, 0, 2}, {-1, 0, 8});
  EXPECT_TRUE(TrimmedParameter(camera, Rigid3{}, line, {camera.cx - 50, camera.cy}));
  EXPECT_FALSE(TrimmedParameter(camera, Rigid3{}, line, {camera.cx + 50, camera.cy}));
}

TEST(TrimmedParameter, RefusesLinesSeenEndOn) {
  const RectifiedCamera camera = TestCamera();
  const PluckerLine through_centre = LineThroughPoints({0, 0, 0}, {0.2, 0.1, 1});
  EXPECT_FALSE(TrimmedParameter(camera, Rigid3{}, through_centre, {300, 200}));
  const PluckerLine in_the_focal_plane = LineThroughPoints({-1, 2, 0}, {1, 2, 0});
  EXPECT_FALSE(TrimmedParameter(camera, Rigid3{}, in_the_focal_plane, {300, 200}));
}

TEST(TrimmedParameter, RefusesTheVanishingPoint) {
  const RectifiedCamera camera = TestCamera();
  const PluckerLine line = LineThroughPoints({-1, 0.5, 2}, {-1, 0.5, 8});
  EXPECT_FALSE(TrimmedParameter(camera, Rigid3{}, line, {camera.cx, camera.cy}));
}

}  // namespace
}  // namespace plumbline
