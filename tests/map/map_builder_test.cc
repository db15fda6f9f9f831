// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/map_builder.h"

#include "tests/io/scratch_folder.h"
#include "tests/map/map_fixture.h"
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// Keyframes 0 to 4, of which 2 was removed; points 0 and 1, 2 merged into 1; lines 0 and 1.
Map Example() {
  Map map = ChainOfKeyFrames(5);
  map.Apply({edit::AddPoint{PointSeenBy(0, {{KeyFrameId{0}, 0}, {KeyFrameId{3}, 1}})},
             edit::AddPoint{PointSeenBy(1, {{KeyFrameId{1}, 2}, {KeyFrameId{2}, 2}})},
             edit::AddPoint{PointSeenBy(2, {{KeyFrameId{3}, 5}, {KeyFrameId{4}, 5}})},
             edit::AddLine{LineSeenBy(0, {{KeyFrameId{0}, 3}, {KeyFrameId{1}, 3}})},
             edit::AddLine{LineSeenBy(1, {{KeyFrameId{4}, 0}})},
             edit::MergePoints{PointId{1}, PointId{2}},
             edit::RemoveKeyFrame{KeyFrameId{2}}});
  map.Apply(
      {edit::MoveKeyFrames{{{KeyFrameId{1}, Similarity3{2}}, {KeyFrameId{3}, Similarity3{3}}}}});
  return map;
}

Map Rebuilt(
    const MapRecord& record,
    const Map& from,
    const std::function<void(KeyFrame&)>& change = [](KeyFrame&) {}) {
  MapBuilder builder(record, "m");
  for (const auto& [id, entry] : from.keyframes()) {
    KeyFrame keyframe = entry;
    keyframe.frame.points.clear();
    change(keyframe);
    builder.Add(std::move(keyframe));
  }
  for (const auto& [id, point] : from.points()) builder.Add(point);
  for (const auto& [id, line] : from.lines()) builder.Add(line);
  return builder.Finish();
}

TEST(MapBuilder, MakesTheMapAgain) {
  const Map map = Example();
  Map built = Rebuilt(map.Record(), map);
  built.CheckInvariants();
  EXPECT_EQ(built.version(), map.version());
  EXPECT_EQ(built.NextKeyFrameId(), map.NextKeyFrameId());
  EXPECT_EQ(built.NextPointId(), map.NextPointId());
  EXPECT_EQ(built.NextLineId(), map.NextLineId());
  EXPECT_EQ(built.Current(PointId{2}), PointId{1});
  EXPECT_EQ(built.points().size(), map.points().size());
  EXPECT_EQ(built.lines().size(), map.lines().size());
  for (std::int64_t k = 0; k < 5; ++k) {
    const KeyFrameId id{k};
    EXPECT_EQ(built.PlaceOf(id).cam_from_world.Matrix(), map.PlaceOf(id).cam_from_world.Matrix());
    EXPECT_EQ(built.PlaceOf(id).scale, map.PlaceOf(id).scale);
    EXPECT_EQ(built.ParentOf(id), map.ParentOf(id));
    EXPECT_EQ(built.NumberOf(id), map.NumberOf(id));
  }
  for (const auto& [id, keyframe] : map.keyframes()) {
    EXPECT_EQ(built.Find(id)->frame.points, keyframe.frame.points);
    EXPECT_EQ(built.Find(id)->frame.lines, keyframe.frame.lines);
  }
}

TEST(MapBuilder, RefusesRecordsThatNoMapHas) {
  const Map map = Example();
  const auto message = [&](const std::function<void(MapRecord&)>& change) {
    MapRecord record = map.Record();
    change(record);
    return MessageOf([&] { Rebuilt(record, map); });
  };
  EXPECT_EQ(message([](MapRecord&) {}), "no error");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([](MapRecord& r) { r.id = {}; }),
            "m: expected a map that agrees with itself, found an id out of range");
  EXPECT_THAT(message([](MapRecord& r) { r.next_point.value = kMaxBuiltId + 1; }),
              HasSubstr("an id out of range"));
  EXPECT_THAT(message([](MapRecord& r) { r.next_point.value = 1; }), HasSubstr("never was"));
  EXPECT_THAT(message([](MapRecord& r) { r.next_line.value = 1; }), HasSubstr("out of order"));
  EXPECT_THAT(message([](MapRecord& r) { r.next_keyframe.value = 4; }), HasSubstr("out of order"));
  EXPECT_THAT(message([](MapRecord& r) { r.keyframes_taken_in = 4; }), HasSubstr("a count"));
  EXPECT_THAT(message([](MapRecord& r) { r.version = -1; }), HasSubstr("a count out of range"));
  EXPECT_THAT(message([](MapRecord& r) { r.merged_points[PointId{0}] = PointId{1}; }),
              HasSubstr("merged into another"));
  EXPECT_THAT(message([](MapRecord& r) {
                r.merged_lines = {{LineId{0}, LineId{1}}, {LineId{1}, LineId{0}}};
              }),
              HasSubstr("merges in a circle"));
  const auto removed = [&](const std::function<void(RemovedKeyFrame&)>& change) {
    return message([&](MapRecord& r) { change(r.removed_keyframes.at(KeyFrameId{2})); });
  };
  EXPECT_THAT(removed([&](RemovedKeyFrame& k) { k.scale = nan; }), HasSubstr("a valid place"));
  EXPECT_THAT(removed([](RemovedKeyFrame& k) { k.from_parent.scale = 0; }),
              HasSubstr("valid place"));
  EXPECT_THAT(removed([](RemovedKeyFrame& k) { k.number = 9; }), HasSubstr("a valid place"));
  EXPECT_THAT(removed([](RemovedKeyFrame& k) { k.parent = KeyFrameId{7}; }),
              HasSubstr("never was"));
  EXPECT_THAT(removed([](RemovedKeyFrame& k) { k.parent = KeyFrameId{3}; }),
              HasSubstr("their own ancestors"));
  EXPECT_THAT(message([](MapRecord& r) {
                r.removed_keyframes[KeyFrameId{3}] = r.removed_keyframes.at(KeyFrameId{2});
              }),
              HasSubstr("out of order"));
}

