// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/random.h"
#include "plumbline/viewer/map_comparison.h"
#include "plumbline/viewer/view_clients.h"
#include "plumbline/viewer/viewed_map.h"

#include "tests/support/true_map.h"
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

// A world seen by four keyframes that go to the right.
class MapSeen : public testing::Test {
 protected:
  MapSeen() {
    std::vector<Rigid3> poses(4);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].translation.x() = -0.2 * static_cast<double>(i);
    }
    TrueMap made = MakeTrueMap(MakeSyntheticWorld(300, 40), poses, {});
    atlas_.Adopt(std::move(made.map));
    atlas_.Activate(MapId{0});
  }

  Map& map() { return atlas_.active(); }
  void Move(PointId id, double distance) {
    const Eigen::Vector3d position = map().Find(id)->position + Eigen::Vector3d(distance, 0, 0);
    map().Apply({edit::MovePoint{id, position}});
  }

  Atlas atlas_;
  MapComparison comparison_{SessionId{0}};
};

TEST_F(MapSeen, TheFirstLookTellsEverything) {
  const MapChanges changes = comparison_.Compare(atlas_);
  EXPECT_TRUE(changes.everything);
  EXPECT_EQ(changes.points.set.size(), map().points().size());
  EXPECT_EQ(changes.lines.set.size(), map().lines().size());
  EXPECT_EQ(changes.keyframes.set.size(), 4U);
  EXPECT_EQ(changes.keyframes.set[2].second.frame, 2U);
  EXPECT_NEAR(changes.keyframes.set[2].second.pose[0], 0.4, 1e-6);
  EXPECT_EQ(changes.edges.size(), 6U);  // all see the same
  EXPECT_TRUE(comparison_.Compare(atlas_).empty());
}

TEST_F(MapSeen, TellsWhatMovedCameAndWent) {
  comparison_.Compare(atlas_);
  Move(PointId{3}, 0.5);
  map().Apply({edit::RemovePoint{PointId{5}}, edit::RemoveLine{LineId{1}}});
  const MapChanges changes = comparison_.Compare(atlas_);
  EXPECT_FALSE(changes.everything);
  ASSERT_EQ(changes.points.set.size(), 1U);
  EXPECT_EQ(changes.points.set[0].first, 3U);
  EXPECT_EQ(changes.points.gone, std::vector<ShownId>{5});
  EXPECT_EQ(changes.lines.gone, std::vector<ShownId>{1});
  EXPECT_TRUE(changes.keyframes.empty());
}

TEST_F(MapSeen, MovesThatNobodySeesAddUp) {
  comparison_.Compare(atlas_);
  int told = 0;
  for (int i = 0; i < 100; ++i) {
    Move(PointId{3}, 1e-4);
    told += !comparison_.Compare(atlas_).empty();
  }
  EXPECT_GE(told, 1);
  EXPECT_LE(told, 7);
}

// Whatever happens to a map, what was told of it adds up to what a new look at all of it tells.
TEST_F(MapSeen, WhatWasToldAddsUpToTheMap) {
  Rng rng(7, "map seen");
  std::map<ShownId, ShownPoint> points;
  std::map<ShownId, ShownLine> lines;
  const auto take = [](const auto& changes, auto& told) {
    for (const auto& [id, value] : changes.set) told[id] = value;
    for (const ShownId id : changes.gone) ASSERT_EQ(told.erase(id), 1U);
  };
  const auto change_something = [&]() -> MapChange {
    const auto any = [&](const auto& entries) {
      const auto n =
          static_cast<std::ptrdiff_t>(rng.Uniform(0, static_cast<double>(entries.size())));
      return std::next(entries.begin(), n)->first;
    };
    const PointId point = any(map().points());
    const double what = rng.Uniform(0, 6);
    if (what < 1) return edit::RemovePoint{point};
    if (what < 2 && !map().lines().empty()) return edit::RemoveLine{any(map().lines())};
    if (what < 3) return edit::MovePoint{point, {rng.Uniform(-5, 5), 0, 9}};
    if (what < 4) {
      MapPoint added = *map().Find(point);
      added.id = map().NextPointId();
      added.observations = {};
      added.observations.emplace(KeyFrameId{1}, static_cast<int>(rng.Uniform(0, 100)));
      return edit::AddPoint{added};
    }
    if (what < 5) return edit::MergePoints{any(map().points()), point};
    const Similarity3 right{1, Eigen::Quaterniond::Identity(), {0.5, 0, 0}};
    return edit::MoveKeyFrames{{{any(map().keyframes()), right}}};
  };
  for (int look = 0; look < 60; ++look) {
    const MapChanges changes = comparison_.Compare(atlas_);
    take(changes.points, points);
    take(changes.lines, lines);
    const MapChanges all = MapComparison(SessionId{0}).Compare(atlas_);
    using Points = std::vector<std::pair<ShownId, ShownPoint>>;
    using Lines = std::vector<std::pair<ShownId, ShownLine>>;
    ASSERT_EQ(Points(points.begin(), points.end()), all.points.set) << look;
    ASSERT_EQ(Lines(lines.begin(), lines.end()), all.lines.set) << look;
    for (int i = 0; i < 3; ++i) map().Apply({change_something()});
  }
}

