// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_tracks.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kViews = 3;
constexpr KeyFrameId kBefore{4}, kMade{5};

Frame Showing(const std::vector<PointId>& points, const std::vector<LineId>& lines = {}) {
  Frame frame;
  frame.points = points;
  frame.lines = lines;
  return frame;
}

// Points 0 to 9 and lines 0 to 9, those with even numbers shown by two keyframes, others by one.
MapSnapshot SnapshotAround(KeyFrameId centre, const Frame& shown) {
  MapSnapshot snapshot;
  snapshot.centre = centre;
  KeyFrame reference;
  reference.frame = shown;
  snapshot.reference = std::make_shared<const KeyFrame>(reference);
  for (int i = 0; i < 10; ++i) {
    const int views = i % 2 == 0 ? 2 : 1;
    SnapshotPoint point;
    point.id = PointId{i};
    point.observation_count = views;
    snapshot.points.push_back(point);
    SnapshotLine line;
    line.id = LineId{i};
    line.observation_count = views;
    snapshot.lines.push_back(line);
  }
  return snapshot;
}

const Frame kKeyFrame =
    Showing({PointId{0}, PointId{}, PointId{1}, PointId{2}, PointId{4}}, {LineId{6}, LineId{7}});

TEST(KeyFrameTracks, CountsWhatThreeKeyFramesShowTheNewOneIncluded) {
  const MapSnapshot before = SnapshotAround(kBefore, Showing({}));
  const KeyFrameTracks tracks(kMade, kKeyFrame, before, kViews);
  EXPECT_FALSE(tracks.empty());
  EXPECT_EQ(tracks.keyframe(), kMade);
  const auto count =
      tracks.CountShared(Showing({PointId{4}, PointId{1}, PointId{8}}, {LineId{6}}), before);
  EXPECT_EQ(count.shown, 4);   // points 0, 2, 4 and line 6
  EXPECT_EQ(count.shared, 2);  // point 4 and line 6
}

// Mapping has merged a landmark with another, given one up, and found two more in the keyframe.
TEST(KeyFrameTracks, FollowsTheLandmarksThroughMapping) {
  const KeyFrameTracks tracks(kMade, kKeyFrame, SnapshotAround(kBefore, Showing({})), kViews);
  const MapSnapshot mapped = SnapshotAround(
      kMade,
      Showing({PointId{8}, PointId{6}, PointId{1}, PointId{}, PointId{4}}, {LineId{6}, LineId{2}}));
  const auto count = tracks.CountShared(Showing({PointId{8}, PointId{6}, PointId{0}}), mapped);
  EXPECT_EQ(count.shown, 3);   // 8, which was 0, 4 and line 6
  EXPECT_EQ(count.shared, 1);  // 8
}

TEST(KeyFrameTracks, AreTheSameBeforeAndAfterMappingWhereNothingIsRenamed) {
  const MapSnapshot before = SnapshotAround(kBefore, Showing({}));
  const KeyFrameTracks tracks(kMade, kKeyFrame, before, kViews);
  const MapSnapshot mapped =
      SnapshotAround(kMade,
                     Showing({PointId{0}, PointId{6}, PointId{1}, PointId{2}, PointId{4}},
                             {LineId{6}, LineId{8}}));
  const Frame frame = Showing({PointId{0}, PointId{2}, PointId{6}}, {LineId{8}});
  const auto then = tracks.CountShared(frame, before);
  const auto now = tracks.CountShared(frame, mapped);
  EXPECT_EQ(then.shown, now.shown);
  EXPECT_EQ(then.shared, now.shared);
  EXPECT_EQ(now.shared, 2);
}

TEST(KeyFrameTracks, AreNoneWithoutAKeyFrame) {
  const KeyFrameTracks none;
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(none.keyframe().valid());
}

}  // namespace
}  // namespace plumbline
