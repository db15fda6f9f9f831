// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_situation.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kFramesSince = 5;

// A map whose newest keyframe is the one asked about, and a frame that stands where it does.
struct KnownKeyFrame {
  explicit KnownKeyFrame(int keyframes)
      : scene(MakeTrueMap(world, std::vector(static_cast<std::size_t>(keyframes), Rigid3{}), {})),
        snapshot(TakeSnapshot(scene.map, KeyFrameId{keyframes - 1})),
        frame(snapshot->reference->frame),
        association(AssociationOf(frame, *snapshot)) {}

  KeyFrameSituation Situation(double feature_share = 1, bool monocular = false) const {
    return SituationOf(frame, association, *snapshot, kFramesSince, feature_share, monocular);
  }
  int Landmarks() const {
    const auto valid = [](const auto& ids) {
      return std::count_if(ids.begin(), ids.end(), [](auto id) { return id.valid(); });
    };
    return static_cast<int>(valid(frame.points) + valid(frame.lines));
  }

  SyntheticWorld world = MakeSyntheticWorld(300, 60);
  TrueMap scene;
  std::shared_ptr<const MapSnapshot> snapshot;
  Frame frame;
  LandmarkMatches association;
};

TEST(KeyFrameSituation, OfTheKeyframeItselfSharesAll) {
  const KnownKeyFrame known(4);
  const KeyFrameSituation situation = known.Situation();
  EXPECT_GT(situation.reference_landmarks, known.Landmarks() / 2);
  EXPECT_EQ(situation.shared_landmarks, situation.reference_landmarks);
  EXPECT_GT(situation.close_tracked, 0);
  EXPECT_EQ(situation.frames_since_keyframe, kFramesSince);
  EXPECT_EQ(situation.share_of_usual, 1);
  EXPECT_EQ(situation.share_of_reference, 1);
}

TEST(KeyFrameSituation, CountsLandmarksOfTwoViewsInAYoungMapAndWithOneCamera) {
  const KnownKeyFrame young(2);
  EXPECT_GT(young.Situation().reference_landmarks, young.Landmarks() / 2);
  const KnownKeyFrame old(6);
  EXPECT_GE(old.Situation(1, true).reference_landmarks, old.Situation().reference_landmarks);
  EXPECT_TRUE(old.Situation(1, true).monocular);
}

TEST(KeyFrameSituation, TellsNearPointsThatTheMapLacks) {
  KnownKeyFrame known(4);
  const int tracked = known.Situation().close_tracked;
  const int untracked = known.Situation().close_untracked;
  for (std::size_t i = 0; i < known.frame.points.size(); ++i) {
    known.frame.points[i] = {};
    known.association.matches.point_of_feature[i] = -1;
  }
  const KeyFrameSituation situation = known.Situation();
  EXPECT_EQ(situation.close_tracked, 0);
  EXPECT_EQ(situation.close_untracked, tracked + untracked);
  EXPECT_LT(situation.shared_landmarks, situation.reference_landmarks);
}

TEST(KeyFrameSituation, ExpectsLessWhereFeaturesAreShed) {
  KnownKeyFrame known(4);
  SyntheticWorld half = known.world;
  half.points.resize(half.points.size() / 2);
  half.lines.resize(half.lines.size() / 2);
  Rng rng(7);
  known.frame = MakeFrame(FrameId{9}, Rigid3{}, Sense(half, Rigid3{}, {}, rng));
  known.association = LandmarkMatches(known.frame.points.size(), known.frame.lines.size());
  const KeyFrameSituation situation = known.Situation(0.5);
  EXPECT_EQ(situation.share_of_usual, 0.5);
  EXPECT_NEAR(situation.share_of_reference, 0.5, 0.15);
}

}  // namespace
}  // namespace plumbline
