// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/strong_covisibility.h"

#include "plumbline/base/random.h"
#include "plumbline/map/covisibility.h"

#include "tests/map/map_fixture.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace strong_covisibility_test {

constexpr int kStrong = 4;
constexpr KeyFrameId kEarly{3}, kMiddle{70}, kLate{140};  // on three pages
using Ids = std::vector<KeyFrameId>;

// Compares the pairs with those of Covisible(). Returns how many there are.
int ExpectAllPairs(const StrongCovisibility& covisible, const Map& map) {
  int pairs = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    Ids expected;
    for (const CovisibleKeyFrame& other : Covisible(map, id, kStrong)) {
      if (other.id < id) expected.push_back(other.id);
    }
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(covisible.EarlierOf(id), expected) << id.value;
    pairs += static_cast<int>(expected.size());
  }
  return pairs;
}

// Makes and changes maps at random.
class Editor {
 public:
  std::size_t Draw(std::size_t count) { return rng_.Index(count); }

  Map Start() {
    Map map = ChainOfKeyFrames(kKeyFrames);
    for (int i = 0; i < 400; ++i) AddPoint(map);
    for (int i = 0; i < 100; ++i) AddLine(map);
    return map;
  }

  void Change(Map& map) {
    const KeyFrameId keyframe = AnyOf(map.keyframes());
    const PointId point = AnyOf(map.points());
    const LineId line = AnyOf(map.lines());
    switch (Draw(11)) {
      case 0:
        return AddKeyFrame(map);
      case 1:
        return map.Apply({edit::RemoveKeyFrame{keyframe}});
      case 2:
        return AddPoint(map);
      case 3:
        return AddLine(map);
      case 4:
        return map.Apply({edit::AddPointObservation{point, keyframe, AnyFeature()}});
      case 5:
        return map.Apply({edit::AddLineObservation{line, keyframe, AnyFeature()}});
      case 6:
        return map.Apply({edit::RemovePointObservation{point, ObserverOf(map, point)}});
      case 7:
        return map.Apply({edit::MergePoints{point, AnyOf(map.points())}});
      case 8:
        return map.Apply({edit::MergeLines{line, AnyOf(map.lines())}});
      case 9:
        return map.Apply({edit::RemovePoint{point}});
      default:
        return map.Apply({edit::SetPose{keyframe, {}}});
    }
  }

 private:
  static constexpr std::int64_t kKeyFrames = 200;

  template <class Id, class T>
  Id AnyOf(const IdTable<Id, T>& table) {
    const std::int64_t first = table.begin()->first.value;
    const std::int64_t last = table.rbegin()->first.value;
    const std::size_t drawn = Draw(static_cast<std::size_t>(last - first) + 1);
    return table.lower_bound(Id{first + static_cast<std::int64_t>(drawn)})->first;
  }

  int AnyFeature() { return static_cast<int>(Draw(kFeatures)); }

  KeyFrameId ObserverOf(const Map& map, PointId id) {
    const Observations& seen = map.Find(id)->observations;
    return (seen.begin() + static_cast<std::ptrdiff_t>(Draw(seen.size())))->first;
  }

  // Returns observations by keyframes side by side, and now and then by others half a map away.
  Observations Seen(const Map& map) {
    Observations seen;
    const std::int64_t first = AnyOf(map.keyframes()).value;
    const bool twice = Draw(3) == 0;
    for (std::int64_t k = first; k < first + 8; ++k) {
      seen.emplace(KeyFrameId{k}, AnyFeature());
      if (twice) seen.emplace(KeyFrameId{(k + kKeyFrames / 2) % kKeyFrames}, AnyFeature());
    }
    return seen;
  }

  void AddPoint(Map& map) {
    map.Apply({edit::AddPoint{PointSeenBy(map.NextPointId().value, Seen(map))}});
  }

  void AddLine(Map& map) {
    map.Apply({edit::AddLine{LineSeenBy(map.NextLineId().value, Seen(map))}});
  }

  void AddKeyFrame(Map& map) {
    KeyFrame keyframe =
        BlankKeyFrame(map.NextKeyFrameId().value, map.keyframes().rbegin()->first.value);
    for (PointId& match : keyframe.frame.points) match = AnyOf(map.points());
    for (LineId& match : keyframe.frame.lines) match = AnyOf(map.lines());
    map.Apply({edit::AddKeyFrame{std::move(keyframe)}});
  }

  Rng rng_{7, "strong_covisibility_test"};
};

