// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_mapper.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/landmark_creation.h"
#include "plumbline/mapping/landmark_culling.h"
#include "plumbline/mapping/local_ba_window.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/mapping/whole_map_adjustment.h"
#include "plumbline/matching/fusion.h"
#include "plumbline/optimization/pose_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

namespace plumbline {
namespace {

// A correction is not worth changing all keyframes for if it changes no disparity by more than
// this.
constexpr double kMinChangePx = 0.02;

// Returns the largest difference of two corrections over a grid of places of the image.
double MaxDifference(const RectifiedCamera& camera,
                     const StereoCorrection& a,
                     const StereoCorrection& b) {
  constexpr int kSteps = 4;
  double largest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d px(i * camera.width / kSteps, j * camera.height / kSteps);
      largest = std::max(largest, std::abs(a.At(px) - b.At(px)));
    }
  }
  return largest;
}

// Returns the keyframe with a number, searched from the newest on; nullptr if it was removed.
const KeyFrame* WithNumber(const Map& map, std::int64_t number) {
  const auto& keyframes = map.keyframes();
  auto keyframe = keyframes.rbegin();
  while (keyframe != keyframes.rend() && keyframe->second.number > number) ++keyframe;
  const bool found = keyframe != keyframes.rend() && keyframe->second.number == number;
  return found ? &keyframe->second : nullptr;
}

template <class LandmarkId>
std::vector<ShownLandmark<LandmarkId>> ShownBy(const Map& map,
                                               const std::vector<LandmarkId>& matches) {
  std::vector<ShownLandmark<LandmarkId>> shown(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].valid()) shown[i] = {matches[i], map.Find(matches[i])->observations.size()};
  }
  return shown;
}

// Refreshes the appearance of the landmarks of one kind. Landmarks that have not changed are left
// out.
template <class Refresh, class LandmarkId>
void RefreshChanged(const std::vector<ShownLandmark<LandmarkId>>& before,
                    const std::vector<ShownLandmark<LandmarkId>>& now,
                    MapEdit& edit) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    const bool changed = before.empty() || !(before[i] == now[i]);
    if (now[i].id.valid() && changed) edit.push_back(Refresh{now[i].id});
  }
}

// Applies AdjustWholeMap. Features are corrected to a new lens as soon as it is known: those with
// the earlier one would take as much memory again beside the adjustment.
void AdjustInPlace(const CameraAndPyramid& imaging,
                   const LineSettings& lines,
                   const MappingOptions& options,
                   const StopCheck& stop,
                   AdjustmentProgress& progress,
                   Map& map) {
  const FeatureCorrection before = map.correction();
  progress.on_lens = [&](const LensCorrection& lens) {
    map.Apply({edit::CorrectFeatures{{before.stereo, lens}}});
  };
  const auto take_back = [&] {
    if (!(map.correction() == before)) map.Apply({edit::CorrectFeatures{before}});
  };
  MapCorrection found;
  try {
    found = AdjustWholeMap(map, imaging, lines, options, stop, &progress);
  } catch (...) {
    take_back();
    throw;
  }
  if (found.empty()) take_back();
  map.Apply(RebaseCorrection(found, map));
}

}  // namespace

LocalMapper::LocalMapper(const CameraAndPyramid& imaging,
                         const LineSettings& lines,
                         const MappingOptions& options)
    : imaging_(imaging),
      lines_(lines),
      options_(options),
      point_aligner_(imaging.camera, imaging.octave_scale),
      calibrator_(imaging.camera) {}

std::vector<MappingStep> LocalMapper::Add(Map& map,
                                          const KeyFrame& keyframe,
                                          const TrackingScores& scores,
                                          const ImagePyramid* pyramid) {
  const KeyFrameId id = keyframe.id;
  std::vector<MappingStep> times;
  ShownLandmarks refreshed;
  Map::Undo undo(map);
  Timed("take_in", times, [&] { refreshed = InsertKeyFrame(map, keyframe, scores); });
  Timed("create", times, [&] { CreateLandmarks(map, id); });
  Timed("fuse", times, [&] { Fuse(map, id, refreshed); });
  if (pyramid != nullptr) Timed("align", times, [&] { AlignPoints(map, id, *pyramid); });
  Timed("adjust", times, [&] { Adjust(map, id); });
  if (options_.stereo_calibration && MeasuresDepth(imaging_.camera)) {
    Timed("calibrate", times, [&] { CalibrateStereo(map, id); });
  }
  Timed("clean_up", times, [&] {
    map.Apply(RemoveRedundantKeyFrames(map, id, options_.cleanup));
    map.Apply(RemoveRevisitedKeyFrames(map, id, options_.cleanup));
  });
  undo.Keep();
  return times;
}

