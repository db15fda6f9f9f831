// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/two_view_images_initializer.h"

#include "plumbline/base/error.h"

#include "tests/initialization/blob_images.h"
#include "tests/initialization/window_scene.h"
#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Blobs;
using testing::DirectionErrorDeg;
using testing::FrameAt;
using testing::RotationErrorDeg;

// Features have an error of 0.3 px; places on the images are found anew.
TEST(TwoViewImagesInitializer, StartsFromPlacesOnTheImages) {
  const Blobs blobs;
  Rng rng(1);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  for (int i = 0; i < 20; ++i) {
    const auto result = initializer.Add(FrameAt(blobs, PoseOnPath(i), i, rng));
    EXPECT_EQ(result.map.has_value(), result.wait == InitializationWait::kNone);
    if (!result.map) continue;
    EXPECT_GE(result.matches, 100);
    EXPECT_GE(result.parallax_deg, 1);
    ASSERT_EQ(result.map->views.size(), 2U);
    EXPECT_EQ(result.map->views.front().frame.id.value, 0);
    EXPECT_LT(RotationErrorDeg(result.map->views.back().cam_from_world, PoseOnPath(i)), 0.5);
    EXPECT_LT(DirectionErrorDeg(result.map->views.back().cam_from_world, PoseOnPath(i)), 5);
    for (const InitialPoint& point : result.map->points) {
      EXPECT_TRUE(point.observations.back().px) << "where the image shows it";
    }
    return;
  }
  FAIL() << "no map";
}

TEST(TwoViewImagesInitializer, KeepsTheReferenceWhileTheCameraStands) {
  const Blobs blobs;
  Rng rng(1);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  constexpr int kStanding = 4;
  std::optional<InitialMap> map;
  for (int i = 0; i < kStanding + 20 && !map; ++i) {
    const Rigid3 pose = PoseOnPath(std::max(0, i - kStanding));
    map = initializer.Add(FrameAt(blobs, pose, i, rng)).map;
    EXPECT_FALSE(map && i <= kStanding);
  }
  ASSERT_TRUE(map);
  EXPECT_EQ(map->views.front().frame.id.value, 0);
  initializer.Reset();
  EXPECT_EQ(initializer.Add(FrameAt(blobs, {}, 40, rng)).wait, InitializationWait::kTooFewFrames);
}

// The reference moves to the frame halfway when matches have died out, so that there are more
// again.
TEST(TwoViewImagesInitializer, MovesTheReferenceWhenMatchesDieOut) {
  const Blobs blobs;
  Rng rng(3);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  InitializationResult before;
  bool moved = false;
  for (int i = 0; i < 30 && !moved; ++i) {
    const Rigid3 turned{ExpSo3({0, 0.06 * i, 0}), {0, 0, 0}};
    const auto result = initializer.Add(FrameAt(blobs, turned, i, rng));
    EXPECT_FALSE(result.map);
    moved = before.wait == InitializationWait::kTooFewMatches && before.matches > 0 &&
            result.matches > 1.5 * before.matches;
    before = result;
  }
  EXPECT_TRUE(moved);
}

TEST(TwoViewImagesInitializer, AsksForFeaturesAndImages) {
  const Blobs blobs;
  Rng rng(4);
  TwoViewImagesInitializer initializer(blobs.world.Imaging(), 1);
  InitializationFrame frame = FrameAt(blobs, {}, 0, rng);
  const SyntheticFrame nothing{IndexFeatures(blobs.world.camera, {}), {}, {}};
  EXPECT_EQ(initializer.Add({FrameId{0}, 0, nothing.indexed, frame.image}).wait,
            InitializationWait::kTooFewFeatures);
  frame.image = nullptr;
  EXPECT_THROW(initializer.Add(frame), BugError);
}

}  // namespace
}  // namespace plumbline
