// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/frustum_tree.h"

#include "plumbline/base/error.h"
#include "plumbline/matching/projection_search.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Keyframes all over a place of 100 m, that look anywhere or along a street.
Map ScatteredMap(int keyframes, double turn) {
  Rng rng(1, "scattered");
  Map map;
  const SyntheticWorld empty = MakeSyntheticWorld(0, 0);
  for (int k = 0; k < keyframes; ++k) {
    const Eigen::Vector3d centre = RandomVector<3>(rng, 50);
    const Rigid3 pose = Inverse(Rigid3{ExpSo3(RandomVector<3>(rng, turn)), centre});
    AddKeyFrameTo(map, pose, Sense(empty, pose, {}, rng));
  }
  return map;
}

Segment3 RandomSegment(Rng& rng) {
  const Eigen::Vector3d start = RandomVector<3>(rng, 60);
  const double length = std::exp(rng.Uniform(-3, 4));
  return {start, start + length * RandomVector<3>(rng).normalized()};
}

// All that a search through all keyframes finds.
TEST(FrustumTree, LeavesOutNoKeyFrameThatShowsTheSegment) {
  Rng rng(2, "segments");
  const RectifiedCamera camera = TestCamera();
  for (const double turn : {0.1, 2.0}) {
    const Map map = ScatteredMap(200, turn);
    const FrustumTree tree(map, camera);
    std::size_t shown = 0, found = 0;
    for (int trial = 0; trial < 1000; ++trial) {
      const Segment3 segment = RandomSegment(rng);
      const double min_length = rng.Uniform() < 0.5 ? 5 : 30;
      const double max_distance = rng.Uniform() < 0.5 ? 40 : 1e9;
      const std::vector<int> candidates = tree.MayShow(segment, min_length, max_distance);
      ASSERT_TRUE(std::is_sorted(candidates.begin(), candidates.end()));
      found += candidates.size();
      for (int k = 0; k < static_cast<int>(tree.size()); ++k) {
        const Rigid3& pose = tree.keyframe(k).frame.cam_from_world;
        const auto projected = ProjectSegment(camera, {pose * segment.start, pose * segment.end});
        if (!projected || !(projected->Length() > min_length)) continue;
        if ((pose * segment.Midpoint()).norm() > max_distance) continue;
        ++shown;
        EXPECT_TRUE(std::binary_search(candidates.begin(), candidates.end(), k));
      }
    }
    EXPECT_GT(shown, 1000U);
    EXPECT_LT(found, 8 * shown);
  }
}

TEST(FrustumTree, PassesOverWhatIsFarAway) {
  const Map map = ScatteredMap(200, 2);
  const FrustumTree tree(map, TestCamera());
  const Segment3 far{{1e4, 0, 0}, {1e4, 1, 0}};
  EXPECT_TRUE(tree.MayShow(far, 5).empty());
  EXPECT_FALSE(tree.MayShow(far, 0).empty());
  EXPECT_TRUE(tree.MayShow(far, 0, 5000).empty());
}

TEST(FrustumTree, TellsKeyFramesById) {
  Map map = ScatteredMap(12, 2);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{5}}});
  const FrustumTree tree(map, TestCamera());
  ASSERT_EQ(tree.size(), 11U);
  for (int k = 0; k < 11; ++k) EXPECT_EQ(tree.IndexOf(tree.keyframe(k).id), k);
  EXPECT_EQ(tree.keyframe(5).id, KeyFrameId{6});
  EXPECT_THROW(tree.IndexOf(KeyFrameId{5}), BugError);
}

TEST(FrustumTree, HasNothingOfAnEmptyMap) {
  const Map map;
  const FrustumTree tree(map, TestCamera());
  EXPECT_EQ(tree.size(), 0U);
  EXPECT_TRUE(tree.MayShow({{0, 0, 1}, {0, 1, 1}}, 5).empty());
}

}  // namespace
}  // namespace plumbline
