// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// A lost camera that is found in a map that it left before.
#include "plumbline/slam/system.h"

#include "tests/support/moving_poster.h"
#include <memory>

#include <gtest/gtest.h>

namespace plumbline {
namespace map_return_test {

constexpr int kLeftEnd = 0,
              kRightEnd = 118;  // first frames of stretches that share next to nothing
constexpr int kStretch = 12, kAway = 14, kShortlyAway = 4;  // frames

SlamOptions InMode(RunMode mode) {
  SlamOptions options;
  options.slam.mode = mode;
  options.loop.enabled = false;  // or the two ends, which share some corners, would be joined
  return options;
}

// Stamps go on whatever is shown.
class Show {
 public:
  explicit Show(RunMode mode) : Show(InMode(mode)) {}
  explicit Show(const SlamOptions& options)
      : system_(std::make_unique<System>(MovingPoster::MakeCalibration(), options)) {}

  // The poster from this frame of it on.
  void Stretch(int first) {
    for (int i = 0; i < kStretch; ++i) Process(poster_.Frame(first + i));
  }
  void One(int frame) { Process(poster_.Frame(frame)); }
  void Elsewhere(int frames) {
    for (int i = 0; i < frames; ++i) Process(MovingPoster::StrangeFrame(0));
  }
  // Left end, long elsewhere, right end, a moment elsewhere, left end again.
  void AwayAndBack() {
    Stretch(kLeftEnd);
    Elsewhere(kAway);
    Stretch(kRightEnd);
    Elsewhere(kShortlyAway);
    Stretch(kLeftEnd);
  }

  System& system() { return *system_; }
  const FrameRecord& Newest() const { return newest_; }
  RunResult Finish() { return system_->Finish(); }

 private:
  void Process(SensorFrame frame) {
    frame.stamp_ns = MovingPoster::StampNs(shown_++);
    newest_ = system_->Process(std::move(frame));
  }

  MovingPoster poster_;
  std::unique_ptr<System> system_;
  FrameRecord newest_;
  int shown_ = 0;
};

TEST(SwitchMap, TheMapWhereTheCameraIsFoundGrowsAgain) {
  Show show(RunMode::kInline);
  show.AwayAndBack();
  EXPECT_EQ(show.Newest().status, FrameStatus::kTracked);
  EXPECT_EQ(show.Newest().map, MapId{0});
  std::size_t before = 0;
  show.system().ReadMaps([&before](const CurrentMaps& maps) {
    before = maps.atlas.Find(MapId{0})->keyframes().size();
  });
  // Further than before: new keyframes.
  for (int first = kLeftEnd; first < 5 * kStretch; first += kStretch) show.Stretch(first);
  const RunResult result = show.Finish();
  const Atlas& atlas = result.atlas;
  ASSERT_EQ(atlas.maps().size(), 2U);
  EXPECT_EQ(atlas.active_id(), MapId{0});
  const Map& old = *atlas.Find(MapId{0});
  old.CheckInvariants();
  EXPECT_GT(old.keyframes().size(), before);
  // No id of the one is used in the other.
  EXPECT_GT(old.keyframes().rbegin()->first, atlas.Find(MapId{1})->keyframes().rbegin()->first);
  for (const auto& [id, point] : old.points()) {
    EXPECT_EQ(atlas.Find(MapId{1})->Find(id), nullptr) << id.value;
  }
}

TEST(SwitchMap, PosesAreInTheWorldOfThatMap) {
  Show show(RunMode::kInline);
  show.AwayAndBack();
  const Trajectory poses = show.Finish().FinalTrajectory(MapId{0});
  ASSERT_GT(poses.size(), static_cast<std::size_t>(3 * kStretch / 2));
  const StampedPose& last = poses.back();
  const Eigen::Vector3d expected((kStretch - 1) * MovingPoster::kStep, 0, 0);
  EXPECT_LT((last.world_from_camera.translation - expected).norm(), 0.01);
}

// For one frame the camera sees the other map's place, and it is lost again before the answer is
// there.
TEST(SwitchMap, AnAnswerIsOldWhereTheCameraWasTrackedSince) {
  for (const RunMode mode : {RunMode::kInline, RunMode::kLockstep}) {
    SlamOptions options = InMode(mode);
    options.slam.lag = 2;
    Show show(options);
    show.Stretch(kLeftEnd);
    show.Elsewhere(kAway);
    show.Stretch(kRightEnd);
    show.One(kLeftEnd + 4);
    EXPECT_EQ(show.Newest().status, FrameStatus::kLost);
    show.One(kRightEnd + kStretch - 1);
    EXPECT_EQ(show.Newest().status, FrameStatus::kTracked);
    show.Elsewhere(1);
    EXPECT_EQ(show.Newest().status, FrameStatus::kLost);
    show.One(kRightEnd + kStretch - 1);
    EXPECT_EQ(show.Newest().status, FrameStatus::kTracked);
    EXPECT_EQ(show.Newest().map, MapId{1});
    MapEventCounts none;
    EXPECT_TRUE(show.system().EventsSince(none).relocalizations.empty()) << NameOf(mode);
  }
}

// A map that is only read stays as it was saved, the one that would grow included.
TEST(SwitchMap, ARunThatChangesNothingIsFoundInAnyMapOfAnAtlas) {
  Show show(RunMode::kInline);
  show.Stretch(kLeftEnd);
  show.Elsewhere(kAway);
  show.Stretch(kRightEnd);
  const RunResult result = show.Finish();
  const SavedAtlas saved{result.atlas, result.context};
  ASSERT_EQ(saved.atlas.active_id(), MapId{1});
  System localized(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  localized.Continue(saved, true);
  const MovingPoster poster;
  for (int i = 0; i < kStretch; ++i) localized.Process(poster.Frame(kLeftEnd + i));
  const RunResult found = localized.Finish();
  EXPECT_EQ(found.frames.back().status, FrameStatus::kTracked);
  EXPECT_EQ(found.frames.back().map, MapId{0});
  EXPECT_EQ(found.atlas.active_id(), MapId{1});
}

TEST(SwitchMap, LockstepDoesWhatInlineDoes) {
  Show alone(RunMode::kInline), beside(RunMode::kLockstep);
  for (Show* show : {&alone, &beside}) show->AwayAndBack();
  const Trajectory a = alone.Finish().FinalTrajectory(MapId{0});
  const Trajectory b = beside.Finish().FinalTrajectory(MapId{0});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp_ns, b[i].stamp_ns);
    EXPECT_EQ(a[i].world_from_camera.translation, b[i].world_from_camera.translation);
  }
}

}  // namespace map_return_test
}  // namespace plumbline
