// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/atlas.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/slam/background_adjustment.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/initial_map_edit.h"
#include "plumbline/slam/load_control.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/place_recognition.h"
#include "plumbline/slam/system_methods.h"
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// Relocalization of a lost frame by appearance in all maps.
struct RelocalizationRequest {
  Frame frame;
};
// Result of a RelocalizationRequest.
struct RelocalizationOutcome {
  std::optional<Relocalized> found;  // nullopt if relocalization failed
  // The map around the candidate from which the pose was found.
  std::shared_ptr<const MapSnapshot> snapshot;
};

// Makes an earlier map active again, in which the lost camera was relocalized.
struct SwitchMap {
  MapId map;
  KeyFrameId keyframe;  // the keyframe nearest to the camera
};

// Requests a snapshot around the landmarks that the camera sees, since it has left the area of the
// last snapshot.
struct UpdateLocalMapRequest {
  MapId map;
  std::vector<PointId> points;
  std::vector<LineId> lines;
};

// Calls a function with the maps, between two keyframes and in the mapping thread.
struct MapReader {
  std::function<void(const Atlas&, const LocalMapper&, const PlaceRecognition&)> look;
};

// A task of the mapper.
struct MapCommand {
  std::variant<std::shared_ptr<const NewKeyFrame>,
               InitialMapEdit,
               RelocalizationRequest,
               SwitchMap,
               UpdateLocalMapRequest,
               MapReader>
      work;
  std::int64_t frame = 0;   // frame of submission
  bool starts_map = false;  // true if the keyframes open a new map
};

// Result of a MapCommand.
struct MapUpdate {
  std::shared_ptr<const MapSnapshot> snapshot;  // null: the last snapshot remains valid
  std::vector<MappingStep> times;
  std::optional<RelocalizationOutcome> relocalization;
};

// Owner and only writer of the maps: inserts keyframes and returns snapshots. It has no thread of
// its own (see MapperThread), and its results do not depend on time.
//
// A map whose shape has changed at large is adjusted as a whole in the background
// (BackgroundAdjustment), and so is a map of one camera with at least 16 keyframes that determine
// the lens. The correction is applied before the first command, other than a MapReader, submitted
// at or after its due frame; a live run with threads applies it as soon as it is ready. It is
// rebased on the current map (RebaseCorrection), and is in that command's snapshot.
//
// A recent map of one camera whose scale drifts is withdrawn (PlaceRecognition::Withdraws), and its
// later snapshots are marked so.
class Mapper {
 public:
  Mapper(const CameraAndPyramid& imaging,
         const SlamOptions& options,
         const Execution& execution,
         const SystemMethods& methods = {});
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  // Begins with existing maps, one of them active, and the state of the mapper that made them. To
  // be called before the first command.
  void Continue(Atlas atlas, const LocalMapper::State& state);
  // Sets the observer of recognized places. To be called before the first command.
  void Observe(PlaceObserver observer) { places_.Observe(std::move(observer)); }

  // Executes the command. In a live run `load` says which work is left out. Each change of a map,
  // and each start of one, is atomic even if something throws (Map::Undo).
  MapUpdate Process(const MapCommand& command, LoadLevel load);

  // Adjusts each changed map as a whole (`stop` ends the adjustment early). A map that is too large
  // for that gets the correction that is computed in the background, and so does one when stopped,
  // if the correction is ready. Then maps that were adjusted to a lens are moved back to their
  // world. Afterwards no keyframe may be added to a map that is tracked against.
  std::vector<MappingStep> Finish(const StopCheck& stop);

  // Moves the maps of this mapper's atlas, or of a copy of it, each as a whole, so that the first
  // keyframe has its pose from before the map was adjusted to a lens: the world is the camera of
  // that keyframe.
  void MoveFirstKeyFramesBack(Atlas& atlas) const;

  const Atlas& atlas() const { return atlas_; }
  // Takes the maps out, as the last step of a run; afterwards there are none.
  Atlas TakeAtlas() { return std::exchange(atlas_, {}); }
  // Closed loops and merged maps, the oldest first.
  const PlaceRecognition& places() const { return places_; }
  // Number and memory of the lines in local bundle adjustment; the mapper's state of the maps.
  const AdjustedLines& adjusted_lines() const { return local_.adjusted_lines(); }
  LocalMapper::State state() const { return local_.state(); }

 private:
  struct PlacedKeyFrame {
    KeyFrameId id;
    Rigid3 cam_from_world;
  };

  MapUpdate Process(const MapCommand& command);
  MapUpdate StartMap(const MapCommand& command);
  // `frame` is the frame of submission.
  MapUpdate Process(const std::shared_ptr<const NewKeyFrame>& added, std::int64_t frame);
  MapUpdate Process(const InitialMapEdit& start, std::int64_t frame);
  MapUpdate Process(const RelocalizationRequest& request, std::int64_t frame);
  MapUpdate Process(const SwitchMap& back, std::int64_t frame);
  MapUpdate Process(const UpdateLocalMapRequest& request, std::int64_t frame);
  MapUpdate Process(const MapReader& reader, std::int64_t frame);
  void Recognize(KeyFrameId id, std::int64_t frame, std::vector<MappingStep>& times);
  void CalibrateRadialDistortion(KeyFrameId newest, std::int64_t frame);
  void TakeKnownLens(Map& map);
  void Apply(const MapCorrection& correction, Map& map);
  void FollowJoins();
  void TakeCorrection(std::int64_t frame);
  void TakeLastCorrection(const StopCheck& stop);
  void Take(const std::optional<BackgroundAdjustment::Result>& found);
  std::shared_ptr<const MapSnapshot> TakeSnapshotAround(const Map& map, KeyFrameId centre);

  RunMode mode_;
  bool corrects_when_ready_;  // in a live run with threads
  RectifiedCamera camera_;
  MappingOptions options_;  // lens_calibration is reset once the lens is known to be right
  LocalMapper local_;
  Relocalizer relocalizer_;
  PlaceRecognition places_;
  Atlas atlas_;
  // Maps changed since they were loaded or last adjusted as a whole.
  std::set<MapId> changed_;
  std::deque<KeyFrameId> centres_;  // centres of the last snapshots
  // Poses of the first keyframes of maps before the maps were adjusted to a lens.
  std::map<MapId, PlacedKeyFrame> first_places_;
  // Number of keyframes of each map at the last attempt to calibrate its lens.
  std::map<MapId, std::int64_t> lens_asked_;
  BackgroundAdjustment adjustment_;
  std::function<MapCorrection(const MappingOptions&, const Map&, const StopCheck&)> adjust_map_,
      adjust_to_lens_;
};

}  // namespace plumbline
