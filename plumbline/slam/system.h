// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/extracted_frame.h"
#include "plumbline/slam/frame_record.h"
#include "plumbline/slam/load_level.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/run_result.h"
#include "plumbline/slam/stage_clock.h"

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

struct DroppedKeyFrame;
struct CameraAndPyramid;
struct InitialMap;
struct LoopAttempt;
struct MapSnapshot;
struct RelocalizationOutcome;
struct SystemMethods;
struct SystemStages;
struct InertialCalibration;
struct InertialSample;
struct TrackingResult;
struct UnfinishedFrame;
class FrontEnd;
class MapperThread;
class MonocularInitialization;
class Tracker;

// Data of a frame beside its record, for display.
struct FrameView {
  RectifiedFrame images;
  Frame frame;  // features; with matches if the frame was tracked
};

// The maps of a run that goes on, between two tasks of mapping.
struct CurrentMaps {
  const Atlas& atlas;
  MapEvents events;  // loops and merges so far
  // Returns a copy of the maps as they would be saved, with their context for SaveAtlas.
  std::function<SavedAtlas()> copy;
};

// The whole SLAM system for one camera (or rig): feed frames in order of time, then call Finish,
// which returns trajectories and maps.
// The calibration says whether frames are single images, stereo pairs or images with depth.
//
// Poses are world_from_camera of the left camera as delivered (before rectification). The world is
// that camera at the first keyframe of each map; its unit is the metre if depth is measured,
// otherwise arbitrary. slam.mode sets how mapping runs beside tracking (MapperThread); Pipeline
// (pipeline.h) adds a thread for tracking, and feeds live runs. Not thread-safe, except Extract.
class System {
 public:
  // Makes a system without a map. It copies all arguments.
  //
  //   calibration  sensor and camera parameters (Calibration)
  //   options      all settings of the run; docs/options.md has those worth a change
  //   execution    the clock and the threads of a live run; leave the default, unless the program
  //                itself does a live run step by step
  //
  // Throws InputError for an unusable calibration, for options that are out of range or contradict
  // each other (CheckOptions), and if tracking.reference is last_frame for a single camera.
  System(const Calibration& calibration,
         const SlamOptions& options,
         const Execution& execution = {});
  // Makes a system that has other methods than the product's alone (slam/system_methods.h), which
  // options may name.
  System(const Calibration& calibration,
         const SlamOptions& options,
         const Execution& execution,
         const SystemMethods& methods);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // Continues in the active map of a saved atlas, before the first frame. The camera's pose in that
  // map is unknown: frames are lost until relocalization succeeds; after relocalization.patience
  // lost frames a new map starts. Trajectories contain only this system's own frames, in the world
  // of the map. With read_only the map is tracked against and does not change, and no other map
  // starts.
  //
  // Returns a sentence for each difference of the front end that makes the map harder to use.
  // Throws InputError if the map was made with another rectified camera (another rotation against
  // the left camera is fine) or another image pyramid, if there is no map, and if relocalization is
  // switched off.
  std::vector<std::string> Continue(SavedAtlas saved, bool read_only);

  // Sets an observer, for measurements, of the comparisons of each new keyframe with older ones and
  // their results. It is called in the mapping thread. To be called before the first frame.
  void Observe(std::function<void(const Atlas&, const LoopAttempt&)> observer);

  // Uses the inertial sensor of a calibration with imu_from_left, whose samples AddInertial brings:
  // its gyroscope predicts the turns of the camera, and takes part in the start of a single one. To
  // be called before the first frame.
  void UseInertial(const InertialCalibration& calibration);
  // Takes samples of the inertial sensor in order of time, those of a frame before it is tracked:
  // all up to its stamp on the sensor's clock, and one more if it is there. Samples of frames that
  // are left out count for the next one. To be called in the tracking thread; without UseInertial
  // they are left out.
  void AddInertial(std::span<const InertialSample> samples);