void LocalMapper::GoOnInAnotherMap() { stereo_change_.GiveUp(); }

void LocalMapper::FollowJoins(const Atlas& atlas) {
  stereo_change_.FollowJoins(atlas);
  for (auto of_map = young_.begin(); of_map != young_.end();) {
    const MapId current = atlas.Current(of_map->first);
    if (current == of_map->first) {
      ++of_map;
      continue;
    }
    const LandmarkIds gone = std::move(of_map->second);
    of_map = young_.erase(of_map);
    LandmarkIds& kept = young_[current];
    kept.points.insert(kept.points.end(), gone.points.begin(), gone.points.end());
    kept.lines.insert(kept.lines.end(), gone.lines.begin(), gone.lines.end());
  }
}

void LocalMapper::StartNewMap(Map& map) {
  GoOnInAnotherMap();
  map.Apply({edit::CorrectFeatures{{calibrator_.Estimate()}}});
}

MapCorrection LocalMapper::ToLens(const Map& map, const LensCorrection& lens) const {
  return BringToLens(map, imaging_, lines_.weights(), options_, lens);
}

void LocalMapper::SetState(const State& state) {
  young_ = state.young;
  calibrator_.SetEvidence(state.stereo_evidence);
}

std::vector<MappingStep> LocalMapper::Start(Map& map, const MapEdit& edit, KeyFrameId newest) {
  std::vector<MappingStep> times;
  Timed("take_in", times, [&] {
    map.Apply(edit);
    AddToProbation(map.id(), edit);
  });
  Timed("adjust", times, [&] { Adjust(map, newest); });
  Timed("create", times, [&] { CreateLandmarks(map, newest); });
  return times;
}

std::vector<MappingStep> LocalMapper::AdjustLoopNeighbourhood(Map& map,
                                                              KeyFrameId newest,
                                                              KeyFrameId older) {
  std::vector<MappingStep> times;
  Timed("tie", times, [&] {
    for (const KeyFrameId id : {older, newest}) {
      Fuse(map, id, {});
      Adjust(map, id);
    }
  });
  return times;
}

bool LocalMapper::AdjustsAtEnd(const Map& map, const StopCheck& stop) const {
  return IsAdjustedAsAWhole(map, imaging_, lines_.weights(), options_, stop);
}

std::vector<MappingStep> LocalMapper::Finish(Map& map, const StopCheck& stop) const {
  constexpr int kRounds = 2;  // in the second round, better poses find more segments of each line
  if (stereo_change_.Running(map)) {
    map.Apply({edit::CorrectFeatures{{stereo_change_.correction(), map.correction().lens}}});
  }
  MappingOptions options = options_;
  AdjustmentProgress progress;
  for (int round = 0; round < kRounds; ++round) {
    AdjustInPlace(imaging_, lines_, options, stop, progress, map);
    options.lens_calibration = false;  // the first round has learned the lens
  }
  std::vector<MappingStep>& times = progress.times;
  Timed("finish_outliers", times, [&] { map.Apply(RemoveOutliers(map, imaging_, lines_)); });
  return std::move(times);
}

// Puts a keyframe into the map and updates scores and appearance of the landmarks that it shows.
// Returns these landmarks.
LocalMapper::ShownLandmarks LocalMapper::InsertKeyFrame(Map& map,
                                                        const KeyFrame& keyframe,
                                                        const TrackingScores& scores) {
  MapEdit edit{edit::AddKeyFrame{keyframe}};
  for (const auto& [id, score] : scores.points) {
    edit.push_back(edit::ScorePoint{id, score.visible, score.found});
  }
  for (const auto& [id, score] : scores.lines) {
    edit.push_back(edit::ScoreLine{id, score.visible, score.found});
  }
  map.Apply(edit);
  ShownLandmarks refreshed = Refresh(map, keyframe.id, {});
  map.Apply(RemoveWeakLandmarks(map, keyframe.id, young_[map.id()]));
  return refreshed;
}

