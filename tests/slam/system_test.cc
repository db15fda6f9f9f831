// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system.h"

#include "plumbline/base/error.h"

#include "tests/support/moving_poster.h"
#include <algorithm>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace system_test {

bool SameBits(const Trajectory& a, const Trajectory& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.stamp_ns == y.stamp_ns &&
           x.world_from_camera.rotation.coeffs() == y.world_from_camera.rotation.coeffs() &&
           x.world_from_camera.translation == y.world_from_camera.translation;
  });
}

RunResult RunPoster(int frames) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  const MovingPoster poster;
  for (int i = 0; i < frames; ++i) system.Process(poster.Frame(i));
  return system.Finish();
}

TEST(System, FollowsTheCamera) {
  const RunResult result = RunPoster(10);
  ASSERT_EQ(result.frames.size(), 10U);
  const auto map = result.MainMap();
  ASSERT_TRUE(map);
  for (const Trajectory& trajectory :
       {result.FinalTrajectory(*map), result.CausalTrajectory(*map)}) {
    ASSERT_EQ(trajectory.size(), 10U);
    for (int i = 0; i < 10; ++i) {
      const StampedPose& pose = trajectory[static_cast<std::size_t>(i)];
      EXPECT_EQ(pose.stamp_ns, MovingPoster::StampNs(i));
      const Eigen::Vector3d expected(MovingPoster::kStep * i, 0, 0);
      EXPECT_LT((pose.world_from_camera.translation - expected).norm(), 0.01) << i;
    }
  }
  const Trajectory keyframes = result.KeyFrameTrajectory(*map);
  EXPECT_EQ(keyframes.front().stamp_ns, MovingPoster::StampNs(0));
  result.atlas.maps().rbegin()->second.CheckInvariants();
}

TEST(System, KnowsTheCovarianceOfEachPoseButThatWhichStartsTheMap) {
  constexpr int kFrames = 10;
  const RunResult result = RunPoster(kFrames);
  const std::vector<StampedCovariance> covariances = result.CausalCovariances(MapId{0});
  ASSERT_EQ(covariances.size(), kFrames - 1U);
  EXPECT_FALSE(result.frames[0].causal_covariance);
  const Trajectory poses = result.CausalTrajectory(MapId{0});
  double chi2 = 0;
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    EXPECT_EQ(covariances[i].stamp_ns, MovingPoster::StampNs(static_cast<int>(i) + 1));
    const Matrix6d& covariance = covariances[i].covariance;
    EXPECT_EQ(covariance, Matrix6d(covariance.transpose()));
    const Eigen::LLT<Matrix6d> factor(covariance);
    ASSERT_EQ(factor.info(), Eigen::Success);
    // The poster is seen from 0.01 to 100 mm and as many mrad off, whatever the noise.
    EXPECT_GT(covariance.diagonal().minCoeff(), 1e-10);
    EXPECT_LT(covariance.diagonal().maxCoeff(), 1e-2);
    Vector6d error;
    error << poses[i + 1].world_from_camera.translation -
                 Eigen::Vector3d(MovingPoster::kStep * static_cast<double>(i + 1), 0, 0),
        LogSo3(poses[i + 1].world_from_camera.rotation);
    chi2 += error.dot(factor.solve(error)) / (kFrames - 1);
  }
  EXPECT_LT(chi2, 60);  // ten times that of six degrees of freedom
}

// Every keyframe has to be able to make landmarks of its lines.
TEST(System, FindsLinesInTheRightImageOfEveryKeyFrame) {
  const RunResult result = RunPoster(10);
  const auto& keyframes = result.atlas.maps().rbegin()->second.keyframes();
  ASSERT_GE(keyframes.size(), 2U);
  for (const auto& [id, keyframe] : keyframes) {
    const auto& right = keyframe.frame.features().line_right;
    const auto found =
        std::count_if(right.begin(), right.end(), [](const auto& r) { return r.has_value(); });
    EXPECT_GT(found, 15) << id.value;
  }
}