  // Processes a frame and returns its record: Extract, Track and Complete in one call. The result
  // is valid until the next frame. Throws InputError if an image is missing or its size differs
  // from the calibration, or if the frame is no later than the one before.
  const FrameRecord& Process(SensorFrame frame);
  // Does the part of the work that needs no earlier frame, in any thread; see FrontEnd. Throws
  // InputError if an image is missing or its size differs from the calibration.
  ExtractedFrame Extract(SensorFrame frame,
                         StageClock clock = {},
                         LoadLevel shed = LoadLevel::kNothing) const;
  // Tracks a frame with features and returns its record; valid until the next frame. The pose is
  // returned as soon as it is known: Complete does the remaining work for the map. Throws
  // InputError if the frame is no later than the one before.
  const FrameRecord& Track(ExtractedFrame frame);
  // Does the remaining work of the last tracked frame: matches its lines in the right image if they
  // become landmarks, hands a keyframe to mapping, requests relocalization of a lost camera. A
  // second call does nothing. Functions that need it (the next frame, Finish, access to the maps)
  // call it themselves. Of the frame's record only the times change.
  void Complete();
  // Adds a frame that could not be read or was left out, and returns its record. Throws InputError
  // if it is no later than the one before.
  const FrameRecord& Skip(std::int64_t stamp_ns,
                          const std::string& reason,
                          LoadLevel shed = LoadLevel::kNothing);
  // Returns the number of tasks waiting for mapping, most of them keyframes, without
  // those of ReadMaps.
  std::size_t TasksWaiting() const;
  // Executes the next task of mapping; returns false if none waits. For live runs without threads
  // (Execution).
  bool MapOnce();
  // Calls `read` with the maps once mapping has done all tasks submitted so far. The call happens
  // in the mapping thread. Changes no result. To be called in the tracking thread.
  void ReadMaps(std::function<void(const CurrentMaps&)> read);
  // Waits until mapping has done all tasks submitted so far, ReadMaps included, which changes the
  // result of live runs only. Rethrows exceptions of mapping. To be called in the tracking thread.
  void WaitForMapping();
  // Returns the loops, merges and relocalizations known by now but not yet counted in `known`,
  // which is updated. To be called in the tracking thread.
  MapEvents EventsSince(MapEventCounts& known) const;

  // Completes the mapping of all frames and returns the result; to be called once, after the last
  // frame. Frames from before a monocular map, or early ones in it, are located in the finished map
  // (MonocularInitialization). Frames from before the map get a pose, but no causal one; early
  // frames keep their causal pose, and all else of them is estimated again. `stop` ends the
  // adjustment of the whole maps and this search early; the rest stays unchanged.
  //
  // If mapping throws, its exception is stored in `failure`; the maps of the result are then as
  // mapping left them, frames that refer to a keyframe not mapped are lost (reason kNotMapped), and
  // everything else is valid. Without `failure` the exception is thrown, and there is no result.
  RunResult Finish(const StopCheck& stop = {}, std::exception_ptr* failure = nullptr);
  static constexpr const char* kNotMapped = "not_mapped";

  // The options of the system.
  const SlamOptions& options() const { return options_; }
  // Threads and clock of a live run.
  const Execution& execution() const { return execution_; }
  // Rectifies delivered images; has the rectified camera of all stages after rectification.
  const Rectifier& rectifier() const;
  // The last processed frame.
  const FrameView& view() const { return view_; }

 private:
  // Begins the result with all that is known before the first frame.
  void BeginResult();
  void ContinueContext(AtlasContext loaded, bool read_only);
  // Notes the id of the session that begins with this frame.
  void NameSession(const ExtractedFrame& first);
  // Returns the number of this run among the sessions of the maps.
  SessionId session_id() const;
  std::shared_ptr<const MapSnapshot> TakeRelocalized(FrameId frame);
  std::shared_ptr<const MapSnapshot> FollowFrom(const RelocalizationOutcome& outcome);
  void LookInEarlierSnapshot(const TrackingResult& result);
  bool TrackedSince(FrameId frame) const;
  void Relocalize(const TrackingResult& result);
  TrackingResult FollowMap(ExtractedFrame& extracted, FrameRecord& record, StageClock& clock);
  void CompleteRightLines(UnfinishedFrame& unfinished, StageClock& clock);
  // Returns the times of mapping steps since the last call.
  std::vector<StageTime> TakeMappingTimes();
  TrackingResult OfferToStart(const ExtractedFrame& extracted, FrameRecord& record);
  TrackingResult StartFrom(const InitialMap& initial, FrameRecord& record);
  void Demote(const DroppedKeyFrame& gone);
  FrameStatus StatusWithoutPose() const;
  void RecordTracking(const TrackingResult& result, FrameRecord& record);
  // Throws InputError unless later than the last; BugError after Finish.
  void CheckStamp(std::int64_t stamp_ns) const;
  const FrameRecord& Keep(FrameRecord record);
  void LoseFramesNotMapped();
  void LocateEarlyFrames(const StopCheck& stop);
  void CollectMaps();

  SlamOptions options_;
  std::int64_t cut_lines_ = 0;
  Execution execution_;
  // The stages, behind a pointer, so that this header does not include theirs.
  std::unique_ptr<SystemStages> stages_;
  FrontEnd& front_end_;
  CameraAndPyramid& imaging_;
  MapperThread& mapping_;
  Tracker& tracker_;
  std::unique_ptr<MonocularInitialization>& monocular_initialization_;
  MapId map_;  // map tracked against
  std::int64_t next_map_ = 0;
  bool relocalizing_ = false;  // true if a relocalization was requested and has no result yet
  std::unique_ptr<RelocalizationOutcome> found_in_earlier_;  // of the last frame; null if none
  bool finished_ = false;
  // The result so far: of the maps only their context, without what mapping adds at the end.
  RunResult result_;
  FrameRecord newest_;  // record of the last frame
  FrameView view_;
  std::unique_ptr<UnfinishedFrame> unfinished_;  // null if none
};

}  // namespace plumbline