// Refreshes the appearance of the landmarks that a keyframe shows. Landmarks that the same features
// show as before are left out, because nothing moves in between. Returns the landmarks that the
// keyframe shows now.
LocalMapper::ShownLandmarks LocalMapper::Refresh(Map& map,
                                                 KeyFrameId id,
                                                 const ShownLandmarks& before) {
  const Frame& frame = map.Find(id)->frame;
  ShownLandmarks now{ShownBy(map, frame.points), ShownBy(map, frame.lines)};
  MapEdit edit;
  RefreshChanged<edit::RefreshPoint>(before.points, now.points, edit);
  RefreshChanged<edit::RefreshLine>(before.lines, now.lines, edit);
  map.Apply(edit);
  return now;
}

void LocalMapper::CreateLandmarks(Map& map, KeyFrameId id) {
  const auto create = [&](const MapEdit& edit) {
    map.Apply(edit);
    AddToProbation(map.id(), edit);
  };
  create(CreateFromDepth(map, imaging_, id, options_.creation));
  create(CreatePointsFromViews(map, imaging_, id, options_.creation));
  create(CreateLinesFromViews(map, imaging_, id, lines_));
}

// Adds the landmarks that an edit creates to the recent ones of the map, which are on probation.
void LocalMapper::AddToProbation(MapId map, const MapEdit& edit) {
  LandmarkIds& young = young_[map];
  for (const MapChange& change : edit) {
    if (const auto* point = std::get_if<edit::AddPoint>(&change)) {
      young.points.push_back(point->landmark.id);
    } else if (const auto* line = std::get_if<edit::AddLine>(&change)) {
      young.lines.push_back(line->landmark.id);
    }
  }
}

void LocalMapper::Fuse(Map& map, KeyFrameId id, const ShownLandmarks& refreshed) const {
  FusionInto into_keyframe(map, imaging_, id);
  for (const auto& neighbour : ClosestCovisible(map, id, options_.fusion_neighbours)) {
    FusionInto into_neighbour(map, imaging_, neighbour.id);
    map.Apply(into_neighbour.Fuse(id));
    map.Apply(into_keyframe.Fuse(neighbour.id));
  }
  Refresh(map, id, refreshed);
}

void LocalMapper::AlignPoints(Map& map, KeyFrameId id, const ImagePyramid& pyramid) {
  auto aligned = point_aligner_.Align(map, id, pyramid);
  if (aligned != nullptr) map.Apply({edit::MoveFeatures{id, std::move(aligned)}});
}

void LocalMapper::Adjust(Map& map, KeyFrameId id) {
  LocalBaWindow window = MakeLocalBaWindow(map, imaging_, id, lines_, options_.window);
  BaProblem& problem = window.problem;
  const std::optional<BaResult> result =
      SolveWithPoseLimits(problem,
                          options_.ba,
                          lines_.method.adjust_window,
                          options_.window.local_limits(),
                          [&](BaResult& solution) { FixScaleToOldestKeyFrame(problem, solution); });
  if (!result) return;
  adjusted_lines_.count += problem.lines.size();
  adjusted_lines_.bytes += result->line_bytes;
  map.Apply(ToEdit(map, imaging_, window, *result));
}

// Learns the correction from the keyframe kDelay before this one, since by now later keyframes show
// its landmarks as well.
void LocalMapper::CalibrateStereo(Map& map, KeyFrameId id) {
  constexpr std::int64_t kDelay = 3;
  const KeyFrame* keyframe = WithNumber(map, map.NumberOf(id) - kDelay);
  if (keyframe != nullptr) calibrator_.Observe(map, *keyframe);
  if (!stereo_change_.Running(map)) {
    const StereoCorrection correction = calibrator_.Estimate();
    if (MaxDifference(imaging_.camera, correction, map.correction().stereo) > kMinChangePx) {
      stereo_change_.Begin(map, correction);
    }
  }
  stereo_change_.Step(map);
}

}  // namespace plumbline
