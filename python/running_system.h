// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/inertial/inertial_samples.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/pipeline.h"
#include "plumbline/slam/system.h"

#include "apps/run_frames.h"
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline::python {

// A System with its Pipeline for Python: one call at a time, frames in order, nothing after the
// end; InputError otherwise. Independent of Python: all functions may be called without the GIL.
class RunningSystem {
 public:
  //   preset  name of the preset that the options begin with; nullopt: the defaults
  RunningSystem(const Calibration& calibration,
                const SlamOptions& options,
                std::optional<std::string> preset);

  const Calibration& calibration() const { return calibration_; }
  const SlamOptions& options() const { return options_; }
  const std::optional<std::string>& preset() const { return preset_; }

  // Uses the gyroscope of an inertial sensor, before the first frame (System::UseInertial).
  void UseInertial(const InertialCalibration& calibration);
  bool uses_inertial() const { return uses_inertial_; }
  // Takes samples of it, those of a frame before the frame. They are left out if no sensor is used.
  void AddInertial(std::span<const InertialSample> samples);
  // Feeds the images of a frame. Its record is returned by TakeRecords.
  void Feed(SensorFrame frame);
  // Feeds a frame and waits for its record, which TakeRecords does not return again, so that
  // callers of Process alone do not accumulate records.
  FrameRecord Process(SensorFrame frame);
  // Adds a frame without images.
  void Skip(std::int64_t stamp_ns, const std::string& reason);
  // Returns the records of frames tracked since the last call, in order, without those returned by
  // Process.
  std::vector<FrameRecord> TakeRecords();
  std::vector<std::string> Continue(SavedAtlas saved, bool read_only);
  // Stores views of these frames from now on, for the report.
  void KeepViews(const std::vector<std::size_t>& frames);
  void Finish(const StopCheck& stop);
  bool finished() const { return result_.has_value(); }

  // Returns the maps once mapping has done all tasks submitted so far, at any time after the first
  // frame.
  SavedAtlas CopyMaps();
  MapEvents Events();
  // Returns the map events since the last call that are known by now: in order, but the time at
  // which a loop becomes known depends on the machine's speed. After the end: all remaining ones.
  MapEvents TakeEvents();
  // Calls `use` with the result of the system, which must be finished.
  template <class Use>
  auto WithFinished(const char* what, const Use& use) {
    const auto lock = Enter(what);
    CheckFinished(what);
    return use(*result_);
  }
  const KeptViews& views() const { return views_; }
  std::optional<double> first_pose_seconds() const { return first_pose_seconds_; }
  std::chrono::steady_clock::time_point start() const { return start_; }

 private:
  std::unique_lock<std::mutex> Enter(const char* what);
  void CheckRunning(const char* what) const;
  void CheckFinished(const char* what) const;
  void CheckFrame(const SensorFrame& frame) const;
  void CheckStamp(std::int64_t stamp_ns);
  void Observe(const FrameRecord& record, const FrameView& view);
  void NoteEvents(const MapEvents& fresh);
  void FinishRun(const StopCheck& stop);

  Calibration calibration_;
  SlamOptions options_;
  std::optional<std::string> preset_;
  System system_;
  std::mutex entered_;
  std::optional<RunResult> result_;  // once it is finished
  bool continues_ = false;           // maps were loaded
  bool uses_inertial_ = false;
  TimeOrder inertial_order_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  KeptViews views_{{}};
  std::optional<double> first_pose_seconds_;
  std::mutex records_mutex_;
  std::vector<FrameRecord> records_;        // not taken yet
  std::optional<std::int64_t> awaited_ns_;  // stamp of the frame awaited by Process
  std::optional<FrameRecord> awaited_;      // its record
  MapEvents events_;                        // not taken yet
  MapEventCounts events_known_;             // taken or in events_; the tracking thread's
  Pipeline pipeline_;                       // declared last: its thread calls Observe
};

}  // namespace plumbline::python
