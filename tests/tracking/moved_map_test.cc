// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// What tracking does when the map moves under it.
#include "plumbline/geometry/sim3.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include "tests/support/most_alike.h"
#include "tests/support/true_map.h"
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kFirst = 5;     // frame on the path
constexpr int kMoved = 12;    // the map moves before this one
constexpr int kFrames = 30;   // tracked after that
constexpr double kDepth = 6;  // of the scene, metres

// Follows the path against a map that stays as it is but for the motion.
class Follower {
 public:
  explicit Follower(double baseline) {
    world_.camera.baseline = baseline;
    std::vector<Rigid3> poses;
    for (int k = 0; k < 9; ++k) poses.push_back(PoseOnPath(6 * k));
    map_ = MakeTrueMap(world_, poses, Sensor()).map;
    const Relocalizer relocalizer(world_.Imaging(), {}, {world_.camera, {}, {}});
    const Frame frame = MakeFrame(FrameId{0}, Rigid3{}, Sensed(kFirst));
    std::vector<PlaceToTry> places;
    for (const KeyFrameId id : KeyFramesOf(map_)) places.push_back({&map_, id});
    const auto found = relocalizer.Find(frame, places);
    centre_ = found->keyframe;
    tracker_.BeginLost({.next_keyframe = map_.NextKeyFrameId()});
    tracker_.FollowFrom(*found, *Snapshot());
  }

  TrackingResult Step(int frame) {
    const auto snapshot = Snapshot();
    const TrackingResult result =
        tracker_.Track(FrameId{frame}, 50'000'000LL * frame, Sensed(frame).indexed, snapshot.get());
    earlier_.push_back(centre_);
    centre_ = KeyFrameId{frame / 6};
    return result;
  }

  // All keyframes, by one similarity.
  void Move(const Similarity3& motion) {
    edit::MoveKeyFrames change;
    for (const auto& [id, keyframe] : map_.keyframes()) change.new_from_old[id] = motion;
    map_.Apply({change});
  }

  void Withdraw() { withdrawn_ = true; }

 private:
  SensorModel Sensor() const { return {.depth = world_.camera.baseline > 0, .noise = 0.2}; }
  SyntheticFrame Sensed(int frame) const {
    Rng rng(3, "follower", static_cast<std::uint64_t>(frame));
    return Sense(world_, PoseOnPath(frame), Sensor(), rng);
  }
  std::shared_ptr<const MapSnapshot> Snapshot() const {
    MapSnapshot snapshot = *TakeSnapshot(map_, centre_, kSnapshotKeyFrames, earlier_);
    snapshot.withdrawn = withdrawn_;
    return std::make_shared<const MapSnapshot>(std::move(snapshot));
  }

  SyntheticWorld world_ = MakeSyntheticWorld(400, 80);
  Map map_;
  Tracker tracker_{world_.Imaging(), {}, {world_.camera, {}, {}}, Rigid3{}};
  KeyFrameId centre_;
  std::vector<KeyFrameId> earlier_;
  bool withdrawn_ = false;
};

// A map of an earlier run that proves wrong while it grows: nothing can be found in it any more.
TEST(LoadedMap, IsLeftWhenItIsWithdrawn) {
  Follower follower(0);
  EXPECT_TRUE(follower.Step(kFirst + 1).cam_from_world);
  follower.Withdraw();
  const TrackingResult result = follower.Step(kFirst + 2);
  EXPECT_EQ(result.failure, TrackingFailure::kMapWithdrawn);
  EXPECT_EQ(result.state, TrackerState::kInitializing);
}

TEST(MovedMap, OfOneCameraScaledByTwoGivesTheSameMatches) {
  Follower stays(0), moved(0);
  for (int frame = kFirst + 1; frame < kMoved + kFrames; ++frame) {
    if (frame == kMoved) moved.Move({2, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()});
    const TrackingResult a = stays.Step(frame);
    const TrackingResult b = moved.Step(frame);
    ASSERT_TRUE(a.cam_from_world && b.cam_from_world) << frame;
    EXPECT_EQ(a.frame.points, b.frame.points) << frame;
    EXPECT_EQ(a.frame.lines, b.frame.lines) << frame;
    const double scale = frame < kMoved ? 1 : 2;
    EXPECT_LT((scale * a.cam_from_world->translation - b.cam_from_world->translation).norm(),
              1e-6 * kDepth)
        << frame;
  }
}

void ExpectTheSamePathAfter(double baseline, const Similarity3& motion) {
  Follower stays(baseline), moved(baseline);
  for (int frame = kFirst + 1; frame < kMoved + kFrames; ++frame) {
    if (frame == kMoved) moved.Move(motion);
    const TrackingResult a = stays.Step(frame);
    const TrackingResult b = moved.Step(frame);
    ASSERT_TRUE(a.cam_from_world && b.cam_from_world) << frame;
    const Rigid3 then = Inverse(*a.cam_from_world);
    const Rigid3 expected = frame < kMoved ? then : TransformPose(motion, then);
    const Vector6d error = LogSe3(*b.cam_from_world * expected);
    EXPECT_LT(error.head<3>().norm(), 1e-3) << frame;
    EXPECT_LT(error.tail<3>().norm(), 1e-3 * kDepth * motion.scale) << frame;
  }
}

TEST(MovedMap, OfOneCameraIsFollowedThroughAnySimilarity) {
  ExpectTheSamePathAfter(0, {0.3, ExpSo3({0.5, -1, 0.8}), {20, -3, 7}});
}

TEST(MovedMap, WithDepthIsFollowedThroughAnyRigidMotion) {
  ExpectTheSamePathAfter(0.11, {1, ExpSo3({-0.7, 0.4, 2}), {-5, 8, 40}});
}

}  // namespace
}  // namespace plumbline