TEST(System, RefusesFramesThatAreNoLaterThanTheLast) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  const MovingPoster poster;
  for (int i = 0; i < 3; ++i) system.Process(poster.Frame(i));
  EXPECT_THROW(system.Process(poster.Frame(2)), InputError);
  EXPECT_EQ(system.Process(poster.Frame(3)).status, FrameStatus::kTracked);
  EXPECT_EQ(system.Finish().frames.size(), 4U);
}

TEST(RunResult, MainMapIsThatOfMostFramesAndOfTwoTheFirst) {
  RunResult result;
  EXPECT_FALSE(result.MainMap());
  const auto add = [&](FrameStatus status, std::int64_t map) {
    FrameRecord record;
    record.id = FrameId{static_cast<std::int64_t>(result.frames.size())};
    record.status = status;
    record.map = MapId{map};
    result.frames.Add(record);
  };
  add(FrameStatus::kTracked, 1);
  add(FrameStatus::kLost, 0);
  EXPECT_EQ(result.MainMap(), MapId{1});
  add(FrameStatus::kTracked, 0);
  EXPECT_EQ(result.MainMap(), MapId{0});
  add(FrameStatus::kTracked, 1);
  EXPECT_EQ(result.MainMap(), MapId{1});
}

TEST(System, IsFinishedOnce) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  system.Process(MovingPoster().Frame(0));
  system.Finish();
  MapEventCounts known;
  EXPECT_THROW(system.Process(MovingPoster().Frame(1)), BugError);
  EXPECT_THROW(system.ReadMaps([](const CurrentMaps&) {}), BugError);
  EXPECT_THROW(system.EventsSince(known), BugError);
  EXPECT_THROW(system.Finish(), BugError);
}

TEST(System, ShowsItsMapsWhileItRuns) {
  for (const RunMode mode : {RunMode::kInline, RunMode::kLockstep, RunMode::kLive}) {
    SlamOptions options;
    options.slam.mode = mode;
    System system(MovingPoster::MakeCalibration(), options);
    const MovingPoster poster;
    for (int i = 0; i < 3; ++i) system.Process(poster.Frame(i));
    std::size_t keyframes = 0;
    SavedAtlas copied;
    system.ReadMaps([&](const CurrentMaps& maps) {
      keyframes = maps.atlas.active().keyframes().size();
      copied = maps.copy();
    });
    system.WaitForMapping();
    EXPECT_GE(keyframes, 1U) << NameOf(mode);
    EXPECT_EQ(copied.atlas.active().keyframes().size(), keyframes);
    ASSERT_EQ(copied.context.sessions.size(), 1U);
    EXPECT_EQ(copied.context.sessions[0].last_stamp_ns, MovingPoster::StampNs(2));
    EXPECT_EQ(copied.context.maps.size(), 1U);
  }
}

TEST(System, TheWorldIsTheFirstKeyFramesCameraAsDelivered) {
  const MovingPoster poster;
  for (const double yaw : {0.0, 0.03}) {
    System system(MovingPoster::MakeCalibration(yaw), SlamOptions{});
    EXPECT_EQ(system.Process(MovingPoster::BlindFrame(0)).status, FrameStatus::kInitializing);
    const FrameRecord& first = system.Process(poster.Frame(1));
    ASSERT_EQ(first.status, FrameStatus::kTracked) << yaw;
    const RunResult result = system.Finish();
    EXPECT_LT(LogSe3(*first.causal_world_from_camera).norm(), 1e-12);
    const Trajectory final = result.FinalTrajectory(MapId{0});
    ASSERT_EQ(final.size(), 1U);
    EXPECT_LT(LogSe3(final[0].world_from_camera).norm(), 1e-12);
    EXPECT_LT(LogSe3(result.KeyFrameTrajectory(MapId{0})[0].world_from_camera).norm(), 1e-12);
    // Inside, the camera is the rectified one.
    const auto& keyframe = result.atlas.maps().at(MapId{0}).keyframes().begin()->second;
    EXPECT_NEAR(LogSo3(keyframe.frame.cam_from_world.rotation).norm(), yaw, 1e-6);
  }
}

