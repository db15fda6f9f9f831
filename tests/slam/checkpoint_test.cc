// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Runs that stop in the middle and go on: System::Save and System::Resume.
#include "plumbline/base/error.h"
#include "plumbline/base/random.h"
#include "plumbline/io/checkpoint_io.h"
#include "plumbline/io/map_io.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/byte_format.h"
#include "plumbline/slam/system.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/moving_poster.h"
#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// Something to run over.
struct Recording {
  Calibration calibration = MovingPoster::MakeCalibration();
  std::function<SensorFrame(int)> frame;
  int frames = 0;
};

// A stereo camera before a poster; from frame 30 on it sees another place for a while, then another
// part of the poster.
Recording StereoWithALoss() {
  Recording recording;
  recording.frames = 56;
  recording.frame = [poster = std::make_shared<MovingPoster>()](int i) {
    return i >= 30 && i < 36 ? MovingPoster::StrangeFrame(i) : poster->Frame(i);
  };
  return recording;
}

Recording RgbdPoster() {
  Recording recording;
  recording.calibration.right.reset();
  recording.calibration.depth_factor = 1000;
  recording.frames = 30;
  recording.frame = [poster = std::make_shared<MovingPoster>()](int i) {
    SensorFrame frame = poster->Frame(i);
    frame.right.reset();
    frame.depth = DepthImage(
        MovingPoster::kWidth, MovingPoster::kHeight, static_cast<float>(MovingPoster::kDepth));
    return frame;
  };
  return recording;
}

// One camera that goes sideways before bands of the poster at two distances. It sees another
// place for three frames, after which there is a second map.
Recording MonoBands() {
  Recording recording;
  recording.calibration.right.reset();
  recording.frames = 46;
  recording.frame = [poster = std::make_shared<MovingPoster>()](int i) {
    if (i >= 26 && i < 29) {
      SensorFrame strange = MovingPoster::StrangeFrame(i);
      strange.right.reset();
      return strange;
    }
    SensorFrame frame = poster->Frame(i);
    frame.right.reset();
    const GrayImage near = poster->Frame(2 * i).left;
    constexpr int kBand = 50;
    for (int y = 0; y < MovingPoster::kHeight; ++y) {
      if (y / kBand % 2 == 0) continue;
      std::copy_n(near.row(MovingPoster::kHeight - 1 - y), MovingPoster::kWidth, frame.left.row(y));
    }
    return frame;
  };
  return recording;
}

SlamOptions InMode(RunMode mode, int lag = 1) {
  SlamOptions options;
  options.slam.mode = mode;
  options.slam.lag = lag;
  options.tracking.new_map_after = 3;
  options.tracking.keyframes.max_frames = 3;  // many of them
  return options;
}

// All results of a run that may not depend on anything but input, options and seed.
std::string ResultsOf(System& system) {
  system.Finish();
  ByteWriter results;
  for (FrameRecord record : system.frames()) {
    record.times.clear();
    Transfer(results, record);
  }
  const ScratchFolder folder;
  SaveAtlas(folder / "m.plb", system.atlas(), system.Context());
  return results.Take() + Contents(folder / "m.plb");
}

// Runs from frame `first` on; what the run saved before frame k is in saved[k] for the keys that it
// has.
std::string RunFrom(int first,
                    const Recording& recording,
                    System& system,
                    std::map<int, SavedRun>* saved = nullptr) {
  for (int i = first; i < recording.frames; ++i) {
    if (saved != nullptr && saved->contains(i)) saved->at(i) = system.Save();
    system.Process(recording.frame(i));
  }
  return ResultsOf(system);
}

std::string WholeRun(const Recording& recording,
                     const SlamOptions& options,
                     std::map<int, SavedRun>* saved = nullptr) {
  System system(recording.calibration, options);
  return RunFrom(0, recording, system, saved);
}

// By way of a file.
SavedRun Written(const SavedRun& run) {
  const ScratchFolder folder;
  SaveCheckpoint(folder / "c.plbrun", run);
  const std::string bytes = Contents(folder / "c.plbrun");
  SavedRun loaded = LoadCheckpoint(folder / "c.plbrun");
  SaveCheckpoint(folder / "c.plbrun", loaded);
  EXPECT_TRUE(Contents(folder / "c.plbrun") == bytes) << "saved again it has other bytes";
  return loaded;
}

// Frames before which a run is to be saved.
std::map<int, SavedRun> At(const std::vector<int>& frames) {
  std::map<int, SavedRun> saved;
  for (const int frame : frames) saved[frame];
  return saved;
}

