// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/pending_keyframes.h"

#include "plumbline/base/error.h"
#include "plumbline/mapping/local_mapper.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using KeyFramePointer = std::shared_ptr<const NewKeyFrame>;

// A map of keyframe 0 and keyframes after it that see more and more that is not in it.
class KeyFramesAhead : public ::testing::Test {
 protected:
  KeyFramesAhead() {
    mapper_.Add(map_, Sensed(0).keyframe, {});
    snapshot_ = TakeSnapshot(map_, KeyFrameId{0});
  }

  NewKeyFrame Sensed(std::int64_t id) {
    Rng rng(1, "keyframe", static_cast<std::uint64_t>(id));
    const Rigid3 pose = PoseOnPath(static_cast<int>(6 * id));
    const SyntheticFrame sensed = Sense(world_, pose, {}, rng);
    truth_.push_back(sensed.point_truth);
    const Rigid3 parent_pose = PoseOnPath(static_cast<int>(6 * (id - 1)));
    return {{KeyFrameId{id}, KeyFrameId{id - 1}, MakeFrame(FrameId{id}, pose, sensed)},
            {},
            pose * Inverse(parent_pose)};
  }

  // Keyframe `id`, which must be made in order, matched by the truth with what keyframe `of` shows
  // in a snapshot.
  KeyFramePointer Ahead(std::int64_t id, std::int64_t of, const MapSnapshot& snapshot) {
    NewKeyFrame added = Sensed(id);
    Frame& frame = added.keyframe.frame;
    const auto& earlier = truth_[static_cast<std::size_t>(of)];
    const auto& shown = snapshot.reference->frame.points;
    EXPECT_EQ(snapshot.centre, KeyFrameId{of});
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      const auto at = std::find(earlier.begin(), earlier.end(), truth_.back()[i]);
      if (at != earlier.end())
        frame.points[i] = shown[static_cast<std::size_t>(at - earlier.begin())];
    }
    return std::make_shared<const NewKeyFrame>(std::move(added));
  }

  std::shared_ptr<const MapSnapshot> With(const std::vector<KeyFramePointer>& ahead) const {
    return WithPendingKeyFrames(*snapshot_, ahead, world_.camera, options_.creation);
  }

  SyntheticWorld world_ = MakeSyntheticWorld(400, 60);
  MappingOptions options_;
  LocalMapper mapper_{world_.Imaging(), LineSettings{}, options_};
  Map map_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::vector<std::vector<std::size_t>> truth_;  // of the points of each keyframe
};

TEST_F(KeyFramesAhead, ProvisionalIdsNameAFeatureAndNothingOfAMap) {
  const auto id = ProvisionalId<PointId>({KeyFrameId{123}, 45});
  const auto named = FindProvisional(id);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->keyframe, KeyFrameId{123});
  EXPECT_EQ(named->feature, 45U);
  EXPECT_LT(id, ProvisionalId<PointId>({KeyFrameId{123}, 46}));
  EXPECT_LT(id, ProvisionalId<PointId>({KeyFrameId{124}, 0}));
  EXPECT_FALSE(FindProvisional(PointId{}));
  EXPECT_FALSE(FindProvisional(map_.points().rbegin()->first));
  EXPECT_EQ(map_.Find(id), nullptr);
  EXPECT_FALSE(map_.Current(id).valid());
}

TEST_F(KeyFramesAhead, AreTrackedAgainstWithWhatTheyMeasured) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const auto one = With({first});
  const auto two = With({first, Ahead(2, 1, *one)});
  EXPECT_EQ(two->centre, KeyFrameId{2});
  EXPECT_EQ(two->reference->id, KeyFrameId{2});
  EXPECT_EQ(two->cam_from_world.size(), 3U);
  EXPECT_GT(one->points.size(), snapshot_->points.size() + 10);
  EXPECT_GT(two->points.size(), one->points.size());
  EXPECT_GT(two->lines.size(), snapshot_->lines.size());
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  EXPECT_TRUE(std::is_sorted(two->points.begin(), two->points.end(), by_id));
  EXPECT_TRUE(std::is_sorted(two->lines.begin(), two->lines.end(), by_id));
  int provisional = 0;
  for (std::size_t i = 0; i < two->reference->frame.points.size(); ++i) {
    const PointId id = two->reference->frame.points[i];
    if (!id.valid()) continue;
    const SnapshotPoint* point = two->Find(id);
    ASSERT_NE(point, nullptr);
    const auto& truth = world_.points[truth_[2][i]].position;
    EXPECT_LT((point->position - truth).norm(), 0.15 * truth.norm());
    provisional += FindProvisional(id).has_value();
  }
  EXPECT_GT(provisional, 10);
}

TEST_F(KeyFramesAhead, CountAsViewsOfWhatTheyShow) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const auto one = With({first});
  const auto two = With({first, Ahead(2, 1, *one)});
  int three_views = 0, two_views_of_new = 0;
  for (const SnapshotPoint& point : two->points) {
    three_views += point.observation_count == 3;
    two_views_of_new += FindProvisional(point.id) && point.observation_count == 2;
  }
  EXPECT_GT(three_views, 20);
  EXPECT_GT(two_views_of_new, 5);
}