TEST(System, CountsSkippedFramesAndGoesOn) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  const MovingPoster poster;
  for (int i = 0; i < 8; ++i) {
    if (i == 3) {
      const FrameRecord& skipped = system.Skip(MovingPoster::StampNs(i), "image_unreadable");
      EXPECT_EQ(skipped.status, FrameStatus::kSkipped);
      EXPECT_EQ(skipped.reason, "image_unreadable");
      EXPECT_FALSE(skipped.map.valid());
      continue;
    }
    EXPECT_EQ(system.Process(poster.Frame(i)).status, FrameStatus::kTracked) << i;
  }
  EXPECT_THROW(system.Skip(MovingPoster::StampNs(7), "late"), InputError);
  const RunResult result = system.Finish();
  ASSERT_EQ(result.frames.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(result.frames[i].id, FrameId{static_cast<std::int64_t>(i)});
    EXPECT_EQ(result.frames[i].stamp_ns, MovingPoster::StampNs(static_cast<int>(i)));
  }
  EXPECT_EQ(result.FinalTrajectory(MapId{0}).size(), 7U);
}

TEST(System, LostFramesSayWhyAndHaveNoPose) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  const MovingPoster poster;
  for (int i = 0; i < 3; ++i) system.Process(poster.Frame(i));
  const FrameRecord& lost = system.Process(MovingPoster::BlindFrame(3));
  EXPECT_EQ(lost.status, FrameStatus::kLost);
  EXPECT_EQ(lost.reason, "too_few_features");
  EXPECT_FALSE(lost.causal_world_from_camera);
  EXPECT_EQ(system.Process(poster.Frame(4)).status, FrameStatus::kTracked);
  const RunResult result = system.Finish();
  EXPECT_EQ(result.CausalTrajectory(MapId{0}).size(), 4U);
}

// Frames that show nothing say nothing against the map: when the camera sees again, it is looked
// for in the map, however many there were.
TEST(System, ACoveredLensDoesNotEndAMap) {
  const MovingPoster poster;
  for (const auto& covered : {MovingPoster::BlindFrame, MovingPoster::NoiseFrame}) {
    SlamOptions options;
    options.loop.enabled = false;  // or another map would become part of this one
    System system(MovingPoster::MakeCalibration(), options);
    for (int i = 0; i < 10; ++i) system.Process(poster.Frame(i));
    for (int i = 10; i < 40; ++i) {
      EXPECT_EQ(system.Process(covered(i)).reason, "too_few_features") << i;
    }
    int tracked = 0;
    for (int i = 40; i < 52; ++i) {
      tracked += system.Process(poster.Frame(i)).status == FrameStatus::kTracked;
    }
    EXPECT_GE(tracked, 9);
    const RunResult result = system.Finish();
    ASSERT_EQ(result.atlas.maps().size(), 1U);
    const Trajectory poses = result.FinalTrajectory(MapId{0});
    const Eigen::Vector3d expected(51 * MovingPoster::kStep, 0, 0);
    EXPECT_LT((poses.back().world_from_camera.translation - expected).norm(), 0.02);
  }
}

// Longer than relocalization.patience: another map may begin, but the old one is asked first.
TEST(System, AfterALongNightTheOldMapIsAskedFirst) {
  const MovingPoster poster;
  const auto upside_down = [&](int i) {
    SensorFrame frame = poster.Frame(i);
    for (GrayImage* image : {&frame.left, &*frame.right}) {
      for (int y = 0; y < image->height() / 2; ++y) {
        std::swap_ranges(
            image->row(y), image->row(y) + image->width(), image->row(image->height() - 1 - y));
      }
    }
    return frame;
  };
  for (const bool elsewhere : {false, true}) {
    SlamOptions options;
    options.loop.enabled = false;
    options.relocalization.patience = 6;
    System system(MovingPoster::MakeCalibration(), options);
    for (int i = 0; i < 10; ++i) system.Process(poster.Frame(i));
    for (int i = 10; i < 40; ++i) system.Process(MovingPoster::BlindFrame(i));
    for (int i = 40; i < 60; ++i) {
      const FrameRecord& frame = system.Process(elsewhere ? upside_down(i) : poster.Frame(i));
      if (i == 40 && elsewhere) {
        EXPECT_EQ(frame.status, FrameStatus::kLost);
      }
    }
    const RunResult result = system.Finish();
    EXPECT_EQ(result.frames.back().status, FrameStatus::kTracked);
    EXPECT_EQ(result.frames.back().map, MapId{elsewhere ? 1 : 0});
  }
}

