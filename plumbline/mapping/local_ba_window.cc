// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_ba_window.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/mapping/parallel_lines.h"
#include "plumbline/matching/measurements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace plumbline {
namespace {

constexpr int kMinShared = 15;  // landmarks; a keyframe that shares fewer is not worth adjusting

// Builds a LocalBaWindow step by step: keyframes, then landmarks with their observations.
class WindowBuilder {
 public:
  WindowBuilder(const Map& map,
                const CameraAndPyramid& imaging,
                const LineSettings& lines,
                const LocalBaWindowOptions& options,
                KeyFrameId centre)
      : map_(map),
        line_options_(lines),
        options_(options),
        centre_(centre),
        builder_(map, imaging, lines.weights(), centre, window_) {}

  LocalBaWindow Build() {
    ChooseFree();
    ChooseLandmarks();
    ChooseFixed();
    AddPoses();
    for (const MapPoint* point : points_) builder_.AddPoint(*point);
    for (const MapLine* line : lines_) AddLine(*line);
    AddParallelLines();
    const auto complete = line_options_.method.complete_window;
    if (complete != nullptr) complete(line_options_.weights(), window_.problem);
    return std::move(window_);
  }

 private:
  void ChooseFree() {
    free_ = {centre_};
    for (const auto& neighbour : Covisible(map_, centre_, kMinShared)) {
      if (static_cast<int>(free_.size()) >= options_.free_keyframes) break;
      free_.insert(neighbour.id);
    }
  }