void ExpectToGoOnAsIfNothingHadBeen(const Recording& recording,
                                    const std::vector<int>& pauses,
                                    int lag = 1) {
  for (const RunMode mode : {RunMode::kInline, RunMode::kLockstep}) {
    const SlamOptions options = InMode(mode, lag);
    const std::string expected = WholeRun(recording, options);
    std::map<int, SavedRun> saved = At(pauses);
    EXPECT_TRUE(WholeRun(recording, options, &saved) == expected) << "saving changed the run";
    for (const auto& [frame, run] : saved) {
      System system(recording.calibration, options);
      system.Resume(Written(run));
      EXPECT_EQ(system.frames().size(), static_cast<std::size_t>(frame));
      EXPECT_TRUE(RunFrom(frame, recording, system) == expected)
          << NameOf(mode) << ", paused before frame " << frame;
    }
  }
}

std::map<std::string, int> CountStatuses(const Recording& recording) {
  System system(recording.calibration, InMode(RunMode::kInline));
  std::map<std::string, int> counts;
  for (int i = 0; i < recording.frames; ++i) {
    ++counts[NameOf(system.Process(recording.frame(i)).status)];
  }
  counts["maps"] = static_cast<int>(system.maps().size());
  return counts;
}

TEST(Checkpoint, OfStereoGoesOnAsIfNothingHadBeen) {
  const Recording recording = StereoWithALoss();
  // At the beginning, after keyframes, while lost, after that.
  ExpectToGoOnAsIfNothingHadBeen(recording, {0, 5, 31, 38});
  EXPECT_GT(CountStatuses(recording)["lost"], 0);
}

TEST(Checkpoint, WithKeyFramesThatAreNotDueYet) {
  ExpectToGoOnAsIfNothingHadBeen(StereoWithALoss(), {9, 37}, 6);
}

TEST(Checkpoint, OfDepthImagesGoesOnAsIfNothingHadBeen) {
  ExpectToGoOnAsIfNothingHadBeen(RgbdPoster(), {3, 12});
}

TEST(Checkpoint, OfOneCameraGoesOnAsIfNothingHadBeen) {
  const Recording recording = MonoBands();
  // Before there is a map, while it is young, while lost, in the second map.
  ExpectToGoOnAsIfNothingHadBeen(recording, {4, 9, 27, 42});
  auto counts = CountStatuses(recording);
  EXPECT_GT(counts["initializing"], 2);
  EXPECT_GT(counts["lost"], 2);
  EXPECT_GT(counts["tracked"], 15);
  EXPECT_EQ(counts["maps"], 2);
}

TEST(Checkpoint, OfEveryStartOfAMapGoesOnAsIfNothingHadBeen) {
  const Recording recording = MonoBands();
  using enum InitializationMethod;
  for (const auto method : {kTwoView, kTwoViewImages, kRank1Klt}) {
    SlamOptions options = InMode(RunMode::kInline);
    options.initialization.method = method;
    std::map<int, SavedRun> saved = At({2, 4, 30});
    const std::string expected = WholeRun(recording, options, &saved);
    for (const auto& [frame, run] : saved) {
      System system(recording.calibration, options);
      system.Resume(run);
      EXPECT_TRUE(RunFrom(frame, recording, system) == expected) << NameOf(method) << frame;
    }
  }
}

// A camera that sees another place until a second map begins, which is then known to show the
// first.
Recording StereoWithAJoin() {
  Recording recording;
  recording.frames = 58;
  recording.frame = [poster = std::make_shared<MovingPoster>()](int i) {
    return i >= 20 && i < 40 ? MovingPoster::StrangeFrame(i) : poster->Frame(i);
  };
  return recording;
}

TEST(Checkpoint, OfMapsThatWereJoinedGoesOnAsIfNothingHadBeen) {
  const Recording recording = StereoWithAJoin();
  System whole(recording.calibration, InMode(RunMode::kInline));
  RunFrom(0, recording, whole);
  ASSERT_EQ(whole.events().joins.size(), 1U);
  ExpectToGoOnAsIfNothingHadBeen(recording, {57});
}

TEST(Checkpoint, OfOneDeterministicModeServesTheOther) {
  const Recording recording = StereoWithALoss();
  std::map<int, SavedRun> saved = At({14});
  const std::string expected = WholeRun(recording, InMode(RunMode::kInline), &saved);
  System system(recording.calibration, InMode(RunMode::kLockstep));
  system.Resume(saved.at(14));
  EXPECT_TRUE(RunFrom(14, recording, system) == expected);
}

