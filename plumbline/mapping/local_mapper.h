// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/map.h"
#include "plumbline/map/recent_landmarks.h"
#include "plumbline/mapping/adjusted_lines.h"
#include "plumbline/mapping/landmark_culling.h"
#include "plumbline/mapping/map_correction.h"
#include "plumbline/mapping/options.h"
#include "plumbline/mapping/point_alignment.h"
#include "plumbline/mapping/stereo_calibration.h"
#include "plumbline/mapping/stereo_change.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/matching/projection_search.h"

#include <cstddef>
#include <deque>
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

// A landmark that a feature shows, and the number of keyframes that show it.
template <class LandmarkId>
struct ShownLandmark {
  LandmarkId id = {};
  std::size_t views = 0;

  friend bool operator==(const ShownLandmark&, const ShownLandmark&) = default;
};

// Takes keyframes into the map, one after the other: observations, landmarks from depth and from
// several views, duplicates, local bundle adjustment, calibration of the stereo pair, clean-up.
// Each step reads the map and returns a MapEdit, which is applied here.
class LocalMapper {
 public:
  LocalMapper(const CameraAndPyramid& imaging,
              const LineOptions& lines,
              const MappingOptions& options);

  // Sets the options for all that is done from now on.
  void SetOptions(const MappingOptions& options) { options_ = options; }

  // Takes in a keyframe, with the scores that tracking counted since the last one. Where the
  // pyramid of its rectified left image is given (BuildOrbPyramid), points are aligned
  // (PointAligner). Returns the time of each step, in order. Where anything is thrown, the map is
  // as it was.
  std::vector<MappingStep> Add(Map& map,
                               const KeyFrame& keyframe,
                               const TrackingScores& scores,
                               const ImagePyramid* pyramid = nullptr);

  // Begins a map with several keyframes, of which `newest` is the last, and their landmarks. `edit`
  // makes them from the empty map. All of the map is adjusted, then new landmarks of `newest` are
  // created. Returns the time of each step, in order.
  std::vector<MappingStep> Start(Map& map, const MapEdit& edit, KeyFrameId newest);

  // Ties two keyframes that were far apart in the map and were found to see the same place. The
  // landmarks that both show must be fused already. More of them are searched around both
  // keyframes, and the surroundings of both are adjusted. Returns the time of each step, in order.
  std::vector<MappingStep> AdjustLoopNeighbourhood(Map& map, KeyFrameId newest, KeyFrameId older);

  // Adjusts the whole of a map to which nothing will be added, twice (AdjustWholeMap), with the
  // stereo correction that it was about to get, and removes what does not fit then
  // (RemoveOutliers). When stopped, the poses are those of the last adjustment that was completed.
  // Returns the time of each step, in order.
  std::vector<MappingStep> Finish(Map& map, const StopCheck& stop = {}) const;

  // Gives a new, empty map what was learned about a pair of cameras.
  void StartNewMap(Map& map);
  // Returns what adjusts a map of a single camera to the lens that another map has learned.
  MapCorrection ToLens(const Map& map, const LensCorrection& lens) const;
  // Tells that keyframes of another map are taken in from now on.
  void GoOnInAnotherMap();
  // Follows maps of the atlas that were joined since the last call; to be called after a join.
  void FollowJoins(const Atlas& atlas);

  // Counts the lines that took part in local adjustments so far, over all maps and windows.
  const AdjustedLines& adjusted_lines() const { return adjusted_lines_; }

  // What the mapper knows about its maps beside them, as map files keep it (AtlasContext).
  struct State {
    std::map<MapId, RecentLandmarks> young;
    StereoEvidence stereo_evidence;
  };
  State state() const { return {young_, calibrator_.evidence()}; }
  void SetState(const State& state);

 private:
  // The landmarks that a keyframe shows, by feature.
  struct ShownLandmarks {
    std::vector<ShownLandmark<PointId>> points;
    std::vector<ShownLandmark<LineId>> lines;
  };

  ShownLandmarks InsertKeyFrame(Map& map, const KeyFrame& keyframe, const TrackingScores& scores);
  static ShownLandmarks Refresh(Map& map, KeyFrameId id, const ShownLandmarks& before);
  void CreateLandmarks(Map& map, KeyFrameId id);
  void AddToProbation(MapId map, const MapEdit& edit);
  void Fuse(Map& map, KeyFrameId id, const ShownLandmarks& refreshed) const;
  void AlignPoints(Map& map, KeyFrameId id, const ImagePyramid& pyramid);
  void Adjust(Map& map, KeyFrameId id);
  void CalibrateStereo(Map& map, KeyFrameId id);

  CameraAndPyramid imaging_;
  LineOptions lines_;
  MappingOptions options_;
  std::map<MapId, RecentLandmarks> young_;
  PointAligner point_aligner_;
  StereoCalibrator calibrator_;
  StereoChange stereo_change_;
  AdjustedLines adjusted_lines_;
};

}  // namespace plumbline