TEST(MapBuilder, RefusesKeyFramesThatNoMapHas) {
  const Map map = Example();
  const auto message = [&](const std::function<void(KeyFrame&)>& change) {
    return MessageOf([&] { Rebuilt(map.Record(), map, change); });
  };
  const auto with_features = [&](const std::function<void(Features&)>& change) {
    return message([&](KeyFrame& k) {
      auto indexed = std::make_shared<FrameFeatures>(*k.frame.indexed);
      change(indexed->features);
      k.frame.indexed = indexed;
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message([&](KeyFrame& k) { k.frame.cam_from_world.translation.x() = nan; }),
              HasSubstr("without a valid pose"));
  EXPECT_THAT(message([](KeyFrame& k) { k.frame.cam_from_world.rotation.coeffs() *= 2; }),
              HasSubstr("without a valid pose"));
  EXPECT_THAT(message([](KeyFrame& k) { k.scale = -1; }), HasSubstr("without a valid pose"));
  EXPECT_THAT(message([](KeyFrame& k) { k.number = 5; }), HasSubstr("a count out of range"));
  EXPECT_THAT(message([](KeyFrame& k) { k.parent = KeyFrameId{17}; }), HasSubstr("never was"));
  EXPECT_THAT(message([](KeyFrame& k) { k.parent = k.id; }), HasSubstr("their own ancestors"));
  EXPECT_THAT(with_features([](Features& f) { f.points.pop_back(); }), HasSubstr("unequal counts"));
  EXPECT_THAT(with_features([&](Features& f) { f.points[0].px.x() = nan; }),
              HasSubstr("a feature without a position"));
  EXPECT_THAT(with_features([](Features& f) { f.lines[0].octave = -1; }),
              HasSubstr("a feature without a position"));
}

TEST(MapBuilder, RefusesLandmarksThatNoMapHas) {
  const Map chain = ChainOfKeyFrames(2);
  MapRecord record = chain.Record();
  record.next_point = PointId{9};
  const auto message = [&](const std::vector<MapPoint>& points) {
    MapBuilder builder(record, "m");
    for (const auto& [id, keyframe] : chain.keyframes()) builder.Add(keyframe);
    return MessageOf([&] {
      for (const MapPoint& point : points) builder.Add(point);
      builder.Finish();
    });
  };
  const KeyFrameId k0{0};
  EXPECT_EQ(message({PointSeenBy(1, {{k0, 0}}), PointSeenBy(3, {{k0, 1}})}), "no error");
  EXPECT_THAT(message({PointSeenBy(3, {{k0, 0}}), PointSeenBy(1, {{k0, 1}})}),
              HasSubstr("landmarks out of order"));
  EXPECT_THAT(message({PointSeenBy(9, {{k0, 0}})}), HasSubstr("landmarks out of order"));
  EXPECT_THAT(message({PointSeenBy(1, {})}), HasSubstr("without observations"));
  EXPECT_THAT(message({PointSeenBy(1, {{k0, 0}}), PointSeenBy(3, {{k0, 0}})}), HasSubstr("taken"));
  EXPECT_THAT(message({PointSeenBy(1, {{k0, static_cast<int>(kFeatures)}})}), HasSubstr("taken"));
  EXPECT_THAT(message({PointSeenBy(1, {{k0, -1}})}), HasSubstr("not there"));
  EXPECT_THAT(message({PointSeenBy(1, {{KeyFrameId{5}, 0}})}), HasSubstr("not there"));
  MapPoint nowhere = PointSeenBy(1, {{k0, 0}});
  nowhere.position.x() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message({nowhere}), HasSubstr("a landmark without a place"));
}

}  // namespace
}  // namespace plumbline
