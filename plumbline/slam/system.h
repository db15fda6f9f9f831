// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/map.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/map/saved_run.h"
#include "plumbline/map/session.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/frame_log.h"
#include "plumbline/slam/front_end.h"
#include "plumbline/slam/load_shedding.h"
#include "plumbline/slam/map_events.h"
#include "plumbline/slam/mapping_stage.h"
#include "plumbline/slam/monocular_start.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/stage_clock.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// What Process tells of a frame beside its record, for display.
struct FrameView {
  RectifiedFrame images;
  Frame frame;  // features; matches where tracked
};

// The whole of SLAM for one camera: feed frames in order, then Finish.
//
// Poses are world_from_camera of the left camera as delivered (before rectification); the world is
// that camera at the first keyframe of each map. How mapping runs beside tracking is up to
// slam.mode (see MappingStage); Pipeline adds a thread for tracking. Not thread-safe but for
// Measure.
class System {
 public:
  // Lines are made, adjusted and matched by options.lines.method (LineMethod), the one place where
  // other kinds of lines than the product's come in. Throws InputError for a calibration or options
  // that cannot be used.
  System(const Calibration& calibration,
         const SlamOptions& options,
         const Execution& execution = {});
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // Goes on in the active map of a saved atlas, before the first frame. The camera's place in it is
  // unknown and is looked for by appearance: frames are lost until it is found, and a new map
  // starts after relocalization.patience of them. Trajectories are those of this system's own
  // frames, in the world of the map. read_only: the map is tracked against and nothing of it
  // changes; no other map starts.
  //
  // Returns what makes the map harder to use, a sentence each: it was made with another front end.
  // Throws InputError where the map is of another rectified camera (one that is only turned against
  // the left camera in another way is fine) or another image pyramid, or there is no map, or
  // relocalization is switched off.
  std::vector<std::string> Continue(SavedAtlas saved, bool read_only);
  // What was loaded beside the maps; null where nothing was.
  const AtlasContext* loaded() const { return loaded_ ? &*loaded_ : nullptr; }
  // Whether the maps stay as they were loaded.
  bool read_only() const { return read_only_; }

  // For measurements: what is compared with each keyframe, and what becomes of it. Before the first
  // frame; called in the thread that maps.
  void Observe(PlaceObserver observer) { mapping_.Observe(std::move(observer)); }

  // What came of the frame; it holds until the next one. Measure, Track and Complete. Throws
  // InputError when an image has another size than the calibration says or is missing, or the frame
  // is no later than the one before.
  const FrameRecord& Process(SensorFrame frame);
  // What can be done ahead, in another thread than the rest; see FrontEnd.
  MeasuredFrame Measure(SensorFrame frame, StageClock clock = {}, Shed shed = Shed::kNothing) const;
  // Throws InputError where an image is missing that the calibration speaks of; Measure does, too.
  void CheckComplete(const SensorFrame& frame) const;
  // What came of a frame that was measured before; otherwise as Process. The pose is told as soon
  // as it is known: what the frame leaves to do for the map is done by Complete.
  const FrameRecord& Track(MeasuredFrame frame);
  // Does what the last tracked frame leaves to do, once: looks for its lines in the right image
  // where landmarks are to be made of them, hands a keyframe to mapping, asks for the place of a
  // lost camera. Calls that need it done (the next frame, Finish, Save, a look at the maps) do it
  // themselves. Changes nothing of the frame's record but its times.
  void Complete();
  // A frame that could not be read, or was left out. Throws InputError when it is no later than the
  // one before.
  const FrameRecord& Skip(std::int64_t stamp_ns,
                          const std::string& reason,
                          Shed shed = Shed::kNothing);
  // Keyframes that wait for mapping.
  std::size_t KeyFramesWaiting() const { return mapping_.Waiting(); }
  // Maps the next keyframe; false when none waits. For live runs without threads (Execution).
  bool MapOnce() { return mapping_.WorkOnce(); }
  // Hands over a copy of the maps as they are when mapping has done what was submitted so far, with
  // what SaveAtlas needs beside them, in the thread that maps. Changes no result. To be called in
  // the thread that tracks, after the first frame.
  void CopyMaps(std::function<void(SavedAtlas)> take);
  // Shows the maps as they are then, and the loops and joins so far, in the thread that maps, when
  // mapping has done what was submitted before. Changes no result. To be called in the thread that
  // tracks.
  void LookAtMaps(std::function<void(const Atlas&, const MapEvents&)> look);
  // All that is needed to go on with the next frame as if the run had not stopped: the maps, what
  // tracking and mapping remember, the records of the frames, what is due and when. Completes the
  // mapping of the frames so far, which changes no result but of live runs. To be called in the
  // thread that tracks. Rethrows what mapping threw.
  //
  // The frame that is shown (view()) is not part of it.
  SavedRun Save();
  // Goes on, before the first frame, as the system would that gave this: in the modes inline and
  // lockstep, also the one in place of the other, with the same bytes from the next frame on. A
  // live run goes on without the earlier snapshots that a lost camera is looked for in.
  //
  // Throws InputError, which says why, where calibration or options are others, or the state is
  // none; then the system is not to be used.
  void Resume(SavedRun saved);

  // Completes the mapping of all frames so far. Frames that came before a monocular map, or while
  // it was young, are located in the finished map (see MonocularStart): those before it get a pose,
  // but no causal one; of the others only the causal one stays. `stop` cuts short the adjustment of
  // the whole maps and this search; what was not reached stays as it is.
  //
  // Rethrows what mapping threw; then the maps are what there was until then, frames that belong to
  // a keyframe that mapping did not get to are lost (reason kNotMapped), and the rest holds.
  void Finish(const StopCheck& stop = {});
  static constexpr const char* kNotMapped = "not_mapped";

