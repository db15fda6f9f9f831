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
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <variant>
#include <vector>

namespace plumbline {

// Asks for the place of a lost frame in one of the maps, by appearance.
struct RelocalizationRequest {
  Frame frame;
};
// Result of a RelocalizationRequest.
struct RelocalizationOutcome {
  std::optional<Relocalized> found;  // nullopt if the place was not found
  // The map around the keyframe from which the place was found.
  std::shared_ptr<const MapSnapshot> snapshot;
};

// Makes a map active again that the camera had left: the lost camera was found in it.
struct SwitchMap {
  MapId map;
  KeyFrameId keyframe;  // the keyframe beside which the camera is
};

// Asks for a snapshot around the landmarks that the camera sees, which has left the surroundings
// that the last snapshot shows.
struct UpdateLocalMapRequest {
  MapId map;
  std::vector<PointId> points;
  std::vector<LineId> lines;
};

// Calls a function with the maps, between two keyframes and in the thread that maps.
struct MapReader {
  std::function<void(const Atlas&, const LocalMapper&, const PlaceRecognition&)> look;
};

// A piece of work for the mapper.
struct MapCommand {
  std::variant<std::shared_ptr<const NewKeyFrame>,
               InitialMapEdit,
               RelocalizationRequest,
               SwitchMap,
               UpdateLocalMapRequest,
               MapReader>
      work;
  std::int64_t frame = 0;   // the frame at which it was submitted
  bool starts_map = false;  // the keyframes open a new map
};

// Result of a MapCommand.
struct MapUpdate {
  std::shared_ptr<const MapSnapshot> snapshot;  // null: the snapshot before stays in use
  std::vector<MappingStep> times;
  std::optional<RelocalizationOutcome> relocalization;
};

// Owns the maps and is the only one to write them: takes keyframes in and gives snapshots. It has
// no thread of its own (MapperThread has), and its results do not depend on the time.
//
// A map whose shape has changed at large is adjusted as a whole beside mapping
// (BackgroundAdjustment), and so is a map of one camera that has 16 keyframes or more and tells of
// the lens. The correction is applied before the first command that was submitted at or after the
// frame at which it is due and is no MapReader, which changes no result; a live run with threads
// applies it as soon as it is ready. It is applied to the map as it is then (RebaseCorrection), and
// shows in that command's snapshot.
//
// A recent map of one camera whose scale runs away is withdrawn (PlaceRecognition::Withdraws). Its
// snapshots say so from then on.
class Mapper {
 public:
  Mapper(const CameraAndPyramid& imaging, const SlamOptions& options, const Execution& execution);
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  // Begins with maps that exist already, of which one is active, and with the state of the mapper
  // that made them. To be called before the first command.
  void Continue(Atlas atlas, const LocalMapper::State& state);
  // Sets the observer of recognized places. To be called before the first command.
  void Observe(PlaceObserver observer) { places_.Observe(std::move(observer)); }

  // Does what the command asks for. In a live run `load` says what is left out of the work. Each
  // change of a map happens whole or not at all, whatever throws (Map::Undo), and so does the start
  // of a map.
  MapUpdate Process(const MapCommand& command, LoadLevel load);

  // Adjusts each map that has changed as a whole (`stop` cuts the adjustment short), and moves maps
  // that were adjusted to a lens back to their world. After that no keyframe may be added to a map
  // that is to be tracked against.
  std::vector<MappingStep> Finish(const StopCheck& stop);

  // Moves the maps of this mapper's atlas, or of a copy of it, each as a whole, so that the first
  // keyframe is where it was before the map was adjusted to a lens: the world is the camera of that
  // keyframe.
  void MoveFirstKeyFramesBack(Atlas& atlas) const;

  const Atlas& atlas() const { return atlas_; }
  // Loops that were closed and maps that were joined, the oldest first.
  const PlaceRecognition& places() const { return places_; }
  // The lines that local bundle adjustment held in memory, and the mapper's memory of the maps.
  const AdjustedLines& adjusted_lines() const { return local_.adjusted_lines(); }
  LocalMapper::State state() const { return local_.state(); }

 private:
  struct PlacedKeyFrame {
    KeyFrameId id;
    Rigid3 cam_from_world;
  };

  MapUpdate Process(const MapCommand& command);
  MapUpdate StartMap(const MapCommand& command);
  // `frame` is the frame at which the command was submitted.
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
  std::shared_ptr<const MapSnapshot> TakeSnapshotAround(const Map& map, KeyFrameId centre);

  RunMode mode_;
  bool corrects_when_ready_;  // in a live run with threads
  RectifiedCamera camera_;
  MappingOptions options_;
  LocalMapper local_;
  Relocalizer relocalizer_;
  PlaceRecognition places_;
  Atlas atlas_;
  // Maps that changed since they were loaded or last adjusted as a whole.
  std::set<MapId> changed_;
  std::deque<KeyFrameId> centres_;  // centres of the last snapshots
  // Poses of the first keyframes of maps before the maps were adjusted to a lens.
  std::map<MapId, PlacedKeyFrame> first_places_;
  // Numbers of keyframes that maps had when the lens was last asked for.
  std::map<MapId, std::int64_t> lens_asked_;
  BackgroundAdjustment adjustment_;
  BackgroundAdjustment::Compute adjust_map_, adjust_to_lens_;
};

}  // namespace plumbline