TEST_F(MapSeen, AnotherMapBeginsAnew) {
  comparison_.Compare(atlas_);
  atlas_.Start();
  const MapChanges changes = comparison_.Compare(atlas_);
  EXPECT_TRUE(changes.everything);
  EXPECT_EQ(changes.map, MapId{1});
  EXPECT_TRUE(changes.points.empty());
}

TEST_F(MapSeen, KeyframesOfAnotherRunHaveNoFrameOfThisOne) {
  MapComparison comparison(SessionId{1});
  const MapChanges changes = comparison.Compare(atlas_);
  EXPECT_EQ(changes.keyframes.set[0].second.frame, ShownKeyFrame::kOfAnotherRun);
}

TEST_F(MapSeen, NeighboursOfManyKeyframesComeWithLaterLooks) {
  for (int i = 0; i < 20; ++i) AddKeyFrameTo(map(), {}, {IndexFeatures(TestCamera(), {}), {}, {}});
  comparison_.Compare(atlas_);
  EXPECT_TRUE(comparison_.HasMore());
  comparison_.Compare(atlas_);
  EXPECT_FALSE(comparison_.HasMore());
}

TEST_F(MapSeen, TellsWhoSeesALandmark) {
  const MapPoint& point = map().points().begin()->second;
  const auto question = ParseMapQuestion(R"({"point": )" + std::to_string(point.id.value) + "}");
  ASSERT_TRUE(question.has_value());
  const auto answer = nlohmann::json::parse(AnswerMapQuestion(atlas_, *question));
  ASSERT_EQ(answer["seen_by"].size(), point.observations.size());
  const auto& [keyframe, feature] = *point.observations.begin();
  EXPECT_EQ(answer["seen_by"][0]["keyframe"], keyframe.value);
  const auto& px =
      map().Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].px;
  EXPECT_EQ(answer["seen_by"][0]["px"][0], px.x());
  const auto line =
      nlohmann::json::parse(AnswerMapQuestion(atlas_, *ParseMapQuestion(R"({"line":2})")));
  EXPECT_EQ(line["seen_by"][0]["px"].size(), 4U);
  const auto none = nlohmann::json::parse(AnswerMapQuestion(atlas_, {false, 987654}));
  EXPECT_TRUE(none["seen_by"].empty());
}

TEST(MapQuestion, OtherQuestionsAreNone) {
  for (const char* text : {"", "{}", "[]", R"({"point":"a"})", R"({"point":1.5})", "point"}) {
    EXPECT_FALSE(ParseMapQuestion(text).has_value()) << text;
  }
}

// Ids of points that a delta sets and takes away.
std::pair<std::vector<ShownId>, std::vector<ShownId>> PointsIn(
    const VersionedTable<ShownPoint>& table, std::uint64_t from) {
  std::pair<std::vector<ShownId>, std::vector<ShownId>> ids;
  table.ForEachSince(from, [&](ShownId id, const ShownPoint* value) {
    (value != nullptr ? ids.first : ids.second).push_back(id);
  });
  return ids;
}