  // Returns the landmarks that the free keyframes show and that have at least two views, by id.
  template <class Landmark, class LandmarkId>
  std::vector<const Landmark*> Shown(std::vector<LandmarkId> Frame::*matches) const {
    std::vector<LandmarkId> ids;
    for (const KeyFrameId keyframe : free_) {
      for (const LandmarkId id : map_.Find(keyframe)->frame.*matches) {
        if (id.valid()) ids.push_back(id);
      }
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::vector<const Landmark*> landmarks;
    for (const LandmarkId id : ids) {
      const Landmark* landmark = map_.Find(id);
      if (landmark->observations.size() >= 2) landmarks.push_back(landmark);
    }
    return landmarks;
  }

  void ChooseLandmarks() {
    points_ = Shown<MapPoint>(&Frame::points);
    lines_ = Shown<MapLine>(&Frame::lines);
  }

  void ChooseFixed() {
    SharedCounts shared;
    for (const MapPoint* point : points_) shared.Add(point->observations);
    for (const MapLine* line : lines_) shared.Add(line->observations);
    for (const KeyFrameId id : free_) shared.Leave(id);
    std::vector<CovisibleKeyFrame> others = shared.Rank(1);
    if (static_cast<int>(others.size()) > options_.fixed_keyframes) {
      others.resize(static_cast<std::size_t>(options_.fixed_keyframes));
    }
    for (const auto& other : others) fixed_.insert(other.id);
  }

  // Adds the poses ordered by time, since FixInconsistentPoses compares consecutive ones.
  void AddPoses() {
    const KeyFrameId origin = map_.keyframes().begin()->first;
    std::set<KeyFrameId> all = free_;
    all.insert(fixed_.begin(), fixed_.end());
    for (const KeyFrameId id : all) builder_.AddPose(id, id == origin || fixed_.contains(id));
    HoldGauge();
  }

  // Fixes the oldest poses if fewer are fixed than the gauge needs. One fixed pose is enough if
  // depth is measured; with a single camera two are needed, since one alone leaves the scale of the
  // window relative to the rest of the map undetermined. If the window is the whole map, its scale
  // is arbitrary and fixed by FixScaleToOldestKeyFrame.
  void HoldGauge() {
    auto& poses = window_.problem.poses;
    const bool depth = MeasuresDepth(window_.problem.camera);
    const bool whole_map = poses.size() == map_.keyframes().size();
    const std::ptrdiff_t needed = depth || whole_map ? 1 : 2;
    auto fixed = std::count_if(poses.begin(), poses.end(), [](const auto& p) { return p.fixed; });
    for (auto pose = poses.begin(); pose != poses.end() && fixed < needed; ++pose) {
      fixed += !pose->fixed;
      pose->fixed = true;
    }
  }

  void AddLine(const MapLine& line) {
    const auto& views = builder_.ViewsOf(line.observations);
    if (views.size() < 2 || !WellConditioned(line)) return;
    window_.lines.push_back(line.id);
    const int index = builder_.AddLine(line.line);
    if (line_options_.method.keeps_ends) builder_.AddEnds(line.Interval());
    for (const auto& view : views) builder_.AddLineView(index, view, true);
  }

  // Constrains lines to be parallel to directions that come from the whole map and stay fixed. All
  // lines parallel to a direction share its error, so that its variance counts once for each of
  // them: together they must not make the direction more certain.
  void AddParallelLines() {
    BaProblem& problem = window_.problem;
    if (!options_.parallel_lines) return;
    const std::vector<CommonDirection> directions = CommonDirections(map_);
    std::vector<int> count(directions.size(), 0);
    for (std::size_t i = 0; i < window_.lines.size(); ++i) {
      const MapLine& line = *map_.Find(window_.lines[i]);
      const auto direction = DirectionOf(line.line, line.information);
      const auto axis = direction ? ParallelTo(*direction, directions) : std::nullopt;
      if (!axis) continue;
      problem.parallel_lines.push_back({static_cast<int>(*axis), static_cast<int>(i), 0});
      ++count[*axis];
    }
    for (auto& line : problem.parallel_lines) {
      const auto axis = static_cast<std::size_t>(line.axis);
      line.sigma = math::Hypot(ParallelSigma(), std::sqrt(count[axis]) * directions[axis].sigma);
    }
    for (const CommonDirection& axis : directions) {
      problem.axes.push_back(window_.problem_from_world.rotation * axis.direction);
    }
  }

  // Returns true if the images or the information determine a line: there is a large angle between
  // the interpretation planes of the first view and another (left images), or the information
  // determines both ends.
  bool WellConditioned(const MapLine& line) const {
    const double limit = math::Cos(options_.min_line_plane_angle_deg * std::numbers::pi / 180);
    std::optional<Eigen::Vector3d> first;
    for (const auto& [keyframe, feature] : line.observations) {
      const Eigen::Vector3d centre = Inverse(map_.Find(keyframe)->frame.cam_from_world).translation;
      const Eigen::Vector3d normal =
          (line.line.moment - centre.cross(line.line.direction)).normalized();
      if (!first) first = normal;
      if (std::abs(first->dot(normal)) <= limit) return true;
    }
    const KeyFrame& newest = *map_.Find(line.observations.newest().first);
    const auto known = [&](double t) {
      const double distance = (newest.frame.cam_from_world * line.line.PointAt(t)).norm();
      return SigmaAt(line.line, line.information, t) <= options_.max_line_relative_sigma * distance;
    };
    return known(line.start) && known(line.end);
  }

  const Map& map_;
  LineSettings line_options_;
  const LocalBaWindowOptions& options_;
  KeyFrameId centre_;
  LocalBaWindow window_;
  // Fills window_.problem.
  MapProblemBuilder builder_;
  std::set<KeyFrameId> free_;
  std::set<KeyFrameId> fixed_;
  // Points and lines that may enter the window.
  std::vector<const MapPoint*> points_;
  std::vector<const MapLine*> lines_;
};

}  // namespace

LocalBaWindow MakeLocalBaWindow(const Map& map,
                                const CameraAndPyramid& imaging,
                                KeyFrameId centre,
                                const LineSettings& lines,
                                const LocalBaWindowOptions& options) {
  return WindowBuilder(map, imaging, lines, options, centre).Build();
}

namespace {

// Returns the window's lines without the observations that turned out to be outliers.
std::vector<MapLine> LinesWithoutOutliers(const Map& map,
                                          const LocalBaWindow& window,
                                          const BaResult& result) {
  std::vector<MapLine> lines;
  for (const LineId id : window.lines) lines.push_back(*map.Find(id));
  const auto& observations = window.problem.line_observations;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (result.line_inliers[k]) continue;
    lines[static_cast<std::size_t>(observations[k].line)].observations.erase(
        window.keyframes[static_cast<std::size_t>(observations[k].pose)]);
  }
  return lines;
}

}  // namespace

MapEdit ToEdit(const Map& map,
               const CameraAndPyramid& imaging,
               const LocalBaWindow& window,
               const BaResult& result) {
  MapEdit edit = PosesAndPointsOf(window, result);
  // The information of lines, and the intervals of those that do not keep their ends, follow from
  // the new poses and the observations left.
  const std::map<KeyFrameId, Rigid3> poses = PosesByKeyFrame(window, result);
  const std::vector<MapLine> lines = LinesWithoutOutliers(map, window, result);
  const Rigid3 world_from_window = Inverse(window.problem_from_world);
  for (std::size_t k = 0; k < window.lines.size(); ++k) {
    const PluckerLine line = Transform(world_from_window, ToPlucker(result.lines[k]));
    std::optional<Segment3> ends;
    if (!result.line_ends.empty()) {
      const Segment3& moved = result.line_ends[k];
      ends = Segment3{world_from_window * moved.start, world_from_window * moved.end};
    }
    edit.push_back(RefitInterval(map, imaging, poses, lines[k], line, ends));
  }
  const auto& observations = window.problem.line_observations;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (result.line_inliers[k]) continue;
    edit.push_back(edit::RemoveLineObservation{
        window.lines[static_cast<std::size_t>(observations[k].line)],
        window.keyframes[static_cast<std::size_t>(observations[k].pose)]});
  }
  return edit;
}

}  // namespace plumbline
