// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/map.h"
#include "plumbline/mapping/landmark_culling.h"
#include "plumbline/mapping/map_correction.h"
#include "plumbline/mapping/mapped_line.h"
#include "plumbline/mapping/mapping_step.h"
#include "plumbline/mapping/options.h"
#include "plumbline/mapping/point_alignment.h"
#include "plumbline/mapping/stereo_calibration.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/matching/projection_search.h"

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

namespace plumbline {

// A landmark of a feature, and the number of keyframes that show it.
template <class LandmarkId>
struct ShownLandmark {
  LandmarkId id = {};
  std::size_t views = 0;

  friend bool operator==(const ShownLandmark&, const ShownLandmark&) = default;
};

// Inserts keyframes into the map: observations, landmarks from depth and from several views,
// duplicates, local bundle adjustment, calibration of the stereo pair, clean-up. Each step reads
// the map and returns a MapEdit, which is applied here.
class LocalMapper {
 public:
  LocalMapper(const CameraAndPyramid& imaging,
              const LineSettings& lines,
              const MappingOptions& options);

  // Sets the options for all later steps.
  void SetOptions(const MappingOptions& options) { options_ = options; }

  // Inserts a keyframe, with the tracking scores since the last one. If the pyramid of its
  // rectified left image is given (BuildOrbPyramid), points are aligned (PointAligner). Returns the
  // time of each step, in order. If it throws, the map is unchanged.
  std::vector<MappingStep> Add(Map& map,
                               const KeyFrame& keyframe,
                               const TrackingScores& scores,
                               const ImagePyramid* pyramid = nullptr);

  // Begins a map with several keyframes, of which `newest` is the last, and their landmarks: `edit`
  // creates them in the empty map. The whole map is adjusted, then new landmarks of `newest` are
  // created. Returns the time of each step, in order.
  std::vector<MappingStep> Start(Map& map, const MapEdit& edit, KeyFrameId newest);

  // Adjusts the neighbourhoods of two keyframes that see the same place but were far apart in the
  // map. Their common landmarks must be fused already. More of them are searched around both
  // keyframes, then both neighbourhoods are adjusted. Returns the time of each step, in order.
  std::vector<MappingStep> AdjustLoopNeighbourhood(Map& map, KeyFrameId newest, KeyFrameId older);

  // Returns true if Finish adjusts a map as a whole (IsAdjustedAsAWhole).
  bool AdjustsAtEnd(const Map& map, const StopCheck& stop) const;

  // Adjusts a finished map twice (AdjustWholeMap), with its pending stereo correction, and removes
  // outliers (RemoveOutliers). When stopped, the poses are those of the last completed adjustment.
  // Returns the time of each step, in order: "finish_lens", "finish_lines" and "finish_adjust" of
  // each adjustment, and "finish_outliers".
  std::vector<MappingStep> Finish(Map& map, const StopCheck& stop = {}) const;

  // Applies the learned stereo correction to a new, empty map.
  void StartNewMap(Map& map);
  // Returns the correction that adjusts a map of a single camera to the lens learned in another
  // map.
  MapCorrection ToLens(const Map& map, const LensCorrection& lens) const;
  // Prepares for keyframes of another map.
  void GoOnInAnotherMap();
  // Follows merges of maps of the atlas since the last call; call it after each merge.
  void FollowJoins(const Atlas& atlas);

  // Statistics of the lines in local adjustments so far, over all maps and windows.
  const AdjustedLines& adjusted_lines() const { return adjusted_lines_; }

  // State kept from keyframe to keyframe. A mapper of the same options that gets the state and the
  // map of another mapper continues like it.
  struct State {
    std::map<MapId, LandmarkIds> young;  // recent landmarks, still on probation
    StereoEvidence stereo_evidence;
  };
  State state() const { return {young_, calibrator_.evidence()}; }
  void SetState(const State& state);

 private:
  // Landmarks of a keyframe, by feature.
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
  LineSettings lines_;
  MappingOptions options_;
  std::map<MapId, LandmarkIds> young_;
  PointAligner point_aligner_;
  StereoCalibrator calibrator_;
  StereoChange stereo_change_;
  AdjustedLines adjusted_lines_;
};

}  // namespace plumbline