TEST(Checkpoint, OfARunInALoadedMapGoesOnAsIfNothingHadBeen) {
  const Recording recording = StereoWithALoss();
  System first(recording.calibration, InMode(RunMode::kInline));
  for (int i = 0; i < 20; ++i) first.Process(recording.frame(i));
  first.Finish();
  const SavedAtlas map{first.atlas(), first.Context()};
  for (const bool read_only : {false, true}) {
    const auto run = [&](std::map<int, SavedRun>* saved) {
      System system(recording.calibration, InMode(RunMode::kInline));
      system.Continue(map, read_only);
      return RunFrom(0, recording, system, saved);
    };
    const std::string expected = run(nullptr);
    std::map<int, SavedRun> saved = At({1, 8, 33});
    EXPECT_TRUE(run(&saved) == expected);
    for (const auto& [frame, checkpoint] : saved) {
      System system(recording.calibration, InMode(RunMode::kInline));
      system.Resume(Written(checkpoint));
      EXPECT_EQ(system.read_only(), read_only);
      EXPECT_TRUE(RunFrom(frame, recording, system) == expected) << frame << read_only;
    }
  }
}

TEST(Checkpoint, OfALiveRunGoesOnTracking) {
  const Recording recording = StereoWithALoss();
  SlamOptions options = InMode(RunMode::kLive);
  System before(recording.calibration, options);
  for (int i = 0; i < 12; ++i) before.Process(recording.frame(i));
  const SavedRun saved = Written(before.Save());
  System system(recording.calibration, options);
  system.Resume(saved);
  for (int i = 12; i < 28; ++i) {
    EXPECT_EQ(system.Process(recording.frame(i)).status, FrameStatus::kTracked) << i;
  }
  system.Finish();
  EXPECT_EQ(system.FinalTrajectory(MapId{0}).size(), 28U);
}

// One for the tests that only look at refusals.
const SavedRun& SomeRun() {
  static const SavedRun run = [] {
    std::map<int, SavedRun> saved = At({33});
    WholeRun(StereoWithALoss(), InMode(RunMode::kInline), &saved);
    return saved.at(33);
  }();
  return run;
}

void ExpectRefused(System& system, const SavedRun& run, const std::string& why) {
  try {
    system.Resume(run);
    FAIL() << why;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
  }
}

TEST(Checkpoint, IsOfTheSameOptionsAndTheSameRig) {
  const SavedRun& run = SomeRun();
  SlamOptions other = InMode(RunMode::kInline);
  other.slam.seed = 3;
  System of_other_seed(MovingPoster::MakeCalibration(), other);
  ExpectRefused(of_other_seed, run, "slam.seed: expected 0 as in the checkpoint, found 3");
  Calibration wider = MovingPoster::MakeCalibration();
  wider.right_from_left.translation *= 1.5;
  System of_other_rig(wider, InMode(RunMode::kInline));
  ExpectRefused(
      of_other_rig, run, "expected a checkpoint of the same rectified camera, found a baseline");
}

// Changes bytes of the state of a run; returns how often that is refused.
int CountRefused(const SavedRun& run, const Recording& recording) {
  Rng rng(5, "changed_bytes");
  int refused = 0;
  for (int k = 0; k < 300; ++k) {
    SavedRun changed = run;
    // The beginning has most of what is not a measurement.
    const std::size_t size = k % 2 == 0 ? changed.state.size() : std::size_t{4000};
    changed.state[rng.Index(size)] ^= static_cast<char>(1 + rng.Index(255));
    System system(recording.calibration, InMode(RunMode::kInline));
    try {
      system.Resume(std::move(changed));
    } catch (const InputError&) {
      ++refused;
    }
  }
  return refused;
}

TEST(Checkpoint, WithAnyByteOfItsStateChangedIsRefusedOrServes) {
  EXPECT_GT(CountRefused(SomeRun(), StereoWithALoss()), 5);
  const Recording mono = MonoBands();
  System waiting(mono.calibration, InMode(RunMode::kInline));
  for (int i = 0; i < 3; ++i) waiting.Process(mono.frame(i));
  EXPECT_GT(CountRefused(waiting.Save(), mono), 10);
}

TEST(Checkpoint, WithAStateThatIsCutShortIsRefused) {
  for (const double share : {0.0, 0.001, 0.3, 0.9, 0.9999}) {
    SavedRun cut = SomeRun();
    cut.state.resize(static_cast<std::size_t>(share * static_cast<double>(cut.state.size())));
    System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
    ExpectRefused(system, cut, "state of the run: ends early");
  }
  SavedRun longer = SomeRun();
  longer.state += '\0';
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  ExpectRefused(system, longer, "more bytes");
}

TEST(Checkpoint, OfOtherMapsIsRefused) {
  SavedRun none = SomeRun();
  none.maps.atlas = Atlas();
  none.maps.context.maps.clear();
  System system(MovingPoster::MakeCalibration(), InMode(RunMode::kInline));
  ExpectRefused(system, none, "expected one that agrees with itself, found a frame without its");
}

}  // namespace
}  // namespace plumbline
