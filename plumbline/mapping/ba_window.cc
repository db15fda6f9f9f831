// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/ba_window.h"

#include "plumbline/association/line_information.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/line_interval.h"
#include "plumbline/mapping/parallel_lines.h"
#include "plumbline/optimization/line_ends.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>

namespace plumbline {
namespace {

// Builds a BaWindow step by step: keyframes, then landmarks, then observations.
class WindowBuilder {
 public:
  WindowBuilder(const Map& map,
                const ImagingModel& imaging,
                const LineOptions& lines,
                const BaWindowOptions& options)
      : map_(map), line_options_(lines), options_(options) {
    window_.problem.camera = imaging.camera;
    window_.problem.line_residual = lines.residual;
  }

  BaWindow Build(KeyFrameId centre) {
    pose_of_.assign(static_cast<std::size_t>(map_.NextKeyFrameId().value), kNotInWindow);
    window_.window_from_world = map_.Find(centre)->frame.cam_from_world;
    world_from_window_ = Inverse(window_.window_from_world);
    ChooseFree(centre);
    ChooseLandmarks();
    ChooseFixed();
    AddPoints();
    AddLines();
    AddParallelLines();
    if (line_options_.residual == LineResidualKind::kProjectedEnds) WeighProjectedEnds();
    return std::move(window_);
  }

 private:
  static constexpr int kNotInWindow = -1;

  void AddPose(KeyFrameId id, bool fixed) {
    const Frame& frame = map_.Find(id)->frame;
    pose_of_[static_cast<std::size_t>(id.value)] = static_cast<int>(frames_.size());
    frames_.push_back(&frame);
    window_.keyframes.push_back(id);
    window_.problem.poses.push_back({frame.cam_from_world * world_from_window_, fixed});
  }

  void ChooseFree(KeyFrameId centre) {
    const KeyFrameId origin = map_.keyframes().begin()->first;
    std::vector<KeyFrameId> free{centre};
    for (const auto& neighbour : Covisible(map_, centre, options_.min_shared)) {
      if (static_cast<int>(free.size()) >= options_.free_keyframes) break;
      free.push_back(neighbour.id);
    }
    std::sort(free.begin(), free.end());
    for (const KeyFrameId id : free) AddPose(id, id == origin);
  }

