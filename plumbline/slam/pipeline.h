// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/load_control.h"
#include "plumbline/slam/system.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace plumbline {

// Feeds frames to a System in the way its slam.mode says.
//
//   inline    Feed does everything, in the caller's thread.
//   lockstep  Feed measures features in the caller's thread and leaves tracking to another one,
//             which is at most two frames behind; when it is, Feed waits. The bytes
//             are those of inline.
//   live      Feed only hands the frame over. Two frames may wait; one more, and the oldest of
//             them is left out (FrameStatus::kSkipped, reason kDropped). Where frames have to wait,
//             less is done for them (LoadControl), which their records tell. Not reproducible.
//
// A live run:
//
//   options.slam.mode = RunMode::kLive;
//   System system(calibration, options);
//   Pipeline pipeline(system, [](const FrameRecord& record, const FrameView&) { Show(record); });
//   while (camera.IsOn()) pipeline.Feed(camera.Next());
//   pipeline.Finish();
//   if (const auto map = system.MainMap()) Use(system.FinalTrajectory(*map));
//
// One thread feeds. Until Finish the system belongs to the pipeline: nobody else uses it but the
// observer, which may call what System has for the thread that tracks. What a stage throws comes
// out of the next Feed, Skip or Finish; after that the pipeline takes no more frames.
class Pipeline {
 public:
  // Called for every frame in order, in the thread that tracks, as soon as the pose is known. It
  // gets the frame's record and view, which are valid during the call; the view is empty where the
  // frame was skipped. It must be quick in live mode.
  using Observer = std::function<void(const FrameRecord&, const FrameView&)>;
  // The reason in the records of frames that a live run left out because they waited too long.
  static constexpr const char* kDropped = "dropped";
  // The most frames with images that wait for tracking.
  static constexpr std::size_t kMaxWaiting = 2;

  // Starts the thread that tracks, where the mode has one. The system must live longer than the
  // pipeline, and the observer must not be empty. Throws BugError where the system is to work
  // without threads (Execution) and the mode is not live.
  Pipeline(System& system, Observer observer);
  // Leaves undone all jobs that have not begun, unless Finish was called.
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Takes the next frame, in order of time. What System::Process would throw for it is thrown by
  // this call or a later one.
  void Feed(SensorFrame frame);
  // Tells of a frame that could not be read. `reason` goes into its record, for example
  // "image_unreadable"; it must not be empty (BugError).
  void Skip(std::int64_t stamp_ns, const std::string& reason);
  // Waits until all frames handed over so far are tracked, or until a failure ends the tracking.
  void Drain();
  // Does all jobs that wait, and the mapping that belongs to them (System::Finish, which gets
  // `stop`). After a failure it completes the mapping of the frames before, then rethrows. To be
  // called after the last frame.
  void Finish(const StopCheck& stop = {});

  // Does the next job in the caller's thread; returns false when none waits. For live runs without
  // threads (Execution of the System).
  bool WorkOnce();

 private:
  // A frame on its way to tracking. It is measured, or raw (live), or has no images because of
  // `reason`.
  struct Job {
    std::int64_t stamp_ns = 0;
    std::optional<ExtractedFrame> measured;
    std::optional<SensorFrame> raw;
    StageClock clock;  // times a raw frame since its arrival
    Execution::Clock::time_point arrival;
    double interval = 0;   // seconds since the frame before was taken; 0: unknown
    std::string reason;    // why it has no images to work on; empty where it has some
    bool dropped = false;  // it had images, and waited too long

    bool HasFrame() const { return reason.empty(); }
  };

  void Hand(Job job);
  void DropOldest();
  std::size_t Waiting() const;
  void Process(Job job);
  LoadLevel Decide(const Job& job);
  void ProcessNext(std::unique_lock<std::mutex>& lock);
  void WorkUntilStopped();
  void RethrowFailure();

  System& system_;
  Observer observer_;
  RunMode mode_;
  Execution execution_;
  std::optional<std::int64_t> last_stamp_ns_;  // stamp of the last frame that was fed
  // State that only the worker uses.
  LoadControl shedding_;
  int dropped_ = 0;  // frames left out since the last frame that was tracked
  std::mutex mutex_;
  std::condition_variable job_added_, job_taken_;
  std::deque<Job> jobs_;
  bool busy_ = false;
  bool stop_ = false;
  std::exception_ptr failure_;
  // The thread does not run in inline mode and step by step. It is declared last, so that it ends
  // before what it uses.
  std::jthread worker_;
};

}  // namespace plumbline