TEST(VersionedTable, TellsWhatChangedSinceAVersionOnce) {
  VersionedTable<ShownPoint> table;
  table.Set(1, {1, 0, 0}, 1);
  table.Set(2, {2, 0, 0}, 1);
  table.Set(1, {3, 0, 0}, 2);
  table.Remove(2, 3);
  table.Remove(7, 3);  // never there
  EXPECT_EQ(PointsIn(table, 0).first, std::vector<ShownId>{1});
  EXPECT_EQ(PointsIn(table, 1).first, std::vector<ShownId>{1});
  EXPECT_EQ(PointsIn(table, 1).second, std::vector<ShownId>{2});
  EXPECT_TRUE(PointsIn(table, 2).first.empty());
  EXPECT_TRUE(PointsIn(table, 3).second.empty());
  EXPECT_EQ(table.size(), 1U);
  EXPECT_EQ((*table.Find(1))[0], 3);
  EXPECT_EQ(table.Find(2), nullptr);
  table.Set(2, {4, 0, 0}, 4);
  EXPECT_EQ(PointsIn(table, 3).first, std::vector<ShownId>{2});
  EXPECT_EQ(table.size(), 2U);
}

// Whoever comes and goes for hours does not make it grow.
TEST(VersionedTable, ForgetsWhatIsLongGone) {
  VersionedTable<ShownPoint> table;
  std::uint64_t version = 0;
  for (ShownId id = 0; id < 10'000; ++id) {
    table.Set(id, {}, ++version);
    if (id >= 100) table.Remove(id - 100, ++version);
  }
  EXPECT_EQ(table.size(), 100U);
  EXPECT_GT(table.forgotten(), 0U);
  std::size_t remembered = 0;
  table.ForEachSince(0, [&](ShownId, const ShownPoint*) { ++remembered; });
  EXPECT_LE(remembered, 1200U);
}

// What a receiver that applies every delta has in the end.
class Receiver {
 public:
  void Take(const ViewedMap& map) {
    cloud_ = map.PointCloud();
    bytes_ += map.DeltaSince(version_).bytes().size();
    version_ = map.version();
  }
  std::size_t bytes() const { return bytes_; }
  std::uint64_t version() const { return version_; }

 private:
  std::uint64_t version_ = 0;
  std::size_t bytes_ = 0;
  std::vector<float> cloud_;
};

TEST_F(MapSeen, NothingIsSentTwice) {
  ViewedMap viewed;
  Receiver receiver;
  viewed.Take(comparison_.Compare(atlas_));
  receiver.Take(viewed);
  const std::size_t whole = receiver.bytes();
  EXPECT_GT(whole, 16 * map().points().size());
  for (int i = 0; i < 100; ++i) {
    Move(PointId{i}, 0.5);
    viewed.Take(comparison_.Compare(atlas_));
    receiver.Take(viewed);
  }
  // A point is 16 bytes; numbers of the map and of versions, and lengths, are some 30.
  EXPECT_LT(receiver.bytes() - whole, 100 * 60U);
  EXPECT_EQ(viewed.DeltaSince(0).bytes().size(), whole + 0U);
}

TEST_F(MapSeen, OnlyTilesThatChangedAreSent) {
  ViewedMap viewed;
  viewed.Take(comparison_.Compare(atlas_));
  const ViewedMap::Tiles all = viewed.TilesSince(0);
  EXPECT_TRUE(all.all);
  std::size_t numbers = 0;
  for (const LineEntity& entity : all.entities) numbers += entity.ends.size();
  EXPECT_EQ(numbers, 6 * map().lines().size());
  const std::uint64_t before = viewed.version();
  EXPECT_TRUE(viewed.TilesSince(before).entities.empty());
  map().Apply({edit::RemoveLine{LineId{2}}});
  viewed.Take(comparison_.Compare(atlas_));
  const ViewedMap::Tiles some = viewed.TilesSince(before);
  EXPECT_FALSE(some.all);
  EXPECT_EQ(some.entities.size(), 1U);
}

TEST(ViewedMap, LinesFarApartShareTilesInTheEnd) {
  MapChanges changes;
  changes.everything = true;
  changes.map = MapId{0};
  for (ShownId id = 0; id < 1000; ++id) {
    const float x = 10.0F * static_cast<float>(id);
    changes.lines.set.push_back({id, {{x, 0, 0, x + 1, 0, 0}, false}});
  }
  changes.lines.set.push_back({1000, {{NAN, 0, 0, INFINITY, 0, 0}, false}});
  ViewedMap viewed;
  viewed.Take(changes);
  EXPECT_LE(viewed.TilesSince(0).entities.size(), 256U);
}

}  // namespace
}  // namespace plumbline