  // The landmarks with at least two views that the keyframes of the window show, by id.
  template <class Landmark, class LandmarkId>
  std::vector<const Landmark*> Shown(std::vector<LandmarkId> Frame::*matches) const {
    std::vector<LandmarkId> ids;
    for (const Frame* frame : frames_) {
      for (const LandmarkId id : frame->*matches) {
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
    SharedCounts shared(map_);
    for (const MapPoint* point : points_) shared.Add(point->observations);
    for (const MapLine* line : lines_) shared.Add(line->observations);
    for (const KeyFrameId id : window_.keyframes) shared.Leave(id);
    std::vector<CovisibleKeyFrame> others = shared.Rank(1);
    if (static_cast<int>(others.size()) > options_.fixed_keyframes) {
      others.resize(static_cast<std::size_t>(options_.fixed_keyframes));
    }
    for (const auto& other : others) AddPose(other.id, true);
    HoldGauge();
  }

  // At least one pose is fixed; with a single camera at least two, since one leaves the scale of
  // the window open against the rest of the map. Where the window is all of the map, its scale is
  // arbitrary, and the damping holds it.
  void HoldGauge() {
    auto& poses = window_.problem.poses;
    const bool depth = window_.problem.camera.baseline > 0;
    const bool whole_map = frames_.size() == map_.keyframes().size();
    const std::ptrdiff_t needed = depth || whole_map ? 1 : 2;
    auto fixed = std::count_if(poses.begin(), poses.end(), [](const auto& p) { return p.fixed; });
    for (auto pose = poses.begin(); pose != poses.end() && fixed < needed; ++pose) {
      fixed += !pose->fixed;
      pose->fixed = true;  // the oldest
    }
  }

  // A view of a landmark from the window.
  struct View {
    int pose = 0;
    std::size_t feature = 0;
  };

  // Into views_; false where there are fewer than two.
  bool FindViews(const Observations& observations) {
    views_.clear();
    for (const auto& [keyframe, feature] : observations) {
      const int pose = pose_of_[static_cast<std::size_t>(keyframe.value)];
      if (pose != kNotInWindow) views_.push_back({pose, static_cast<std::size_t>(feature)});
    }
    return views_.size() >= 2;
  }

  const Features& FeaturesOf(const View& view) const {
    return frames_[static_cast<std::size_t>(view.pose)]->features();
  }

  void AddPoints() {
    for (const MapPoint* point : points_) {
      if (!FindViews(point->observations)) continue;
      const int index = static_cast<int>(window_.points.size());
      window_.points.push_back(point->id);
      window_.problem.points.push_back(window_.window_from_world * point->position);
      for (const View& view : views_) {
        window_.problem.point_observations.push_back(
            {view.pose, index, MeasurePoint(FeaturesOf(view), view.feature)});
      }
    }
  }

  void AddLines() {
    for (const MapLine* line : lines_) {
      if (!FindViews(line->observations)) continue;
      if (!WellConditioned(*line)) {
        window_.young_lines.push_back(line->id);
        continue;
      }
      const int index = static_cast<int>(window_.lines.size());
      window_.lines.push_back(line->id);
      window_.problem.lines.push_back(
          ToOrthonormal(Transform(window_.window_from_world, line->line)));
      for (const View& view : views_) AddLineObservations(index, view);
    }
  }

  void AddLineObservations(int line, const View& view) {
    const Features& features = FeaturesOf(view);
    const LineWeighting weighting = line_options_.weighting;
    auto& observations = window_.problem.line_observations;
    observations.push_back({view.pose, line, MeasureLeftLine(features, view.feature, weighting)});
    if (const auto right = MeasureRightLine(features, view.feature, weighting)) {
      observations.push_back({view.pose, line, *right});
    }
  }

  // Fixed directions from all of the map. The lines parallel to one share its error, so that its
  // variance counts once for each of them: together they do not claim to know it better.
  void AddParallelLines() {
    BaProblem& problem = window_.problem;
    if (!options_.parallel_lines || problem.line_residual != LineResidualKind::kObservedEnds)
      return;
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
      line.sigma = std::hypot(ParallelSigma(), std::sqrt(count[axis]) * directions[axis].sigma);
    }
    for (const CommonDirection& axis : directions) {
      problem.axes.push_back(window_.window_from_world.rotation * axis.direction);
    }
  }

  // The covariances of the measured ends become those of the ends that the solver will project.
  void WeighProjectedEnds() {
    BaProblem& problem = window_.problem;
    const std::vector<Segment3> ends = TrimmedEnds(problem);
    for (auto& o : problem.line_observations) {
      const auto line = static_cast<std::size_t>(o.line);
      UseProjectedEnds(problem.camera,
                       problem.poses[static_cast<std::size_t>(o.pose)].cam_from_world,
                       ToPlucker(problem.lines[line]),
                       ends[line],
                       std::nullopt,  // the lines are free to move
                       line_options_.weighting,
                       o.measurement);
    }
  }

  // Wide angle between the interpretation planes of the first view and another (left images), or
  // ends that the information fixes.
  bool WellConditioned(const MapLine& line) const {
    const double limit = std::cos(options_.min_line_plane_angle_deg * std::numbers::pi / 180);
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
  LineOptions line_options_;
  const BaWindowOptions& options_;
  BaWindow window_;
  Rigid3 world_from_window_;
  std::vector<int> pose_of_;             // by keyframe
  std::vector<const Frame*> frames_;     // by pose
  std::vector<const MapPoint*> points_;  // candidates
  std::vector<const MapLine*> lines_;
  std::vector<View> views_;  // of the landmark that is being added
};

}  // namespace

BaWindow MakeBaWindow(const Map& map,
                      const ImagingModel& imaging,
                      KeyFrameId centre,
                      const LineOptions& lines,
                      const BaWindowOptions& options) {
  return WindowBuilder(map, imaging, lines, options).Build(centre);
}

namespace {

void RemoveOutliers(const BaWindow& window, const BaResult& result, MapEdit& edit) {
  const auto& points = window.problem.point_observations;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (result.point_inliers[k]) continue;
    edit.push_back(
        edit::RemovePointObservation{window.points[static_cast<std::size_t>(points[k].point)],
                                     window.keyframes[static_cast<std::size_t>(points[k].pose)]});
  }
  const auto& lines = window.problem.line_observations;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (result.line_inliers[k]) continue;
    edit.push_back(
        edit::RemoveLineObservation{window.lines[static_cast<std::size_t>(lines[k].line)],
                                    window.keyframes[static_cast<std::size_t>(lines[k].pose)]});
  }
}

// The window's lines with the observations that stay.
std::vector<MapLine> LinesWithoutOutliers(const Map& map,
                                          const BaWindow& window,
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
               const ImagingModel& imaging,
               const BaWindow& window,
               const BaResult& result) {
  MapEdit edit;
  for (std::size_t k = 0; k < window.keyframes.size(); ++k) {
    if (window.problem.poses[k].fixed) continue;
    edit.push_back(edit::SetPose{window.keyframes[k], result.poses[k] * window.window_from_world});
  }
  const Rigid3 world_from_window = Inverse(window.window_from_world);
  for (std::size_t k = 0; k < window.points.size(); ++k) {
    edit.push_back(edit::MovePoint{window.points[k], world_from_window * result.points[k]});
  }
  // Intervals and information follow from the poses and observations as they will be.
  std::map<KeyFrameId, Rigid3> poses;
  for (std::size_t k = 0; k < window.keyframes.size(); ++k) {
    poses[window.keyframes[k]] = result.poses[k] * window.window_from_world;
  }
  const std::vector<MapLine> lines = LinesWithoutOutliers(map, window, result);
  for (std::size_t k = 0; k < window.lines.size(); ++k) {
    const PluckerLine line = Transform(world_from_window, ToPlucker(result.lines[k]));
    edit.push_back(RefitInterval(map, imaging, poses, lines[k], line));
  }
  RemoveOutliers(window, result, edit);
  return edit;
}

}  // namespace plumbline
