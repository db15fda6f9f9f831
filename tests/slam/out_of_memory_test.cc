// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// What is left when memory runs out at any place. This executable has its own operator new.
#include "plumbline/map/byte_format.h"
#include "plumbline/map/map.h"
#include "plumbline/slam/system.h"

#include "tests/map/map_fixture.h"
#include "tests/support/moving_poster.h"
#include <atomic>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

// Allocations until one fails; below 0: none does.
std::atomic<std::int64_t> left{-1};
std::atomic<std::int64_t> done{0};

void* Allocate(std::size_t bytes, std::size_t alignment) {
  ++done;
  if (left >= 0 && left-- == 0) throw std::bad_alloc();
  const std::size_t size = (bytes + alignment) / alignment * alignment;
  void* found = std::aligned_alloc(alignment, size);
  if (found == nullptr) throw std::bad_alloc();
  return found;
}

}  // namespace

void* operator new(std::size_t bytes) { return Allocate(bytes, 16); }
void* operator new[](std::size_t bytes) { return Allocate(bytes, 16); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return Allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete[](void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t) noexcept { std::free(place); }
void operator delete[](void* place, std::size_t) noexcept { std::free(place); }
void operator delete(void* place, std::align_val_t) noexcept { std::free(place); }
void operator delete(void* place, std::size_t, std::align_val_t) noexcept { std::free(place); }

namespace plumbline {
namespace {

// Calls step() with an allocation number `fail` (from 0) that fails. Returns whether it got so far.
bool FailsAt(std::int64_t fail, const std::function<void()>& step) {
  left = fail;
  try {
    step();
  } catch (const std::bad_alloc&) {
    left = -1;
    return true;
  } catch (...) {
    left = -1;
    throw;
  }
  left = -1;
  return false;
}

template <class Landmark>
void Describe(const Landmark& landmark, ByteWriter& bytes) {
  TransferAll(bytes, landmark.id, landmark.score.visible, landmark.score.found);
  for (const auto& [keyframe, feature] : landmark.observations) {
    TransferAll(bytes, keyframe, feature);
  }
}

// All of a map that edits change.
std::string Contents(const Map& map) {
  ByteWriter bytes;
  const MapRecord record = map.Record();
  Transfer(bytes, record);
  for (const auto& [id, keyframe] : map.keyframes()) {
    TransferAll(bytes, id, keyframe.parent, keyframe.number, keyframe.scale);
    TransferAll(bytes, keyframe.frame.points, keyframe.frame.lines, keyframe.frame.cam_from_world);
  }
  for (const auto& [id, point] : map.points()) {
    Describe(point, bytes);
    TransferAll(bytes, point.position);
  }
  for (const auto& [id, line] : map.lines()) {
    Describe(line, bytes);
    TransferAll(bytes, line.line.moment, line.line.direction, line.start, line.end);
  }
  return bytes.Take();
}

Map SmallMap() {
  Map map = ChainOfKeyFrames(5);
  MapEdit edit;
  for (std::int64_t id = 0; id < 4; ++id) {
    edit.push_back(edit::AddPoint{PointSeenBy(id, SeenBy(0, 4, static_cast<int>(id)))});
    edit.push_back(edit::AddLine{LineSeenBy(id, SeenBy(1, 3, static_cast<int>(id)))});
  }
  map.Apply(edit);
  map.Apply({edit::RemoveKeyFrame{KeyFrameId{3}}});
  return map;
}

// One change of each kind that makes, moves or removes anything.
MapEdit EditOfAllKinds() {
  KeyFrame keyframe = BlankKeyFrame(5, 4);
  keyframe.frame.points[7] = PointId{1};
  keyframe.frame.lines[7] = LineId{1};
  edit::MoveKeyFrames motion;
  motion.new_from_old.emplace(KeyFrameId{2}, Similarity3{});
  FeatureCorrection correction;
  return {edit::ScorePoint{PointId{0}, 3, 2},
          edit::AddKeyFrame{keyframe},
          edit::AddPoint{PointSeenBy(4, SeenBy(0, 2, 9))},
          edit::AddLine{LineSeenBy(4, SeenBy(0, 2, 9))},
          edit::AddPointObservation{PointId{3}, KeyFrameId{5}, 12},
          edit::MergePoints{PointId{0}, PointId{2}},
          edit::MergeLines{LineId{0}, LineId{2}},
          edit::RemovePoint{PointId{3}},
          edit::RemoveLineObservation{LineId{3}, KeyFrameId{1}},
          edit::MovePoint{PointId{1}, {1, 2, 3}},
          edit::SetPose{KeyFrameId{1}, {}},
          edit::MoveKeyFrames{motion},
          edit::CorrectFeatures{correction},
          edit::RemoveKeyFrame{KeyFrameId{2}},
          edit::RefreshPoint{PointId{1}},
          edit::RefreshLine{LineId{1}}};
}

TEST(OutOfMemory, AnEditHappensWholeOrNotAtAll) {
  const MapEdit edit = EditOfAllKinds();
  Map changed = SmallMap();
  const std::string before = Contents(changed);
  changed.Apply(edit);
  const std::string after = Contents(changed);
  ASSERT_NE(before, after);
  Map map = SmallMap();
  const auto token = map.token();
  std::int64_t fail = 0;
  while (FailsAt(fail, [&] { map.Apply(edit); })) {
    ASSERT_EQ(Contents(map), before) << fail;
    map.CheckInvariants();
    ++fail;
  }
  EXPECT_GT(fail, 50);
  EXPECT_EQ(Contents(map), after);
  EXPECT_EQ(map.token(), token);
  map.CheckInvariants();
}

// Others that share the entries keep them.
TEST(OutOfMemory, CopiesOfAMapDoNotSeeAnEditThatFailed) {
  Map map = SmallMap();
  const Map copy = map;
  const std::string before = Contents(copy);
  std::int64_t fail = 0;
  while (FailsAt(fail++, [&] { map.Apply(EditOfAllKinds()); })) {
    ASSERT_EQ(Contents(map), before) << fail;
    ASSERT_EQ(Contents(copy), before) << fail;
  }
  EXPECT_EQ(Contents(copy), before);
}

TEST(OutOfMemory, TwoMapsAreJoinedWhollyOrNotAtAll) {
  const auto make = [] {
    Atlas atlas;
    for (std::int64_t first : {0, 10}) {
      Map& map = atlas.Start();
      for (std::int64_t id = first; id < first + 3; ++id) {
        map.Apply({edit::AddKeyFrame{BlankKeyFrame(id, id == first ? -1 : id - 1)}});
      }
      map.Apply({edit::AddPoint{PointSeenBy(first, SeenBy(first, first + 2, 1))},
                 edit::RemoveKeyFrame{KeyFrameId{first + 1}}});
    }
    return atlas;
  };
  const auto contents = [](const Atlas& atlas) {
    std::string all = std::to_string(atlas.active_id().value);
    for (const auto& [id, map] : atlas.maps()) all += Contents(map);
    return all + std::to_string(atlas.joined().size());
  };
  Atlas atlas = make();
  const std::string before = contents(atlas);
  std::int64_t fail = 0;
  while (FailsAt(fail, [&] { atlas.Join(MapId{0}, MapId{1}, Similarity3{}); })) {
    ASSERT_EQ(contents(atlas), before) << fail;
    ++fail;
  }
  EXPECT_GT(fail, 10);
  EXPECT_EQ(atlas.maps().size(), 1U);
  EXPECT_EQ(atlas.Current(MapId{1}), MapId{0});
  EXPECT_EQ(atlas.active().keyframes().size(), 4U);
  atlas.active().CheckInvariants();
}

// A run over frames whose features are extracted already; the features are not at stake.
class SmallRun {
 public:
  static constexpr int kFrames = 9;

  SmallRun() {
    SlamOptions options;
    options.slam.mode = RunMode::kInline;
    options.tracking.keyframes.max_frames = 3;
    system_ = std::make_unique<System>(MovingPoster::MakeCalibration(), options);
  }

  // Stops at the first failure, and completes what there is.
  void Go(const std::vector<ExtractedFrame>& frames) {
    try {
      for (const ExtractedFrame& frame : frames) {
        system_->Track(ExtractedFrame(frame));
        ++tracked_;
        system_->Complete();
      }
    } catch (const std::bad_alloc&) {
      failed_ = true;
    }
    std::exception_ptr failure;
    result_ = system_->Finish({}, &failure);
    failed_ = failed_ || failure;
  }

  const System& system() const { return *system_; }
  const RunResult& result() const { return result_; }
  bool failed() const { return failed_; }
  int tracked() const { return tracked_; }

 private:
  std::unique_ptr<System> system_;
  RunResult result_;
  bool failed_ = false;
  int tracked_ = 0;
};

TEST(OutOfMemory, ARunKeepsWhatItReported) {
  std::vector<ExtractedFrame> frames;
  {
    const SmallRun run;
    const MovingPoster poster;
    for (int i = 0; i < SmallRun::kFrames; ++i)
      frames.push_back(run.system().Extract(poster.Frame(i)));
  }
  SmallRun whole;
  const std::int64_t before = done;
  whole.Go(frames);
  const std::int64_t allocations = done - before;
  ASSERT_EQ(whole.result().FinalTrajectory(MapId{0}).size(), frames.size());
  constexpr int kRuns = 150;
  for (int k = 0; k < kRuns; ++k) {
    SmallRun run;
    left = allocations * k / kRuns + k % 7;
    run.Go(frames);
    left = -1;
    ASSERT_TRUE(run.failed()) << k;
    const RunResult& result = run.result();
    std::size_t placed = 0, poses = 0;
    for (const FrameRecord& frame : result.frames) {
      placed += frame.status == FrameStatus::kTracked;
    }
    for (const auto& [id, map] : result.atlas.maps()) {
      map.CheckInvariants();
      EXPECT_FALSE(map.keyframes().empty()) << k;
      poses += result.FinalTrajectory(id).size();
    }
    EXPECT_EQ(poses, placed) << k;
    // A keyframe that was not handed to mapping is lost, or the start of the map.
    EXPECT_GE(static_cast<int>(poses), run.tracked() - (result.atlas.maps().empty() ? 2 : 1)) << k;
  }
}

}  // namespace
}  // namespace plumbline
