// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/run_frames.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/features/stereo_pair_check.h"
#include "plumbline/image/filters.h"
#include "plumbline/matching/still_features.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/pipeline.h"
#include "plumbline/viewer/viewer.h"

#include "apps/inertial_input.h"
#include "apps/map_saver.h"
#include "apps/program_methods.h"
#include "apps/progress.h"
#include "apps/shortage.h"
#include "apps/stop_signal.h"
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOverlays = 6;
constexpr auto kPauseStep = std::chrono::milliseconds(10);
// A depth camera may need some images until it measures.
constexpr int kManyWithoutDepth = 10;

// Every image of the frame through the box filter of --blur (0: as it is). Depth stays.
SensorFrame Blurred(SensorFrame frame, int size) {
  if (size <= 1) return frame;
  frame.left = BoxFiltered(frame.left, size);
  if (frame.right) frame.right = BoxFiltered(*frame.right, size);
  return frame;
}

bool HasAnyDepth(const DepthImage& depth) {
  for (int y = 0; y < depth.height(); ++y) {
    const auto* row = depth.row(y);
    if (std::any_of(row, row + depth.width(), [](auto value) { return value != 0; })) return true;
  }
  return false;
}

std::unique_ptr<FrameInput> OpenFrames(const RunFrames& input, RunMode mode, FrameInput::Say say) {
  if (input.live != nullptr) {
    return std::make_unique<LiveInput>(input.live, input.range, std::move(say));
  }
  return std::make_unique<RecordedInput>(input.dataset, input.frames, mode, std::move(say));
}

// The work of one run.
class FrameFeed {
 public:
  FrameFeed(const RunFrames& input, bool quiet, System& system, RunFolder& folder, KeptViews& views)
      : input_(input),
        quiet_(quiet),
        system_(system),
        folder_(folder),
        views_(views),
        progress_(input.live != nullptr ? std::nullopt : std::optional(input.frames.size()), quiet),
        saver_(input.save_every_s > 0
                   ? std::make_shared<MapSaver>(folder.part() / "map.plb",
                                                ProgramMethods().Lines(system.options().lines))
                   : nullptr),
        frames_(OpenFrames(input,
                           system.options().slam.mode,
                           [this](const std::string& message) { progress_.Say(message); })),
        pair_check_(system.rectifier()),
        pipeline_(system, [this](const FrameRecord& record, const FrameView& view) {
          Observe(record, view);
        }) {}

  Processed Run() {
    Report(journal_.Write(folder_));
    Keeping([&] { Feed(); });
    Keeping([&] { pipeline_.Drain(); });
    progress_.End();
    NameShortage();
    if (result_.failure && frames_done_ == 0) std::rethrow_exception(result_.failure);
    if (frames_done_ > 0) folder_.Keep();
    Keeping([&] { Report(journal_.Write(folder_)); });
    const bool stopped = SayStopped();
    std::exception_ptr failure;
    result_.result = Adjust(&failure);
    if (!stopped) SayCutShort();
    Keeping([&] {
      if (failure) std::rethrow_exception(failure);
    });
    NameShortage();
    TellBlackMasks();
    TellStillFeatures();
    TellInertial();
    Keeping([&] { FinishViewing(); });
    return std::move(result_);
  }

 private:
  // In the thread that tracks.
  void Observe(const FrameRecord& record, const FrameView& view) {
    const auto position = static_cast<std::size_t>(record.id.value);
    frames_done_ = position + 1;
    if (record.shed == LoadLevel::kFrame) {
      progress_.Say(fmt::format("frame {} dropped: tracking is behind", position));
    }
    if (record.reason == Pipeline::kBlackMask) ++black_masks_;
    if (!result_.first_pose_seconds && record.status == FrameStatus::kTracked) {
      result_.first_pose_seconds = SecondsSinceProcessStart();
    }
    journal_.Add(record);
    SaveMapIfDue();
    views_.Offer(position, view);
    WatchStillFeatures(position, record, view);
    progress_.Show(record);
    if (!input_.viewer) return;
    input_.viewer->Show(record, view, system_.EventsSince(events_shown_).relocalizations);
    ShowMaps(record.keyframe);
    Report(input_.viewer->TakeFailure());
  }

  RunResult Adjust(std::exception_ptr* failure) {
    AdjustmentProgress progress{ProgressLine(quiet_)};
    return pipeline_.Finish(
        [&, stop = StepStop()] {
          progress.Show();
          return stop();
        },
        failure);
  }

