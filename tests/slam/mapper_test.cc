// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapper.h"

#include "tests/support/synthetic_run.h"
#include <memory>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::shared_ptr<const NewKeyFrame> SensedKeyFrame(const SyntheticWorld& world,
                                                  std::int64_t id,
                                                  std::int64_t parent) {
  Rng rng(1, "keyframe", static_cast<std::uint64_t>(id));
  const Rigid3 pose = PoseOnPath(static_cast<int>(4 * id));
  const Rigid3 parent_pose = PoseOnPath(static_cast<int>(4 * parent));
  return std::make_shared<NewKeyFrame>(
      NewKeyFrame{{KeyFrameId{id},
                   KeyFrameId{parent},
                   MakeFrame(FrameId{id}, pose, Sense(world, pose, {}, rng))},
                  {},
                  {pose * Inverse(parent_pose), 1}});
}

class MapperOfAWorld : public ::testing::Test {
 protected:
  MapUpdate Process(MapCommand command) {
    return mapper_.Process(std::move(command), LoadLevel::kNothing);
  }

  const SyntheticWorld world_ = MakeSyntheticWorld(200, 40);
  SlamOptions options_;
  Mapper mapper_{world_.Imaging(), options_, {}};
};

TEST_F(MapperOfAWorld, TakesKeyFramesInAndGivesSnapshotsAroundThem) {
  for (std::int64_t id = 0; id < 3; ++id) {
    const MapUpdate update = Process({SensedKeyFrame(world_, id, id - 1), 10 * id, id == 0});
    ASSERT_NE(update.snapshot, nullptr);
    EXPECT_EQ(update.snapshot->centre, KeyFrameId{id});
    EXPECT_FALSE(update.times.empty());
  }
  EXPECT_EQ(mapper_.atlas().active().keyframes().size(), 3U);
  mapper_.atlas().active().CheckInvariants();
  mapper_.Finish({});
  mapper_.atlas().active().CheckInvariants();
}

TEST_F(MapperOfAWorld, ReadersSeeTheMapsAndChangeNoSnapshot) {
  Process({SensedKeyFrame(world_, 0, -1), 0, true});
  std::size_t seen = 0;
  const MapUpdate update =
      Process({MapReader{[&](const Atlas& atlas, const LocalMapper&, const PlaceRecognition&) {
                 seen = atlas.active().keyframes().size();
               }},
               1});
  EXPECT_EQ(seen, 1U);
  EXPECT_EQ(update.snapshot, nullptr);
}

TEST_F(MapperOfAWorld, TheSnapshotIsTakenAroundTheKeyFrameThatShowsMost) {
  for (std::int64_t id = 0; id < 3; ++id) {
    Process({SensedKeyFrame(world_, id, id - 1), 10 * id, id == 0});
  }
  const Map& map = mapper_.atlas().active();
  UpdateLocalMapRequest request{map.id(), {}, {}};
  for (const PointId id : map.Find(KeyFrameId{0})->frame.points) {
    if (id.valid()) request.points.push_back(id);
  }
  const MapUpdate update = Process({std::move(request), 30});
  ASSERT_NE(update.snapshot, nullptr);
  EXPECT_EQ(update.snapshot->centre, KeyFrameId{0});
  // No keyframe shows a landmark that is not in the map.
  EXPECT_EQ(Process({UpdateLocalMapRequest{map.id(), {PointId{1'000'000}}, {}}, 31}).snapshot,
            nullptr);
}

}  // namespace
}  // namespace plumbline
