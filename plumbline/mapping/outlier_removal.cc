// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/outlier_removal.h"

#include "plumbline/mapping/line_interval.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/residuals.h"

#include <cstddef>
#include <optional>

namespace plumbline {
namespace {

// Limit of chi2: 4 sigma, which of true observations with two or three residuals 99.97 % and 99.9 %
// keep. Bundle adjustment rejects at 95 %, but while poses still move.
constexpr double kMaxChi2 = 16;
// A landmark that loses observations must keep as many: two lines of sight cross somewhere nearly
// always, so that only a third one tells that they belong together.
constexpr std::size_t kFewestViews = 3;

// Compares landmarks with their observations, at the poses of the map.
class OutlierSearch {
 public:
  OutlierSearch(const Map& map, const CameraAndPyramid& imaging, const LineOptions& lines)
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

MapEdit RemoveOutliers(const Map& map, const CameraAndPyramid& imaging, const LineOptions& lines) {
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
