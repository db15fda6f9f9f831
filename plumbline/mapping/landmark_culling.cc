// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/landmark_culling.h"

#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>

namespace plumbline {
namespace {

// A recent landmark must be found in this share of the frames in which it is predicted.
constexpr double kMinFoundRatio = 0.25;
// A landmark is on trial for so many keyframes. After that at least kMinObservations keyframes must
// show it: a landmark that one keyframe shows ties nothing together.
constexpr int kTrialKeyFrames = 3;
constexpr int kMinObservations = 2;
// A keyframe is redundant if so many others show its landmarks. With three, a landmark keeps two
// views when one of these is removed later.
constexpr int kRedundantViews = 3;

enum class Verdict { kKeepWatching, kPassed, kRemove };

template <class Landmark>
Verdict Judge(const Map& map, const Landmark* landmark, KeyFrameId newest) {
  if (landmark == nullptr) return Verdict::kPassed;  // it was removed before
  if (landmark->score.Ratio() < kMinFoundRatio) return Verdict::kRemove;
  if (map.NumberOf(newest) - map.NumberOf(landmark->created_by) < kTrialKeyFrames) {
    return Verdict::kKeepWatching;
  }
  return static_cast<int>(landmark->observations.size()) < kMinObservations ? Verdict::kRemove
                                                                            : Verdict::kPassed;
}

template <class Remove, class LandmarkId>
void JudgeAll(const Map& map, KeyFrameId newest, std::vector<LandmarkId>& young, MapEdit& edit) {
  std::erase_if(young, [&](LandmarkId id) {
    const Verdict verdict = Judge(map, map.Find(id), newest);
    if (verdict == Verdict::kRemove) edit.push_back(Remove{id});
    return verdict != Verdict::kKeepWatching;
  });
}

int OctaveOf(const Map& map, KeyFrameId keyframe, int feature) {
  return map.Find(keyframe)->frame.features().points[static_cast<std::size_t>(feature)].octave;
}

// Returns true if at least `views` of the observations count. Visits no more observations than
// necessary.
template <class Counts>
bool HasViews(const Observations& observations, int views, const Counts& counts) {
  for (auto o = observations.begin(); o != observations.end() && views > 0; ++o) {
    views -= counts(*o);
  }
  return views <= 0;
}

// Numbers of landmarks that a keyframe shares with at least one other.
struct SharedLandmarks {
  int all = 0;
  // Landmarks that too few other keyframes show to make this one redundant.
  int of_few = 0;
};

template <class LandmarkId>
void CountShared(const Map& map,
                 const std::vector<LandmarkId>& matches,
                 int others,
                 SharedLandmarks& count) {
  for (const LandmarkId id : matches) {
    if (!id.valid()) continue;
    const auto views = static_cast<int>(map.Find(id)->observations.size());
    count.all += views >= 2;
    count.of_few += views >= 2 && views - 1 < others;
  }
}

// Two keyframes whose numbers differ by more than this belong to different visits to a place.
constexpr std::int64_t kVisit = 20;

// The rule by which a keyframe is redundant.
struct Redundancy {
  // Share of a keyframe's landmarks that at least kRedundantViews others must show.
  double share = 0.9;
  bool again = false;  // true: one of these others must be of another visit
};

bool IsOfAnotherVisit(const Map& map, KeyFrameId other, const KeyFrame& keyframe) {
  const std::int64_t apart = map.Find(other)->number - keyframe.number;
  return apart > kVisit || apart < -kVisit;
}

// Returns true if other keyframes show the required share of a keyframe's landmarks, points as
// sharply as this keyframe does. The test of the numbers of views comes first, since it alone
// rejects most keyframes.
bool IsRedundant(const Map& map, const KeyFrame& keyframe, const Redundancy& rule) {
  const Frame& frame = keyframe.frame;
  SharedLandmarks shared;
  CountShared(map, frame.points, kRedundantViews, shared);
  CountShared(map, frame.lines, kRedundantViews, shared);
  const auto is_below_share = [&](int own) { return shared.all - own < rule.share * shared.all; };
  if (shared.all == 0 || is_below_share(shared.of_few)) return false;
  const auto is_met_again = [&](const Observations& observations) {
    return !rule.again || std::any_of(observations.begin(), observations.end(), [&](const auto& o) {
      return IsOfAnotherVisit(map, o.first, keyframe);
    });
  };
  int own = 0;
  for (std::size_t i = 0; i < frame.points.size() && !is_below_share(own); ++i) {
    if (!frame.points[i].valid()) continue;
    const auto& observations = map.Find(frame.points[i])->observations;
    if (observations.size() < 2) continue;
    const int octave = frame.features().points[i].octave;
    const bool redundant = HasViews(observations, kRedundantViews, [&](const auto& o) {
      return o.first != keyframe.id && OctaveOf(map, o.first, o.second) <= octave + 1;
    });
    own += !(redundant && is_met_again(observations));
  }
  for (const LineId id : frame.lines) {
    if (!id.valid()) continue;
    const auto& observations = map.Find(id)->observations;
    const auto views = static_cast<int>(observations.size());
    if (views >= 2) own += !(views - 1 >= kRedundantViews && is_met_again(observations));
  }
  return !is_below_share(own);
}

// Limit of chi2: 4 sigma, which of true observations with two or three residuals 99.97 % and 99.9 %
// keep. Bundle adjustment rejects at 95 %, but while poses still move.
constexpr double kMaxChi2 = 16;
// A landmark that loses observations must keep as many: two lines of sight cross somewhere nearly
// always, so that only a third one tells that they belong together.
constexpr std::size_t kFewestViews = 3;

// Compares landmarks with their observations, at the poses of the map.
class OutlierSearch {
 public:
  OutlierSearch(const Map& map, const CameraAndPyramid& imaging, const LineSettings& lines)
      : map_(map),
        imaging_(imaging),
        weights_(lines.weights()),
        keeps_ends_(lines.method.keeps_ends) {}