TEST(System, IsCompleteWithoutTheAdjustmentThatEndsARun) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  const MovingPoster poster;
  for (int i = 0; i < 8; ++i) system.Process(poster.Frame(i));
  const RunResult result = system.Finish([] { return true; });
  EXPECT_EQ(result.FinalTrajectory(MapId{0}).size(), 8U);
  EXPECT_TRUE(result.LineMap(MapId{0}, [] { return true; }).empty());
  result.atlas.maps().at(MapId{0}).CheckInvariants();
}

TEST(System, RepeatsToTheLastBit) {
  const auto a = RunPoster(8);
  const auto b = RunPoster(8);
  EXPECT_TRUE(SameBits(a.FinalTrajectory(MapId{0}), b.FinalTrajectory(MapId{0})));
  EXPECT_TRUE(SameBits(a.CausalTrajectory(MapId{0}), b.CausalTrajectory(MapId{0})));
  EXPECT_TRUE(SameBits(a.KeyFrameTrajectory(MapId{0}), b.KeyFrameTrajectory(MapId{0})));
}

TEST(System, WithoutATrackedFrameThereIsNoMap) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  EXPECT_EQ(system.Process(MovingPoster::BlindFrame(0)).reason, "too_few_features");
  const RunResult result = system.Finish();
  EXPECT_FALSE(result.MainMap());
  EXPECT_TRUE(result.atlas.maps().empty());
}

TEST(System, RejectsTheLastFrameAsReferenceOfOneCamera) {
  Calibration one_camera = MovingPoster::MakeCalibration();
  one_camera.right.reset();
  SlamOptions options;
  System local_map(one_camera, options);
  options.tracking.reference = TrackingReference::kLastFrame;
  EXPECT_THROW(System(one_camera, options), InputError);
  System stereo(MovingPoster::MakeCalibration(), options);
}

TEST(System, RejectsImagesOfAnotherSize) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  SensorFrame small{0, GrayImage(40, 30), GrayImage(40, 30), {}};
  EXPECT_THROW(system.Process(small), InputError);
  EXPECT_TRUE(system.Finish().frames.empty());
}

TEST(System, RejectsFramesWithoutAnImageOfItsCalibration) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  SensorFrame frame = MovingPoster().Frame(0);
  frame.right.reset();
  EXPECT_THROW(system.Process(frame), InputError);
  Calibration with_depth = MovingPoster::MakeCalibration();
  with_depth.right.reset();
  with_depth.depth_factor = 1000;
  System depth(with_depth, SlamOptions{});
  EXPECT_THROW(depth.Process(frame), InputError);
}

TEST(System, RejectsACalibrationThatNoCameraHas) {
  Calibration calibration = MovingPoster::MakeCalibration();
  CameraIntrinsics metres = calibration.left.intrinsics();
  metres.fx = 0.004;
  calibration.left = Camera(metres);
  EXPECT_THROW(System(calibration, SlamOptions{}), InputError);
}

TEST(System, RejectsMapsThatAreNotThere) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  system.Process(MovingPoster().Frame(0));
  const RunResult result = system.Finish();
  EXPECT_EQ(result.FinalTrajectory(MapId{0}).size(), 1U);
  EXPECT_THROW(result.FinalTrajectory(MapId{7}), InputError);
  EXPECT_THROW(result.KeyFrameTrajectory(MapId{7}), InputError);
  EXPECT_THROW(result.LineMap(MapId{7}), InputError);
}

// Seen by one camera: above, the poster; below, the same at half the distance.
SensorFrame TwoPosters(const MovingPoster& poster, int i) {
  SensorFrame frame{MovingPoster::StampNs(i), poster.Frame(i).left, {}, {}};
  const SensorFrame near = poster.Frame(2 * i);
  for (int y = MovingPoster::kHeight / 2; y < MovingPoster::kHeight; ++y) {
    std::copy_n(near.left.row(y), MovingPoster::kWidth, frame.left.row(y));
  }
  return frame;
}

