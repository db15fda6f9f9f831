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
#include "plumbline/map/session.h"
#include "plumbline/mapping/adjusted_lines.h"
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
struct SystemStages;
struct TrackingResult;
struct UnfinishedFrame;
class FrontEnd;
class MapperThread;
class MonocularInitialization;
class Tracker;

// What Process leaves of a frame beside its record, for display.
struct FrameView {
  RectifiedFrame images;
  Frame frame;  // features; its matches where the frame was tracked
};

// The whole of SLAM for one camera (or rig): feed frames in order of time, then call Finish.
// Whether frames are single images, stereo pairs or images with depth is what the calibration says.
//
// Poses are world_from_camera of the left camera as delivered (before rectification). The world is
// that camera at the first keyframe of each map; its unit is the metre where depth is measured,
// otherwise arbitrary. slam.mode says how mapping runs beside tracking (MapperThread); Pipeline
// (pipeline.h) adds a thread for tracking, and is what feeds a live run. Not thread-safe, except
// Measure.
class System {
 public:
  // Makes a system without a map. It keeps copies of all that it is given.
  //
  //   calibration  what the frames are made of and how their images are taken (Calibration)
  //   options      all settings of the run; docs/options.md has those that are worth a change
  //   execution    the clock and the threads of a live run; leave the default, unless the program
  //                itself does a live run step by step
  //
  // Throws InputError for a calibration that cannot be used, for options that are out of range or
  // contradict each other (CheckOptions), and where tracking.reference is last_frame for a single
  // camera.
  System(const Calibration& calibration,
         const SlamOptions& options,
         const Execution& execution = {});
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // Goes on in the active map of a saved atlas, before the first frame. The camera's place in that
  // map is unknown and is looked for by appearance. Frames are lost until it is found; after
  // relocalization.patience lost frames a new map starts. Trajectories contain only this system's
  // own frames, in the world of the map. With read_only the map is tracked against, nothing of it
  // changes, and no other map starts.
  //
  // Returns a sentence for each thing that makes the map harder to use: it was made with another
  // front end. Throws InputError where the map was made with another rectified camera (one that is
  // only turned against the left camera in another way is fine) or another image pyramid, where
  // there is no map, and where relocalization is switched off.
  std::vector<std::string> Continue(SavedAtlas saved, bool read_only);
  // What was loaded beside the maps; null where no maps were loaded.
  const AtlasContext* loaded() const { return loaded_ ? &*loaded_ : nullptr; }
  // Whether the maps stay as they were loaded.
  bool read_only() const { return read_only_; }

  // Sets an observer, for measurements, of the keyframes that are compared with each new one and
  // what becomes of the comparison. It is called in the thread that maps. To be called before the
  // first frame.
  void Observe(std::function<void(const Atlas&, const LoopAttempt&)> observer);