  // Adds the changes of a landmark to the edit.
  template <class Remove, class RemoveObservation, class Landmark>
  void Search(const Landmark& landmark, MapEdit& edit) const {
    const Observations agreeing = Agreeing(landmark);
    if (agreeing.size() == landmark.observations.size()) return;
    const Landmark best = BestPlace(landmark, agreeing);
    const std::size_t left = best.observations.size();
    if (left < kFewestViews && left < landmark.observations.size()) {
      edit.push_back(Remove{landmark.id});
      return;
    }
    AddMotion(landmark, best, edit);
    for (const auto& [id, feature] : landmark.observations) {
      if (!best.observations.contains(id)) edit.push_back(RemoveObservation{landmark.id, id});
    }
  }

 private:
  // Returns the landmark at which most of its observations agree, with these alone: unchanged, or
  // fitted to all observations, and then fitted to those that agree. A single wrong observation
  // moves a line that is uncertain far away, and after motions of keyframes nothing agrees with the
  // old position, so that both are tried.
  template <class Landmark>
  Landmark BestPlace(const Landmark& landmark, const Observations& agreeing) const {
    constexpr int kRounds = 4;
    Landmark best = landmark;
    best.observations = agreeing;
    Landmark start = landmark;
    for (int round = 0; round < kRounds; ++round) {
      Landmark fitted = start;
      Fit(fitted);
      fitted.observations = landmark.observations;
      fitted.observations = Agreeing(fitted);
      if (fitted.observations.size() >= best.observations.size()) best = fitted;
      if (best.observations.empty() || best.observations == start.observations) break;
      start = best;
    }
    return best;
  }

  const Frame& FrameOf(KeyFrameId id) const { return map_.Find(id)->frame; }

