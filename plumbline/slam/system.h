// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/mapping/mapped_line.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/extracted_frame.h"
#include "plumbline/slam/frame_log.h"
#include "plumbline/slam/load_level.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/stage_clock.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

struct DroppedKeyFrame;
struct CameraAndPyramid;
struct InitialMap;
struct InitializationCounts;
struct LoopAttempt;
struct MapSnapshot;
struct SystemMethods;
struct SystemStages;
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

// The whole SLAM system for one camera (or rig): feed frames in order of time, then call Finish.
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
  // Context loaded with the maps; null if no maps were loaded.
  const AtlasContext* loaded() const { return loaded_ ? &*loaded_ : nullptr; }
  // True if loaded maps do not change.
  bool read_only() const { return read_only_; }

  // Sets an observer, for measurements, of the comparisons of each new keyframe with older ones and
  // their results. It is called in the mapping thread. To be called before the first frame.
  void Observe(std::function<void(const Atlas&, const LoopAttempt&)> observer);

  // Processes a frame and returns its record: Extract, Track and Complete in one call. The result
  // is valid until the next frame. Throws InputError if an image is missing or its size differs
  // from the calibration, or if the frame is no later than the one before.
  const FrameRecord& Process(SensorFrame frame);
  // Does the part of the work that needs no earlier frame, in any thread; see FrontEnd. Throws
  // InputError if an image is missing or its size differs from the calibration.
  ExtractedFrame Extract(SensorFrame frame,
                         StageClock clock = {},
                         LoadLevel shed = LoadLevel::kNothing) const;
  // Throws InputError if an image is missing that the calibration requires. Extract calls it.
  void CheckImages(const SensorFrame& frame) const;
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
  // Returns the number of tasks waiting for mapping, most of them keyframes, without those of
  // CopyMaps and ReadMaps.
  std::size_t TasksWaiting() const;
  // Executes the next task of mapping; returns false if none waits. For live runs without threads
  // (Execution).
  bool MapOnce();
  // Calls `take` with a copy of the maps as they would be saved (MoveFirstKeyFramesBack) and their
  // context for SaveAtlas, once mapping has done all tasks submitted so far. The call happens in
  // the mapping thread. Changes no result. To be called in the tracking thread, after the first
  // frame.
  void CopyMaps(std::function<void(SavedAtlas)> take);
  // Waits for a copy of the maps and returns it. Completes the mapping of the frames so far, which
  // changes the result of live runs only. Rethrows exceptions of mapping.
  SavedAtlas CopyMaps();
  // Calls `look` with the maps and with the loops and merges so far, once mapping has done all
  // tasks submitted so far. The call happens in the mapping thread. Changes no result. To be called
  // in the tracking thread.
  void ReadMaps(std::function<void(const Atlas&, const MapEvents&)> look);

  // Completes the mapping of all frames so far. Frames from before a monocular map, or early ones
  // in it, are located in the finished map (MonocularInitialization). Frames from before the map
  // get a pose, but no causal one; early frames keep their causal pose, and all else of them is
  // estimated again. `stop` ends the adjustment of the whole maps and this search early; the rest
  // stays unchanged.
  //
  // Rethrows exceptions of mapping. Then the maps are as mapping left them, frames that refer to a
  // keyframe not mapped are lost (reason kNotMapped), and everything else is valid.
  void Finish(const StopCheck& stop = {});
  static constexpr const char* kNotMapped = "not_mapped";

  // The records of all frames so far.
  const FrameLog& frames() const { return frames_; }
  // atlas(), Context(), maps(), adjusted_lines() and events() may be called after Finish, in inline
  // mode also before (otherwise BugError).
  //
  // The maps.
  const Atlas& atlas() const;
  // Context of the maps, for SaveAtlas.
  AtlasContext Context() const;
  // The maps of the atlas by id.
  const std::map<MapId, Map>& maps() const { return atlas().maps(); }
  // Number and memory of the lines in local bundle adjustment, summed over all windows.
  const AdjustedLines& adjusted_lines() const;
  // This session so far, as map files store it. Its id is a hash of the first frame's features and
  // stamp, the rig and the options, so that the same input is the same session wherever it is
  // stored.
  Session session() const;
  // Sets the version of the program for map files. The path of the input is not written: the same
  // input by another name gives the same file.
  void DescribeSession(const std::string& program);
  // The options of the system.
  const SlamOptions& options() const { return options_; }
  // Threads and clock of a live run.
  const Execution& execution() const { return execution_; }
  // The rectified camera of all stages after rectification.
  const RectifiedCamera& camera() const { return rectifier().camera(); }
  // Rectifies delivered images.
  const Rectifier& rectifier() const;
  // Counts of monocular initialization in this run; nullopt with other sensors.
  std::optional<InitializationCounts> initialization_counts() const;
  // Number of lines whose cut piece was used for the pose of a frame, over all frames of this run
  // (CuttingOptions).
  std::int64_t cut_lines() const { return cut_lines_; }
  // The last processed frame.
  const FrameView& view() const { return view_; }

  // Relocalizations so far. To be called in the tracking thread.
  const std::vector<Relocalization>& relocalizations() const { return relocalizations_; }
  // Loops, merges and relocalizations, each kind in order.
  MapEvents events() const;
  // The part of events() known by now. To be called in the tracking thread.
  MapEvents EventsSoFar() const;
  // The part of events() not yet counted in `known`, which is updated. To be called in the tracking
  // thread.
  MapEvents EventsSince(MapEventCounts& known) const;

  // Returns the poses of the camera as delivered after all corrections, in order of time; to be
  // called after Finish. `map` is one of maps(), otherwise InputError is thrown.
  Trajectory FinalTrajectory(MapId map) const;
  // Returns the poses of this run's keyframes alone; otherwise like FinalTrajectory.
  Trajectory KeyFrameTrajectory(MapId map) const;
  // Returns each pose as first reported. `map` may have been merged with another one since; a map
  // without poses gives none.
  Trajectory CausalTrajectory(MapId map) const;
  // Returns the covariances of the poses of CausalTrajectory, as far as they are known
  // (FrameRecord::causal_covariance).
  std::vector<StampedCovariance> CausalCovariances(MapId map) const;
  // Returns the lines of a map accurate enough for output, in its world (MakeLineMap). They are
  // made at the first call, until `stop`, and cached. To be called after Finish.
  const std::vector<MappedLine>& LineMap(MapId map, const StopCheck& stop = {}) const;
  // Returns the map in which most frames have a pose, of two the one with the smaller id; nullopt
  // if no frame has a pose.
  std::optional<MapId> MainMap() const;

 private:
  // Returns the id of the session that begins with this frame.
  Uuid SessionUuid(const ExtractedFrame& first) const;
  // Returns the part of Context() known to the tracking thread at any time.
  AtlasContext ContextWithoutMaps() const;
  Rigid3 AsDelivered(const Rigid3& rectified_cam_from_world) const;
  std::shared_ptr<const MapSnapshot> TakeRelocalized(FrameId frame);
  bool TrackedSince(FrameId frame) const;
  void Relocalize(const TrackingResult& result);
  // Returns the number of this run among the sessions of the maps.
  SessionId session_id() const;
  TrackingResult FollowMap(ExtractedFrame& extracted, FrameRecord& record, StageClock& clock);
  void CompleteRightLines(UnfinishedFrame& unfinished, StageClock& clock);
  // Returns the times of mapping steps since the last call.
  std::vector<StageTime> TakeMappingTimes();
  TrackingResult OfferToStart(const ExtractedFrame& extracted, FrameRecord& record);
  TrackingResult StartFrom(const InitialMap& initial, FrameRecord& record);
  void Demote(const DroppedKeyFrame& gone);
  FrameStatus StatusWithoutPose() const;
  void RecordTracking(const TrackingResult& result, FrameRecord& record);
  const Map& MapOf(MapId id) const;              // throws InputError if unknown
  void CheckStamp(std::int64_t stamp_ns) const;  // throws InputError unless later than the last
  const FrameRecord& Keep(FrameRecord record);
  void LoseFramesNotMapped();

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
  KeyFrameId first_keyframe_{0};  // first id of this system's own keyframes
  bool relocalizing_ = false;     // true if a relocalization was requested and has no result yet
  std::vector<Relocalization> relocalizations_;
  std::optional<AtlasContext> loaded_;
  bool read_only_ = false;
  FrameLog frames_;
  FrameRecord newest_;  // record of the last frame
  FrameView view_;
  std::unique_ptr<UnfinishedFrame> unfinished_;  // null if none
  Session session_;                              // without the stamps, which session() adds
  mutable std::map<MapId, std::vector<MappedLine>> line_maps_;  // line maps made so far
};

}  // namespace plumbline
