// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/line_options.h"
#include "plumbline/association/projection_search.h"
#include "plumbline/base/stop_check.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/map.h"
#include "plumbline/map/young_landmarks.h"
#include "plumbline/mapping/landmark_cleanup.h"
#include "plumbline/mapping/options.h"
#include "plumbline/mapping/stereo_calibration.h"
#include "plumbline/mapping/stereo_change.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Milliseconds spent in one step of a keyframe's mapping.
struct MappingStep {
  std::string name;
  double milliseconds = 0;
};

// What local bundle adjustment held in memory for its lines, summed over all windows.
struct AdjustedLines {
  std::size_t count = 0;
  std::size_t bytes = 0;
};

// A landmark that a feature shows, and how many keyframes show it.
template <class LandmarkId>
struct ShownLandmark {
  LandmarkId id = {};
  std::size_t views = 0;

  friend bool operator==(const ShownLandmark&, const ShownLandmark&) = default;
};

// Takes keyframes into the map, one after the other: observations, landmarks from depth and from
// several views, duplicates, local bundle adjustment, calibration of the stereo pair, clean-up.
// Each step reads the map and returns a MapEdit, applied here.
class LocalMapper {
 public:
  LocalMapper(const ImagingModel& imaging, const LineOptions& lines, const MappingOptions& options);

  // For what is done from now on.
  void SetOptions(const MappingOptions& options) { options_ = options; }

  // Returns the time of each step, in order.
  std::vector<MappingStep> Add(Map& map, const KeyFrame& keyframe, const TrackingScores& scores);

  // Begins a map with several keyframes and their landmarks (an edit of the empty map), of which
  // `newest` is the last: bundle adjustment of all of it, then new landmarks of `newest`. Times as
  // Add's.
  std::vector<MappingStep> Start(Map& map, const MapEdit& edit, KeyFrameId newest);

  // Two keyframes that were far apart in the map were found to see the same place, and what both
  // show is fused: looks for more of it around both, and adjusts the surroundings of both. Times as
  // Add's.
  std::vector<MappingStep> Tie(Map& map, KeyFrameId newest, KeyFrameId older);

  // Adjusts the whole of a map to which nothing will be added, twice (AdjustWholeMap), with the
  // stereo correction that it was about to get. When
  // stopped, what is not done is left out: the map is that of the last adjustment that was
  // completed. Times as Add's.
  std::vector<MappingStep> Finish(Map& map, const StopCheck& stop = {}) const;

  // A new, empty map begins with what was learned of the camera.
  void StartNewMap(Map& map);
  // What follows is about another map than what came before.
  void GoOnInAnotherMap();
  // Some maps of the atlas may have taken others in since the last call.
  void FollowJoins(const Atlas& atlas);

  // The lines that took part in the adjustment of all maps so far.
  const AdjustedLines& adjusted_lines() const { return adjusted_lines_; }

  // What is remembered from keyframe to keyframe. A mapper of the same options that is given the
  // state of another one, and its map, does what the other would do.
  struct State {
    std::map<MapId, YoungLandmarks> young;
    StereoEvidence stereo_evidence;
    AdjustedLines adjusted_lines;
    std::optional<StereoChange::State> stereo_change = {};
  };
  State state() const;
  void SetState(const State& state);

 private:
  // Of a keyframe, by feature.
  struct ShownLandmarks {
    std::vector<ShownLandmark<PointId>> points;
    std::vector<ShownLandmark<LineId>> lines;
  };

  ShownLandmarks TakeIn(Map& map, const KeyFrame& keyframe, const TrackingScores& scores);
  static ShownLandmarks Refresh(Map& map, KeyFrameId id, const ShownLandmarks& before);
  void CreateLandmarks(Map& map, KeyFrameId id);
  void Watch(MapId map, const MapEdit& edit);
  void Fuse(Map& map, KeyFrameId id, const ShownLandmarks& refreshed) const;
  void Adjust(Map& map, KeyFrameId id);
  void CalibrateStereo(Map& map, KeyFrameId id);

  ImagingModel imaging_;
  LineOptions lines_;
  MappingOptions options_;
  std::map<MapId, YoungLandmarks> young_;
  StereoCalibrator calibrator_;
  StereoChange stereo_change_;
  AdjustedLines adjusted_lines_;
};

}  // namespace plumbline