  // Returns the observations that agree with the landmark.
  Observations Agreeing(const MapPoint& point) const {
    Observations agreeing;
    for (const auto& [id, feature] : point.observations) {
      const Frame& frame = FrameOf(id);
      const auto measured = MeasurePoint(frame.features(), static_cast<std::size_t>(feature));
      const auto chi2 = PointChi2(
          imaging_.camera, MakePointTerm(measured), frame.cam_from_world * point.position);
      if (chi2 && *chi2 <= kMaxChi2) agreeing.emplace(id, feature);
    }
    return agreeing;
  }

  Observations Agreeing(const MapLine& line) const {
    const PreparedLine prepared(ToOrthonormal(line.line));
    Observations agreeing;
    for (const auto& [id, feature] : line.observations) {
      const Frame& frame = FrameOf(id);
      const auto agrees = [&](const LineMeasurement& measured) {
        const auto r = LineDistances(imaging_.camera, frame.cam_from_world, prepared, measured);
        return r && r->squaredNorm() <= kMaxChi2;
      };
      const auto i = static_cast<std::size_t>(feature);
      const auto right = MeasureRightLine(frame.features(), i, weights_);
      if (agrees(MeasureLeftLine(frame.features(), i, weights_)) && (!right || agrees(*right))) {
        agreeing.emplace(id, feature);
      }
    }
    return agreeing;
  }

  // Returns the problem of one landmark, without it: the keyframes that show it, which do not move.
  // Its world is the newest of their cameras, since lines far from the origin are ill conditioned.
  BaProblem ProblemOf(const Observations& observations) const {
    const Rigid3 world_from_problem = Inverse(FrameOf(observations.newest().first).cam_from_world);
    BaProblem problem;
    problem.camera = imaging_.camera;
    for (const auto& [id, feature] : observations) {
      problem.poses.push_back({FrameOf(id).cam_from_world * world_from_problem, true});
    }
    return problem;
  }

  void Fit(MapPoint& point) const {
    BaProblem problem = ProblemOf(point.observations);
    const Rigid3& problem_from_world = FrameOf(point.observations.newest().first).cam_from_world;
    problem.points = {problem_from_world * point.position};
    int pose = 0;
    for (const auto& [id, feature] : point.observations) {
      const auto i = static_cast<std::size_t>(feature);
      problem.point_observations.push_back({pose++, 0, MeasurePoint(FrameOf(id).features(), i)});
    }
    point.position = Inverse(problem_from_world) * SolveLocalBa(problem).points.front();
  }

  void Fit(MapLine& line) const {
    BaProblem problem = ProblemOf(line.observations);
    const Rigid3& problem_from_world = FrameOf(line.observations.newest().first).cam_from_world;
    problem.lines = {ToOrthonormal(Transform(problem_from_world, line.line))};
    int pose = 0;
    for (const auto& [id, feature] : line.observations) {
      const Features& features = FrameOf(id).features();
      const auto i = static_cast<std::size_t>(feature);
      problem.line_observations.push_back({pose, 0, MeasureLeftLine(features, i, weights_)});
      if (const auto right = MeasureRightLine(features, i, weights_)) {
        problem.line_observations.push_back({pose, 0, *right});
      }
      ++pose;
    }
    const PluckerLine fitted = ToPlucker(SolveLocalBa(problem).lines.front());
    line.line = Transform(Inverse(problem_from_world), fitted);
  }

  void AddMotion(const MapPoint& before, const MapPoint& fitted, MapEdit& edit) const {
    edit.push_back(edit::MovePoint{before.id, fitted.position});
  }

  void AddMotion(const MapLine& before, const MapLine& fitted, MapEdit& edit) const {
    MapLine shown = before;
    shown.observations = fitted.observations;
    std::optional<Segment3> kept;
    if (keeps_ends_) kept = before.Interval();
    edit.push_back(RefitInterval(map_, imaging_, {}, shown, fitted.line, kept));
  }