TEST(System, LocatesFramesOfAYoungMonocularMapAgain) {
  constexpr int kFrames = 40;
  Calibration calibration = MovingPoster::MakeCalibration();
  calibration.right.reset();
  calibration.right_from_left = {};
  System system(calibration, SlamOptions{});
  const MovingPoster poster;
  std::vector<FrameRecord> tracked;
  Trajectory causal;
  for (int i = 0; i < kFrames; ++i) {
    const FrameRecord& record = system.Process(TwoPosters(poster, i));
    if (!record.causal_world_from_camera) continue;
    causal.push_back({record.stamp_ns, *record.causal_world_from_camera});
    if (!record.keyframe) tracked.push_back(record);
  }
  ASSERT_GT(tracked.size(), 5U);
  const RunResult result = system.Finish();
  const FrameRecord& first = tracked.front();
  const FrameRecord& now = result.frames[static_cast<std::size_t>(first.id.value)];
  EXPECT_NE(now.from_reference.cam_from_keyframe.translation,
            first.from_reference.cam_from_keyframe.translation);
  EXPECT_TRUE(SameBits(result.CausalTrajectory(MapId{0}), causal));
  const Trajectory final = result.FinalTrajectory(MapId{0});
  ASSERT_EQ(final.size(), static_cast<std::size_t>(kFrames));
  const double length = final.back().world_from_camera.translation.x() -
                        final.front().world_from_camera.translation.x();
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d moved = final[static_cast<std::size_t>(i)].world_from_camera.translation -
                                  final.front().world_from_camera.translation;
    const Eigen::Vector3d expected(length * i / (kFrames - 1), 0, 0);
    EXPECT_LT((moved - expected).norm(), 0.01 * length) << i;
  }
}

int CountStage(const FrameRecord& record, const std::string& stage) {
  return static_cast<int>(
      std::count_if(record.times.begin(), record.times.end(), [&](const StageTime& time) {
        return time.stage == stage && time.milliseconds > 0;
      }));
}

TEST(System, TimesEveryFrame) {
  const RunResult result = RunPoster(3);
  for (const FrameRecord& record : result.frames) {
    ASSERT_FALSE(record.times.empty());
    EXPECT_EQ(record.times.front().stage, "rectify");
    EXPECT_EQ(CountStage(record, "total"), 1);
    EXPECT_EQ(CountStage(record, "after_keyframe"), 1);
  }
}

TEST(System, TellsThePoseBeforeTheKeyFrameIsHandedOn) {
  const MovingPoster poster;
  System told(MovingPoster::MakeCalibration(), SlamOptions{});
  System whole(MovingPoster::MakeCalibration(), SlamOptions{});
  for (int i = 0; i < 8; ++i) {
    const FrameRecord pose = told.Track(told.Extract(poster.Frame(i)));
    EXPECT_EQ(CountStage(pose, "total"), 1);
    EXPECT_EQ(CountStage(pose, "after_keyframe"), 0);
    const FrameRecord& complete = whole.Process(poster.Frame(i));
    EXPECT_EQ(pose.keyframe, complete.keyframe);
    EXPECT_EQ(pose.causal_world_from_camera->translation,
              complete.causal_world_from_camera->translation);
  }
  const RunResult told_result = told.Finish();
  const RunResult whole_result = whole.Finish();
  EXPECT_EQ(CountStage(told_result.frames[7], "after_keyframe"), 1);
  EXPECT_EQ(told_result.atlas.maps().at(MapId{0}).keyframes().size(),
            whole_result.atlas.maps().at(MapId{0}).keyframes().size());
}

TEST(System, CountsWhatIsDoneAtTheEndWithTheLastFrame) {
  const RunResult result = RunPoster(3);
  EXPECT_EQ(CountStage(result.frames[1], "map_finish_outliers"), 0);
  EXPECT_GT(CountStage(result.frames[2], "map_finish_outliers"), 0);
}

}  // namespace system_test
}  // namespace plumbline
