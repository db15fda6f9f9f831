// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/klt_initializer.h"

#include "plumbline/base/error.h"

#include "tests/initialization/blob_images.h"
#include "tests/initialization/track_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::Blobs;
using testing::DirectionErrorDeg;
using testing::FrameAt;
using testing::RotationErrorDeg;

TEST(KltInitializer, StartsFromTracks) {
  const Blobs blobs;
  Rng rng(1);
  KltInitializer initializer(blobs.world.camera, {}, 1);
  for (int i = 0; i < 12; ++i) {
    const auto result = initializer.Add(FrameAt(blobs, PoseOnPath(i), i, rng));
    if (!result.map) continue;
    EXPECT_GT(result.matches, 50);
    const InitialView& newest = result.map->views.back();
    EXPECT_EQ(newest.frame.id.value, i);
    EXPECT_LT(RotationErrorDeg(newest.cam_from_world, PoseOnPath(i)), 0.5);
    EXPECT_LT(DirectionErrorDeg(newest.cam_from_world, PoseOnPath(i)), 5);
    EXPECT_EQ(result.wait, InitializationStatus::kNone);
    return;
  }
  FAIL() << "no map";
}

TEST(KltInitializer, WaitsForParallax) {
  const Blobs blobs;
  Rng rng(2);
  KltInitializer initializer(blobs.world.camera, {}, 1);
  for (int i = 0; i < 6; ++i) {
    EXPECT_FALSE(initializer.Add(FrameAt(blobs, {}, i, rng)).map);
  }
}

TEST(KltInitializer, NeedsImages) {
  const Blobs blobs;
  Rng rng(3);
  KltInitializer initializer(blobs.world.camera, {}, 1);
  InitializationFrame frame = FrameAt(blobs, {}, 0, rng);
  frame.image = nullptr;
  EXPECT_THROW(initializer.Add(frame), BugError);
}

}  // namespace
}  // namespace plumbline