  const Map& map_;
  const CameraAndPyramid& imaging_;
  LineWeights weights_;
  bool keeps_ends_;
};

}  // namespace

MapEdit RemoveWeakLandmarks(const Map& map, KeyFrameId newest, LandmarkIds& young) {
  MapEdit edit;
  JudgeAll<edit::RemovePoint>(map, newest, young.points, edit);
  JudgeAll<edit::RemoveLine>(map, newest, young.lines, edit);
  return edit;
}

namespace {

// Returns the first redundant keyframe among those around `centre`, in the order of covisibility;
// nullptr if none is redundant. The first keyframe of the map, `centre` and the keyframe before it
// are never redundant. Visits at most `most` keyframes.
const KeyFrame* FindRedundant(const Map& map,
                              KeyFrameId centre,
                              std::size_t most,
                              const Redundancy& rule) {
  if (rule.share >= 1) return nullptr;
  const KeyFrameId origin = map.keyframes().begin()->first;
  const auto centre_it = map.keyframes().find(centre);
  const KeyFrameId before =
      centre_it == map.keyframes().begin() ? centre : std::prev(centre_it)->first;
  for (const auto& neighbour : Covisible(map, centre)) {
    if (most-- == 0) break;
    if (neighbour.id == origin || neighbour.id == before) continue;
    const KeyFrame& keyframe = *map.Find(neighbour.id);
    if (keyframe.parent.valid() && IsRedundant(map, keyframe, rule)) return &keyframe;
  }
  return nullptr;
}

// Removes landmarks that too few keyframes show once the keyframe with these matches is removed.
// Landmarks on trial stay.
template <class Remove, class LandmarkId>
void RemoveForsaken(const Map& map,
                    KeyFrameId newest,
                    const std::vector<LandmarkId>& matches,
                    MapEdit& edit) {
  for (const LandmarkId id : matches) {
    if (!id.valid()) continue;
    const auto& landmark = *map.Find(id);
    // Files of merged maps have landmarks whose first keyframe is not known any more.
    const bool on_trial =
        map.Knows(landmark.created_by) &&
        map.NumberOf(newest) - map.NumberOf(landmark.created_by) < kTrialKeyFrames;
    const auto left = static_cast<int>(landmark.observations.size()) - 1;
    if (!on_trial && left < kMinObservations) edit.push_back(Remove{id});
  }
}

}  // namespace

MapEdit RemoveRedundantKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options) {
  const KeyFrame* redundant =
      FindRedundant(map, centre, map.keyframes().size(), {options.redundant_share, false});
  // One keyframe at a time is removed, since each removal changes the shares of the others.
  if (redundant == nullptr) return {};
  return {edit::RemoveKeyFrame{redundant->id}};
}

MapEdit RemoveRevisitedKeyFrames(const Map& map, KeyFrameId centre, const CleanupOptions& options) {
  constexpr std::size_t kLookedAt = 30;
  const KeyFrame* redundant =
      FindRedundant(map, centre, kLookedAt, {options.revisited_share, true});
  if (redundant == nullptr) return {};
  MapEdit edit{edit::RemoveKeyFrame{redundant->id}};
  RemoveForsaken<edit::RemovePoint>(map, centre, redundant->frame.points, edit);
  RemoveForsaken<edit::RemoveLine>(map, centre, redundant->frame.lines, edit);
  return edit;
}

MapEdit RemoveOutliers(const Map& map, const CameraAndPyramid& imaging, const LineSettings& lines) {
  const OutlierSearch search(map, imaging, lines);
  MapEdit edit;
  for (const auto& [id, point] : map.points()) {
    search.Search<edit::RemovePoint, edit::RemovePointObservation>(point, edit);
  }
  for (const auto& [id, line] : map.lines()) {
    search.Search<edit::RemoveLine, edit::RemoveLineObservation>(line, edit);
  }
  return edit;
}

}  // namespace plumbline