  // In the thread that tracks, which only asks for a copy of the maps.
  void SaveMapIfDue() {
    if (!saver_) return;
    const auto now = Clock::now();
    if (now - saved_ < std::chrono::seconds(input_.save_every_s)) return;
    saved_ = now;
    system_.ReadMaps([saver = saver_](const CurrentMaps& maps) { saver->Take(maps.copy()); });
    Report(saver_->TakeFailure());
  }

  // In the thread that tracks, which only asks for a look at the maps.
  void ShowMaps(bool new_keyframe) {
    if (!input_.viewer->WantsMaps(new_keyframe)) return;
    system_.ReadMaps([viewer = input_.viewer](const CurrentMaps& maps) {
      viewer->ReadMaps(maps.atlas, maps.events);
    });
  }

  void FinishViewing() {
    if (!input_.viewer) return;
    input_.viewer->Finish(result_.result.atlas, result_.result.events);
    Report(input_.viewer->TakeFailure());
    result_.not_recorded = input_.viewer->RecordingFailure();
  }

  // In the feeding thread: waits while a viewer has paused the run. Requests about the maps are
  // answered meanwhile.
  void WaitWhilePaused() {
    if (!input_.viewer || !input_.viewer->HoldsBack()) return;
    const auto start = Clock::now();
    pipeline_.Drain();
    do {
      std::this_thread::sleep_for(kPauseStep);
      ShowMaps(false);
      if (system_.options().slam.mode == RunMode::kInline) system_.MapOnce();
    } while (input_.viewer->HoldsBack() && GoOn());
    frames_->Delay(Clock::now() - start);
  }

  void Report(const std::optional<std::string>& failure) const {
    if (failure) progress_.Say(*failure + "; the run goes on");
  }

  bool GoOn() {
    Report(journal_.WriteIfDue(folder_));
    return !StopRequested();
  }

  void Feed() {
    const auto go_on = [this] { return GoOn(); };
    for (std::size_t position = 0;; ++position) {
      WaitWhilePaused();
      auto next = frames_->Next(go_on);
      if (!next) return;
      inertial_.Add(next->inertial);
      pipeline_.AddInertial(inertial_.UpTo(next->stamp_ns));
      if (next->frame) {
        CheckPair(position, *next->frame);
        WatchDepth(*next->frame);
        pipeline_.Feed(Blurred(*std::move(next->frame), input_.blur));
      } else {
        pipeline_.Skip(next->stamp_ns, next->reason);
      }
    }
  }

  // In the thread that feeds. Tells of a stereo pair that does not fit the calibration, once.
  void CheckPair(std::size_t position, const SensorFrame& frame) {
    const auto fault = pair_check_.Add(position, frame);
    if (!fault) return;
    result_.notes.push_back(Describe(*fault));
    if (!quiet_) progress_.Say(result_.notes.back());
  }

  // Tells of a depth camera that measures nothing, as long as no image has any depth.
  void WatchDepth(const SensorFrame& frame) {
    if (!frame.depth || (without_depth_ > 0 && !result_.no_depth)) return;
    result_.no_depth = !HasAnyDepth(*frame.depth);
    ++without_depth_;
    if (result_.no_depth && without_depth_ == kManyWithoutDepth) {
      progress_.Say(
          fmt::format("depth is zero everywhere in the first {} depth images: without "
                      "depth no map begins",
                      without_depth_));
    }
  }

  // In the thread that tracks. Text may keep a map from beginning, or spoil it: frames without a
  // pose tell of it, too.
  void WatchStillFeatures(std::size_t position, const FrameRecord& record, const FrameView& view) {
    constexpr std::size_t kStride = 4;  // frames; compared are those about a second apart
    if (record.status == FrameStatus::kTracked) still_.Restart();
    if (position % kStride != 0 || !view.frame.indexed) return;
    if (record.status == FrameStatus::kTracked) return;
    still_.Add(MeasuredFeatures(*view.frame.indexed).points);
  }

  void TellBlackMasks() {
    if (black_masks_ == 0) return;
    Tell(
        fmt::format("{} left out, since their masks are all black: are these inverted? What is "
                    "black is not used",
                    Counted(black_masks_, "frame")));
  }