// Ten points that the early keyframe shows, and the middle and the late one with it.
Map OnThreePages() {
  Map map = ChainOfKeyFrames(150);
  for (int i = 0; i < 10; ++i) {
    map.Apply({edit::AddPoint{PointSeenBy(i, {{kEarly, i}, {kMiddle, i}, {kLate, i}})}});
  }
  return map;
}

// Leaves the early keyframe three of the ten points.
void TakeMostOfTheEarlyOnes(Map& map) {
  for (std::int64_t i = 0; i < 7; ++i) {
    map.Apply({edit::RemovePointObservation{PointId{i}, kEarly}});
  }
}

TEST(StrongCovisibility, HasAllPairsAfterAnyChanges) {
  constexpr int kRounds = 60;
  Editor editor;
  Map map = editor.Start();
  StrongCovisibility covisible(kStrong);
  std::vector<Map> earlier;
  int pairs = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t left = editor.Draw(12); left > 0; --left) editor.Change(map);
    if (round % 7 == 0) earlier.push_back(map);
    if (round % 10 == 9) map = earlier[editor.Draw(earlier.size())];
    covisible.Follow(map);
    pairs += ExpectAllPairs(covisible, map);
    ASSERT_FALSE(::testing::Test::HasFailure()) << round;
  }
  map.CheckInvariants();
  EXPECT_GT(pairs, 100 * kRounds);
}

TEST(StrongCovisibility, FollowsEarlierKeyFramesWherePagesOfLaterOnesStay) {
  Map map = OnThreePages();
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  const std::uint64_t before = map.keyframes().PageChanged(2);
  TakeMostOfTheEarlyOnes(map);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kMiddle});
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  map.Apply({edit::AddPointObservation{PointId{0}, kEarly, 0}});
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  EXPECT_EQ(map.keyframes().PageChanged(2), before);
}

// The copy has the id of the map, more versions and more changes, and its first page looks older
// than the last look at the map.
TEST(StrongCovisibility, KnowsACopyThatWentOnByItself) {
  Map map = OnThreePages();
  Map copy = map;
  TakeMostOfTheEarlyOnes(map);
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  for (int i = 0; i < 20; ++i) copy.Apply({edit::SetPose{kLate, {}}});
  EXPECT_GT(copy.version(), map.version());
  EXPECT_GT(copy.keyframes().changes(), map.keyframes().changes());
  EXPECT_LE(copy.keyframes().PageChanged(0), map.keyframes().changes());
  covisible.Follow(copy);
  EXPECT_EQ(covisible.EarlierOf(kMiddle), Ids{kEarly});
  covisible.Follow(map);
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
}

TEST(StrongCovisibility, ForgetsPagesThatHaveGone) {
  Map map = OnThreePages();
  StrongCovisibility covisible(kStrong);
  covisible.Follow(map);
  for (std::int64_t id = 64; id < 128; ++id) map.Apply({edit::RemoveKeyFrame{KeyFrameId{id}}});
  ASSERT_EQ(map.keyframes().PageChanged(1), 0U);
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kEarly});
  EXPECT_TRUE(covisible.EarlierOf(kMiddle).empty());
  covisible.Forget();
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(kLate), Ids{kEarly});
}

TEST(StrongCovisibility, FollowsMapsThatAreJoined) {
  Map map = OnThreePages();
  Map other(MapId{1});
  other.ReserveIds(PointId{1000}, LineId{1000});
  for (std::int64_t id = 300; id < 304; ++id) {
    other.Apply({edit::AddKeyFrame{BlankKeyFrame(id, id == 300 ? -1 : id - 1)}});
  }
  for (int i = 0; i < 10; ++i) {
    other.Apply({edit::AddPoint{PointSeenBy(1000 + i, SeenBy(300, 303, i))}});
  }
  StrongCovisibility covisible(kStrong);
  covisible.Follow(other);
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), Ids{KeyFrameId{300}});
  covisible.Follow(map);
  map.Absorb(std::move(other), {});
  covisible.Follow(map);
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), Ids{KeyFrameId{300}});
  EXPECT_EQ(covisible.EarlierOf(kLate), (Ids{kEarly, kMiddle}));
  for (std::int64_t i = 0; i < kStrong; ++i) {
    map.Apply({edit::MergePoints{PointId{i}, PointId{1000 + i}}});
  }
  covisible.Follow(map);
  map.CheckInvariants();
  EXPECT_EQ(covisible.EarlierOf(KeyFrameId{301}), (Ids{kEarly, kMiddle, kLate, KeyFrameId{300}}));
  ExpectAllPairs(covisible, map);
}

}  // namespace strong_covisibility_test
}  // namespace plumbline
