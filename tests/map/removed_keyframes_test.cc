// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/removed_keyframes.h"

#include "plumbline/base/random.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr KeyFrameId kFirst{0}, kMiddle{1}, kLast{2};

// A keyframe beside its parent, which had this unit then.
RemovedKeyFrame Beside(
    KeyFrameId parent, double parent_unit, double unit, std::int64_t number, Rng& rng) {
  return {parent, {RandomRigid(rng), parent_unit}, unit, number};
}

// Where a removed keyframe is when the one that it hangs on is there.
KeyFramePose PlaceOf(const RemovedKeyFrame& removed, const KeyFramePose& parent) {
  return {ComposePose(parent, removed.from_parent),
          parent.scale * removed.scale / removed.from_parent.scale};
}

void ExpectSame(const KeyFramePose& a, const KeyFramePose& b) {
  EXPECT_LT(LogSe3(a.cam_from_world * Inverse(b.cam_from_world)).norm(), 1e-9);
  EXPECT_NEAR(a.scale, b.scale, 1e-12);
}

TEST(RemovedKeyFrames, WhatHungOnOneThatGoesHangsOnItsParent) {
  Rng rng(2);
  // The middle one had the unit 2 when the last one went, and 3 when it went itself.
  const RemovedKeyFrame last = Beside(kMiddle, 2, 4, 7, rng);
  const RemovedKeyFrame middle = Beside(kFirst, 0.5, 3, 6, rng);
  RemovedKeyFrames removed;
  removed.Add(kLast, last);
  EXPECT_EQ(removed.Find(kLast)->parent, kMiddle);
  removed.Add(kMiddle, middle);
  EXPECT_EQ(removed.Find(kLast)->parent, kFirst);
  EXPECT_EQ(removed.Find(kLast)->number, 7);
  const KeyFramePose first{RandomRigid(rng), 5};
  const KeyFramePose middle_now = PlaceOf(middle, first);
  ExpectSame(PlaceOf(*removed.Find(kMiddle), first), middle_now);
  ExpectSame(PlaceOf(*removed.Find(kLast), first), PlaceOf(last, middle_now));
  EXPECT_EQ(removed.Find(kFirst), nullptr);
  EXPECT_FALSE(removed.contains(kFirst));
}

TEST(RemovedKeyFrames, OnesThatWereReadHangOnAsWell) {
  Rng rng(3);
  const RemovedKeyFrame last = Beside(kMiddle, 1, 1, 7, rng);
  RemovedKeyFrames removed({{kLast, last}});
  removed.Add(kMiddle, Beside(kFirst, 1, 1, 6, rng));
  EXPECT_EQ(removed.Find(kLast)->parent, kFirst);
}

TEST(RemovedKeyFrames, TakeInThoseOfAnotherMap) {
  Rng rng(4);
  RemovedKeyFrames removed, other;
  removed.Add(kLast, Beside(kFirst, 1, 1, 2, rng));
  other.Add(KeyFrameId{12}, Beside(KeyFrameId{11}, 1, 1, 3, rng));
  other.ShiftNumbers(10);
  removed.Absorb(other);
  EXPECT_EQ(removed.entries().size(), 2U);
  EXPECT_EQ(removed.Find(kLast)->number, 2);
  EXPECT_EQ(removed.Find(KeyFrameId{12})->number, 13);
  removed.Add(KeyFrameId{11}, Beside(KeyFrameId{10}, 1, 1, 4, rng));
  EXPECT_EQ(removed.Find(KeyFrameId{12})->parent, KeyFrameId{10});
}

}  // namespace
}  // namespace plumbline