  // Processes a frame and returns what became of it: Measure, Track and Complete in one call. The
  // result is valid until the next frame. Throws InputError when an image is missing or has another
  // size than the calibration says, or when the frame is no later than the one before.
  const FrameRecord& Process(SensorFrame frame);
  // Does the part of the work that needs no earlier frame, in any thread; see FrontEnd. Throws
  // InputError when an image is missing or has another size than the calibration says.
  ExtractedFrame Measure(SensorFrame frame,
                         StageClock clock = {},
                         LoadLevel shed = LoadLevel::kNothing) const;
  // Throws InputError where an image is missing that the calibration speaks of. Measure calls it.
  void CheckImages(const SensorFrame& frame) const;
  // Tracks a frame that was measured before and returns what became of it; valid until the next
  // frame. The pose is returned as soon as it is known: Complete does what the frame leaves to do
  // for the map. Throws InputError when the frame is no later than the one before.
  const FrameRecord& Track(ExtractedFrame frame);
  // Does what the last tracked frame leaves to do: looks for its lines in the right image where
  // landmarks are to be made of them, hands a keyframe to mapping, asks for the place of a lost
  // camera. A second call does nothing. Functions that need it done (the next frame, Finish, a
  // look at the maps) call it themselves. Of the frame's record only the times change.
  void Complete();
  // Tells of a frame that could not be read or was left out, and returns its record. Throws
  // InputError when it is no later than the one before.
  const FrameRecord& Skip(std::int64_t stamp_ns,
                          const std::string& reason,
                          LoadLevel shed = LoadLevel::kNothing);
  // Returns the number of tasks that wait for mapping, most of them keyframes. CopyMaps and
  // ReadMaps do not count.
  std::size_t TasksWaiting() const;
  // Does the next task of mapping; returns false when none waits. For live runs without threads
  // (Execution).
  bool MapOnce();
  // Calls `take` with a copy of the maps as they would be saved (MoveFirstKeyFramesBack), and with
  // what SaveAtlas needs beside them, once mapping has done what was submitted so far. The call
  // happens in the thread that maps. Changes no result. To be called in the thread that tracks,
  // after the first frame.
  void CopyMaps(std::function<void(SavedAtlas)> take);
  // Waits for such a copy and returns it. Completes the mapping of the frames so far, which changes
  // the result of live runs only. Rethrows what mapping threw.
  SavedAtlas CopyMaps();
  // Calls `look` with the maps and with the loops and joins so far, once mapping has done what was
  // submitted so far. The call happens in the thread that maps. Changes no result. To be called in
  // the thread that tracks.
  void ReadMaps(std::function<void(const Atlas&, const MapEvents&)> look);

  // Completes the mapping of all frames so far. Frames that came before a monocular map, or while
  // it was young, are located in the finished map (MonocularInitialization). Frames from before the
  // map get a pose, but no causal one; those of a young map keep only their causal pose and get the
  // rest anew. `stop` cuts short the adjustment of the whole maps and this search; what was not
  // reached stays as it is.
  //
  // Rethrows what mapping threw. Then the maps are as mapping left them, frames that refer to a
  // keyframe that mapping did not get to are lost (reason kNotMapped), and the rest holds.
  void Finish(const StopCheck& stop = {});
  static constexpr const char* kNotMapped = "not_mapped";

  // The records of all frames so far.
  const FrameLog& frames() const { return frames_; }
  // The maps. They are complete after Finish; except inline, they may not be asked for before that
  // (BugError).
  const Atlas& atlas() const;
  // What the maps were made with, for SaveAtlas. When it may be called: see atlas().
  AtlasContext Context() const;
  // The maps of the atlas by id. When it may be called: see atlas().
  const std::map<MapId, Map>& maps() const { return atlas().maps(); }
  // The lines that local bundle adjustment held in memory, summed over all its windows. When it may
  // be called: see atlas().
  const AdjustedLines& adjusted_lines() const;
  // This run of the camera so far, as map files keep it. Its id is made of the first frame's
  // features and stamp, the rig and the options, so that the same input is the same session
  // wherever it lies.
  Session session() const;
  // Sets the version of the program for map files. Where the data lie is not written: the same
  // input by another name gives the same file.
  void DescribeSession(const std::string& program);
  // The options that the system was made with.
  const SlamOptions& options() const { return options_; }
  // Who does the work of a live run.
  const Execution& execution() const { return execution_; }
  // The rectified camera, which all stages behind rectification see.
  const RectifiedCamera& camera() const { return rectifier().camera(); }
  // Makes rectified images of those delivered.
  const Rectifier& rectifier() const;
  // What the starts of maps from one camera have done in this run; nullopt with other sensors.
  std::optional<InitializationCounts> initialization_counts() const;
  // Lines of which only a piece took part in the pose of a frame, over all frames of this run
  // (CuttingOptions).
  std::int64_t cut_lines() const { return cut_lines_; }
  // The last processed frame.
  const FrameView& view() const { return view_; }

  // Lost frames that were found in a map so far. To be called in the thread that tracks.
  const std::vector<Relocalization>& relocalizations() const { return relocalizations_; }
  // What was recognized, joined and found again, each kind in order. When it may be called: see
  // atlas().
  MapEvents events() const;
  // The part of events() that is known by now. To be called in the thread that tracks.
  MapEvents EventsSoFar() const;
  // The part of events() that the caller does not know yet, and that counts as known from then on.
  // To be called in the thread that tracks.
  MapEvents EventsSince(MapEventCounts& known) const;

