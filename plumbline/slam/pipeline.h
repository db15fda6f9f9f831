// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/inertial/inertial_sample.h"
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
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace plumbline {

// Feeds frames to a System in the mode slam.mode.
//
//   inline    Feed does everything, in the caller's thread.
//   lockstep  Feed extracts features in the caller's thread and leaves tracking to another one,
//             which is at most two frames behind; if it is, Feed waits. The bytes are those of
//             inline.
//   live      Feed only queues the frame. Two frames may wait; with one more, the oldest of them
//             is left out (FrameStatus::kSkipped, reason kDropped). If frames have to wait, less
//             work is done for them (LoadControl), as their records say. Not reproducible.
//
// A live run:
//
//   options.slam.mode = RunMode::kLive;
//   System system(calibration, options);
//   Pipeline pipeline(system, [](const FrameRecord& record, const FrameView&) { Show(record); });
//   while (camera.IsOn()) pipeline.Feed(camera.Next());
//   const RunResult result = pipeline.Finish();
//   if (const auto map = result.MainMap()) Use(result.FinalTrajectory(*map));
//
// One thread feeds. Until Finish only the pipeline uses the system, and its observer, which may
// call the functions of System that are for the tracking thread. Exceptions of a stage are rethrown
// by the next Feed, Skip or Finish; after that the pipeline takes no more frames.
class Pipeline {
 public:
  // Called for every frame in order, in the tracking thread, as soon as the pose is known. Its
  // arguments, the frame's record and view, are valid during the call; the view of a skipped frame
  // is empty. It must be quick in live mode.
  using Observer = std::function<void(const FrameRecord&, const FrameView&)>;
  // Reason in the records of frames that a live run left out because they waited too long.
  static constexpr const char* kDropped = "dropped";
  // That of frames whose left mask is all black.
  static constexpr const char* kBlackMask = "mask_black";
  // Most frames with images that wait for tracking.
  static constexpr std::size_t kMaxWaiting = 2;

  // Starts the tracking thread, if the mode has one. The system must outlive the pipeline, and the
  // observer must not be empty. Throws BugError if the system is to work without threads
  // (Execution) and the mode is not live.
  Pipeline(System& system, Observer observer);
  // Drops all jobs that have not begun, unless Finish was called.
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Takes samples of the inertial sensor (System::AddInertial), which are used from the next frame
  // on that is fed, or skipped.
  void AddInertial(std::span<const InertialSample> samples);
  // Takes the next frame, in order of time. Exceptions that System::Process would throw for it are
  // thrown by this call or a later one. A frame of which the left mask leaves nothing is skipped.
  void Feed(SensorFrame frame);
  // Adds a frame that could not be read. `reason` goes into its record, for example
  // "image_unreadable"; it must not be empty (BugError).
  void Skip(std::int64_t stamp_ns, const std::string& reason);
  // Waits until all frames handed over so far are tracked, or until a failure ends the tracking.
  void Drain();
  // Executes all waiting jobs and finishes the system (System::Finish, which gets `stop`). After a
  // failure of tracking it completes the mapping of the frames before. The failure is stored
  // in `failure`, beside the result so far; without `failure` it is thrown. To be called once,
  // after the last frame.
  RunResult Finish(const StopCheck& stop = {}, std::exception_ptr* failure = nullptr);

  // Executes the next job in the caller's thread; returns false if none waits. For live runs
  // without threads (Execution of the System).
  bool WorkOnce();

 private:
  // A frame waiting for tracking: with features, raw (live), or without images because of `reason`.
  struct Job {
    std::int64_t stamp_ns = 0;
    std::optional<ExtractedFrame> extracted;
    std::optional<SensorFrame> raw;
    std::vector<InertialSample> inertial;  // kept if the frame is dropped
    StageClock clock;                      // times a raw frame since its arrival
    Execution::Clock::time_point arrival;
    double interval = 0;   // seconds since the previous frame; 0: unknown
    std::string reason;    // reason without images; else empty
    bool dropped = false;  // true if it had images, and waited too long

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
  std::vector<InertialSample> inertial_;       // for the next frame
  // State that only the worker uses.
  LoadControl shedding_;
  int dropped_ = 0;  // frames left out since the last frame that was tracked
  std::mutex mutex_;
  std::condition_variable job_added_, job_taken_;
  std::deque<Job> jobs_;
  bool busy_ = false;
  bool stop_ = false;
  std::exception_ptr failure_;
  // Does not run in inline mode and step by step. Declared last: ends before the members it uses.
  std::jthread worker_;
};

}  // namespace plumbline