  // Tells of text or a part of the robot in the images.
  void TellStillFeatures() {
    std::optional<std::string> note = StillFeaturesNote(still_.Result());
    for (const auto& [id, map] : result_.result.atlas.maps()) {
      if (!note) note = StillFeaturesNote(FindStillFeatures(map));
    }
    if (note) Tell(*note);
  }

  void Tell(const std::string& note) {
    result_.notes.push_back(note);
    if (!quiet_) progress_.Say(note);
  }

  void TellInertial() {
    if (input_.inertial == nullptr) return;
    UnusableSamples unusable;  // of what was read before the run, they are told
    if (!input_.inertial->complete) unusable = inertial_.unusable();
    if (input_.live != nullptr) unusable = input_.live->UnusableInertial();
    for (std::string& note : InertialNotes(result_.result, *input_.inertial, inertial_, unusable)) {
      if (!quiet_) progress_.Say(note);
      result_.notes.push_back(std::move(note));
    }
  }

  // "12 of 30 frames", or "12 frames" of a live source.
  std::string HowFar() const {
    if (input_.live != nullptr) return fmt::format("{} frames", frames_done_);
    return fmt::format("{} of {} frames", frames_done_, input_.frames.size());
  }

  // Keeps the first failure.
  template <class Step>
  void Keeping(const Step& step) {
    try {
      step();
    } catch (const std::exception& error) {
      if (result_.failure) return;
      result_.failure = std::current_exception();
      shortage_ = ShortageOf(error);
    }
  }

  // Converts a shortage of the machine to an InputError, once no more frames are on their way.
  void NameShortage() {
    if (shortage_ == nullptr) return;
    result_.failure =
        std::make_exception_ptr(InputError(fmt::format("{} after {}", shortage_, HowFar())));
    shortage_ = nullptr;
  }

  // Returns true if a signal came before the end.
  bool SayStopped() const {
    const auto signal = FirstStopSignal();
    if (!signal) return false;
    if (!quiet_) {
      progress_.Say(
          fmt::format("{} after {}: finishing (once more: at once)", signal->name, HowFar()));
    }
    return true;
  }

  void SayCutShort() const {
    const auto signal = FirstStopSignal();
    if (!signal || quiet_) return;
    progress_.Say(
        fmt::format("{} at the end: poses of frames before the map, and the adjustment "
                    "of the whole map, may be missing",
                    signal->name));
  }

  const RunFrames& input_;
  bool quiet_;
  System& system_;
  RunFolder& folder_;
  KeptViews& views_;
  Processed result_;
  // The tracking thread's until it ends.
  std::size_t frames_done_ = 0;
  std::size_t black_masks_ = 0;  // frames left out for them
  MapEventCounts events_shown_;
  StillFeatureFinder still_;        // of the frames without a pose
  int without_depth_ = 0;           // depth images that were looked at
  const char* shortage_ = nullptr;  // that result_.failure is about, while it has no name
  Progress progress_;
  RunJournal journal_;
  std::shared_ptr<MapSaver> saver_;  // null if nothing is saved before the end
  Clock::time_point saved_ = Clock::now();
  std::unique_ptr<FrameInput> frames_;
  StereoPairCheck pair_check_;
  InertialFeed inertial_{input_.inertial.get()};
  Pipeline pipeline_;  // last: its thread calls Observe
};

}  // namespace

KeptViews::KeptViews(const RunFrames& input) {
  live_ = input.live != nullptr;
  const std::size_t frames = input.frames.size();
  if (frames == 0) return;
  for (std::size_t k = 0; k < kOverlays; ++k) {
    wanted_.insert(k * (frames - 1) / (kOverlays - 1));
  }
}

void KeptViews::Offer(std::size_t position, const FrameView& view) {
  if (view.images.left.empty()) return;
  if (live_) return OfferOfMany(position, view);
  if (wanted_.contains(position)) views_.emplace_back(position, view);
}

void KeptViews::OfferOfMany(std::size_t position, const FrameView& view) {
  if (position % every_ != 0) return;
  views_.emplace_back(position, view);
  if (views_.size() <= kOverlays) return;
  every_ *= 2;
  std::erase_if(views_, [this](const auto& kept) { return kept.first % every_ != 0; });
}

Processed ProcessFrames(
    const RunFrames& input, bool quiet, System& system, RunFolder& folder, KeptViews& views) {
  return FrameFeed(input, quiet, system, folder, views).Run();
}

}  // namespace plumbline