TEST_F(KeyFramesAhead, MoveWithTheirParent) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const Rigid3 moved{ExpSo3({0.01, 0, 0.02}), {0.5, -0.2, 0.1}};
  MapSnapshot shifted = *snapshot_;
  shifted.cam_from_world.at(KeyFrameId{0}) = moved;
  shifted.places.at(KeyFrameId{0}).cam_from_world = moved;
  const auto with = WithPendingKeyFrames(shifted, {first}, world_.camera, options_.creation);
  const Rigid3 expected = first->from_parent.cam_from_keyframe * moved;
  EXPECT_LT(CentreDistance(with->cam_from_world.at(KeyFrameId{1}), expected), 1e-12);
  EXPECT_LT(CentreDistance(with->reference->frame.cam_from_world, expected), 1e-12);
}

TEST_F(KeyFramesAhead, TheirMatchesBecomeThoseOfTheMap) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const KeyFramePointer second = Ahead(2, 1, *With({first}));
  mapper_.Add(map_, SettledIn(map_, *first), first->scores);
  const KeyFrame settled = SettledIn(map_, *second);
  int replaced = 0;
  for (std::size_t i = 0; i < settled.frame.points.size(); ++i) {
    const PointId id = settled.frame.points[i];
    EXPECT_FALSE(FindProvisional(id));
    if (!FindProvisional(second->keyframe.frame.points[i]) || !id.valid()) continue;
    ++replaced;
    EXPECT_NE(map_.Find(id), nullptr);
  }
  EXPECT_GT(replaced, 5);
  mapper_.Add(map_, settled, second->scores);
  map_.CheckInvariants();
  // So do those of the snapshot in which only the second one is still ahead.
  snapshot_ = TakeSnapshot(map_, KeyFrameId{1});
  const auto with = With({second});
  EXPECT_EQ(with->centre, KeyFrameId{2});
}

TEST_F(KeyFramesAhead, GoWhereTheParentIsToday) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const Rigid3 moved{ExpSo3({0.01, 0, 0.02}), {0.5, -0.2, 0.1}};
  map_.Apply({edit::SetPose{KeyFrameId{0}, moved}});
  const KeyFrame settled = SettledIn(map_, *first);
  EXPECT_LT(
      CentreDistance(settled.frame.cam_from_world, first->from_parent.cam_from_keyframe * moved),
      1e-12);
}

TEST_F(KeyFramesAhead, OneThatIsTakenOutLeavesNoTrace) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  NewKeyFrame scored = *first;
  scored.scores.points[PointId{3}] = {4, 2};
  std::vector<KeyFramePointer> waiting{std::make_shared<const NewKeyFrame>(scored)};
  waiting.push_back(Ahead(2, 1, *With({first})));
  waiting.push_back(Ahead(3, 2, *With({first, waiting[1]})));
  const Rigid3 grandparent =
      waiting[1]->from_parent.cam_from_keyframe * waiting[0]->from_parent.cam_from_keyframe;
  const auto gone = TakeOut(0, waiting);
  EXPECT_EQ(gone->keyframe.id, KeyFrameId{1});
  ASSERT_EQ(waiting.size(), 2U);
  EXPECT_EQ(waiting[0]->keyframe.parent, KeyFrameId{0});
  EXPECT_LT(LogSe3(waiting[0]->from_parent.cam_from_keyframe * Inverse(grandparent)).norm(), 1e-12);
  EXPECT_EQ(waiting[1]->keyframe.parent, KeyFrameId{2});
  EXPECT_EQ(waiting[0]->scores.points.at(PointId{3}).visible, 4);
  EXPECT_EQ(waiting[0]->scores.points.at(PointId{3}).found, 2);
  // What it measured and others show is theirs.
  int shared = 0;
  for (const PointId id : waiting[1]->keyframe.frame.points) {
    const auto provisional = FindProvisional(id);
    EXPECT_FALSE(provisional && provisional->keyframe == KeyFrameId{1});
    shared += provisional && provisional->keyframe == KeyFrameId{2};
  }
  EXPECT_GT(shared, 10);
  // What only it measured is gone from what is tracked against, and from the map.
  const auto tracked_against = With(waiting);
  for (const SnapshotPoint& point : tracked_against->points) {
    const auto provisional = FindProvisional(point.id);
    EXPECT_FALSE(provisional && provisional->keyframe == KeyFrameId{1});
  }
  for (const auto& added : waiting) mapper_.Add(map_, SettledIn(map_, *added), added->scores);
  map_.CheckInvariants();
  EXPECT_EQ(map_.Find(KeyFrameId{1}), nullptr);
  EXPECT_THROW(TakeOut(1, waiting), BugError);
}

TEST_F(KeyFramesAhead, NewMeasurementsAreThoseWithoutLandmarkAndWithDepth) {
  const KeyFramePointer first = Ahead(1, 0, *snapshot_);
  const Frame& frame = first->keyframe.frame;
  int expected = 0;
  for (const PointId id : frame.points) expected += !id.valid();
  for (const auto& right : frame.features().line_right) expected += right.has_value();
  EXPECT_EQ(NewMeasurements(*first, world_.camera), expected);
  RectifiedCamera one = world_.camera;
  one.baseline = 0;
  EXPECT_GE(NewMeasurements(*first, one), expected);
}

}  // namespace
}  // namespace plumbline