  // Returns the poses of the camera as delivered after all corrections, in order of time; to be
  // called after Finish. `map` is one of maps(), otherwise InputError is thrown.
  Trajectory FinalTrajectory(MapId map) const;
  // Returns the poses of this run's keyframes alone; otherwise like FinalTrajectory.
  Trajectory KeyFrameTrajectory(MapId map) const;
  // Returns each pose as it was first reported. `map` may have been joined with another one since;
  // a map without poses gives none.
  Trajectory CausalTrajectory(MapId map) const;
  // Returns the covariances of the poses of CausalTrajectory, as far as they are known
  // (FrameRecord::causal_covariance).
  std::vector<StampedCovariance> CausalCovariances(MapId map) const;
  // Returns the lines of a map that are fit to be given out, in its world (MakeLineMap). They are
  // made when first asked for, until `stop`, and kept. To be called after Finish.
  const std::vector<MappedLine>& LineMap(MapId map, const StopCheck& stop = {}) const;
  // Returns the map in which most frames have a pose, of two the one with the smaller id; nullopt
  // when no frame has a pose.
  std::optional<MapId> MainMap() const;

 private:
  // Returns the id of the session that begins with this frame.
  Uuid SessionUuid(const ExtractedFrame& first) const;
  // Returns the part of Context() that the thread that tracks knows at any time.
  AtlasContext ContextWithoutMaps() const;
  Rigid3 AsDelivered(const Rigid3& rectified_cam_from_world) const;
  std::shared_ptr<const MapSnapshot> TakeRelocalized(FrameId frame);
  bool TrackedSince(FrameId frame) const;
  void Relocalize(const TrackingResult& result);
  // Returns the number of this run among the runs that made the maps.
  SessionId session_id() const;
  TrackingResult FollowMap(ExtractedFrame& measured, FrameRecord& record, StageClock& clock);
  void CompleteRightLines(UnfinishedFrame& unfinished, StageClock& clock);
  // Returns the times of the steps of mapping that ended since the last call.
  std::vector<StageTime> TakeMappingTimes();
  TrackingResult OfferToStart(const ExtractedFrame& measured, FrameRecord& record);
  TrackingResult StartFrom(const InitialMap& initial, FrameRecord& record);
  void Demote(const DroppedKeyFrame& gone);
  FrameStatus StatusWithoutPose() const;
  void RecordTracking(const TrackingResult& result, FrameRecord& record);
  const Map& MapOf(MapId id) const;              // throws InputError where there is none
  void CheckStamp(std::int64_t stamp_ns) const;  // throws InputError unless later than the last
  const FrameRecord& Keep(FrameRecord record);
  void LoseFramesNotMapped();

  SlamOptions options_;
  std::int64_t cut_lines_ = 0;
  Execution execution_;
  // The stages, behind a pointer, so that this header does not bring theirs along.
  std::unique_ptr<SystemStages> stages_;
  FrontEnd& front_end_;
  CameraAndPyramid& imaging_;
  MapperThread& mapping_;
  Tracker& tracker_;
  std::unique_ptr<MonocularInitialization>& monocular_initialization_;
  MapId map_;  // map that is tracked against
  std::int64_t next_map_ = 0;
  KeyFrameId first_keyframe_{0};  // first id of this system's own keyframes
  bool relocalizing_ = false;     // a place was asked for, without an answer yet
  std::vector<Relocalization> relocalizations_;
  std::optional<AtlasContext> loaded_;
  bool read_only_ = false;
  FrameLog frames_;
  FrameRecord newest_;  // record of the last frame
  FrameView view_;
  std::unique_ptr<UnfinishedFrame> unfinished_;  // null where there is none
  Session session_;                              // without the stamps, which session() adds
  mutable std::map<MapId, std::vector<MappedLine>> line_maps_;  // line maps made so far
};

}  // namespace plumbline