  // The records of all frames so far.
  const FrameLog& frames() const { return frames_; }
  // Complete after Finish, and not to be asked for before but inline (BugError).
  const Atlas& atlas() const { return mapping_.atlas(); }
  // What the maps were made with, for SaveAtlas; like atlas().
  AtlasContext Context() const;
  // The maps of the atlas by id; complete when atlas() is.
  const std::map<MapId, Map>& maps() const { return mapping_.maps(); }
  // The lines that took part in the adjustment at the end; complete when atlas() is.
  const AdjustedLines& adjusted_lines() const { return mapping_.adjusted_lines(); }
  // What mapping remembers; like atlas().
  LocalMapper::State mapper_state() const { return mapping_.mapper_state(); }
  // This run of the camera so far. Its id is made of the first frame's features and stamp, the rig
  // and the options: the same input, wherever it lies, is the same session.
  Session session() const;
  // What map files say of the session beside that: the version of the program. Not where the data
  // lie: the same input by another name gives the same file.
  void DescribeSession(const std::string& program);
  // The options that the system was made with.
  const SlamOptions& options() const { return options_; }
  // Who does the work of a live run.
  const Execution& execution() const { return execution_; }
  // The camera that all stages behind rectification see.
  const RectifiedCamera& camera() const { return rectifier().camera(); }
  // What makes rectified images of those delivered.
  const Rectifier& rectifier() const { return front_end_.rectifier(); }
  // The last processed frame.
  const FrameView& view() const { return view_; }

  // Lost frames that were found again so far. To be called in the thread that tracks.
  const std::vector<Relocalization>& relocalizations() const { return relocalizations_; }
  // What was recognized, joined and found again, in order; like atlas().
  MapEvents events() const;
  // What of it is known by now (MappingStage::EventsSoFar), in the thread that tracks.
  MapEvents EventsSoFar() const;

  // Poses of the camera as delivered, after Finish; frames in order of time. `map` is one of
  // maps() (InputError); of causal poses also one that was joined with another since.
  Trajectory FinalTrajectory(MapId map) const;
  // The poses of the keyframes alone, as of FinalTrajectory.
  Trajectory KeyFrameTrajectory(MapId map) const;
  // Each pose as it was first reported.
  Trajectory CausalTrajectory(MapId map) const;
  // The lines of a map fit to be given out, in its world, after Finish (MakeLineMap); made when
  // first asked for, those found before `stop`.
  const std::vector<MappedLine>& LineMap(MapId map, const StopCheck& stop = {}) const;
  // The map in which most frames have a pose (the earlier of two); nullopt when none has.
  std::optional<MapId> MainMap() const;

 private:
  // The id of the session that begins with this frame.
  Uuid SessionUuid(const MeasuredFrame& first) const;
  // What the thread that tracks knows of Context() at any time.
  AtlasContext ContextWithoutMaps() const;
  // Of the maps, the stage and the start of a monocular map the caller takes care.
  template <class Self, class Visitor>
  static void VisitRest(Self& self, const Visitor& visit) {
    visit(self.tracker_, self.map_, self.next_map_, self.first_keyframe_, self.relocalizing_);
    visit(self.relocalizations_, self.loaded_, self.read_only_, self.frames_, self.session_);
  }
  void CheckResumed(const Atlas& atlas, const MappingStage::Checkpoint& stage) const;
  Rigid3 AsDelivered(const Rigid3& rectified_cam_from_world) const;
  std::shared_ptr<const MapSnapshot> TakeRelocalized(FrameId frame);
  bool TrackedSince(FrameId frame) const;
  void Relocalize(const TrackingResult& result);
  // The number of this run of the camera among those that made the maps.
  SessionId session_id() const;
  // A frame whose pose is told, until what it leaves to do is done.
  struct Unfinished {
    TrackingResult result;
    Shed shed = Shed::kNothing;
  };
  TrackingResult FollowMap(MeasuredFrame& measured, FrameRecord& record, StageClock& clock);
  void CompleteRightLines(Unfinished& unfinished, StageClock& clock);
  // Of the steps of mapping that ended since the last call.
  std::vector<StageTime> TakeMappingTimes();
  TrackingResult StartMap(const MeasuredFrame& measured, FrameRecord& record);
  TrackingResult StartFrom(const InitialMap& initial, FrameRecord& record);
  void Demote(const DemotedKeyFrame& gone);
  FrameStatus StatusWithoutPose() const;
  void RecordTracking(const TrackingResult& result, FrameRecord& record) const;
  const Map& MapOf(MapId id) const;              // throws InputError where there is none
  void CheckStamp(std::int64_t stamp_ns) const;  // throws InputError unless later than the last
  const FrameRecord& Keep(FrameRecord record);
  void LoseFramesNotMapped();

  SlamOptions options_;
  Execution execution_;
  FrontEnd front_end_;
  ImagingModel imaging_;
  MappingStage mapping_;
  Tracker tracker_;
  std::unique_ptr<MonocularStart> monocular_start_;  // null where depth is measured
  MapId map_;                                        // that is tracked against
  std::int64_t next_map_ = 0;
  KeyFrameId first_keyframe_{0};  // of this system's own
  bool relocalizing_ = false;     // asked for and not yet answered
  std::vector<Relocalization> relocalizations_;
  std::optional<AtlasContext> loaded_;
  bool read_only_ = false;
  FrameLog frames_;
  FrameRecord newest_;  // the last of them
  FrameView view_;
  std::optional<Unfinished> unfinished_;
  Session session_;                                             // without the stamps
  mutable std::map<MapId, std::vector<MappedLine>> line_maps_;  // made so far
};

}  // namespace plumbline
