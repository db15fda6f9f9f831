// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/whole_map_adjustment.h"

#include "plumbline/mapping/lens_calibration.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/mapping/map_problem.h"
#include "plumbline/optimization/multifrontal_cholesky.h"
#include "plumbline/optimization/pose_uncertainty.h"
#include "plumbline/optimization/problem.h"
#include "plumbline/optimization/schur_solver.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Limits for lines in the adjustment. They are looser than those of the line map for users, since
// an adjustment gains from more lines, and outliers have little weight in it.
constexpr LineMapOptions kAdjustedLines{.min_keyframes = 4,
                                        .max_relative_sigma = 0.02,
                                        .min_found_ratio = 0.25,
                                        .max_mean_chi2 = std::numeric_limits<double>::infinity(),
                                        .min_mean_length_px = 0};

// Makes a problem of the whole map with the lines that are well seen. Its world is the camera of
// the first keyframe. When stopped, points are missing.
MapProblem MakeWholeMap(const Map& map,
                        const CameraAndPyramid& imaging,
                        const LineWeights& weights,
                        const std::vector<WellSeenLine>& lines,
                        const StopCheck& stop) {
  MapProblem whole;
  const KeyFrameId first = map.keyframes().begin()->first;
  MapProblemBuilder builder(map, imaging, weights, first, whole);
  std::size_t of_points = 0, of_lines = 0;
  for (const auto& [id, point] : map.points()) of_points += point.observations.size();
  for (const WellSeenLine& line : lines) {
    for (const LineSupport& support : line.supports) of_lines += support.right ? 2 : 1;
  }
  whole.problem.point_observations.reserve(of_points);
  whole.problem.line_observations.reserve(of_lines);
  for (const auto& [id, keyframe] : map.keyframes()) builder.AddPose(id, id == first);
  for (const auto& [id, point] : map.points()) {
    if (IsToStop(stop)) return whole;
    builder.AddPoint(point);
  }
  for (const WellSeenLine& line : lines) {
    const int index = builder.AddLine(line.line);
    for (const LineSupport& support : line.supports) {
      const int pose = builder.PoseOf(support.keyframe->id);
      builder.AddLineView(index, {pose, support.feature}, support.right);
    }
  }
  return whole;
}

// Returns true if solving the problem would take longer than solving one of `limit` keyframes that
// all share landmarks. Only a problem of more keyframes can. The problem stays as it is.
bool TakesTooLong(BaProblem& problem, int limit, const StopCheck& stop) {
  const BlockPattern sharing = SharingPoses(problem, stop);
  if (FullSize(PlanElimination(sharing, stop)) <= limit) return false;
  if (problem.line_observations.empty()) return true;
  std::size_t blocks = sharing.size();
  for (const std::vector<int>& others : sharing) blocks += others.size();
  auto lines = std::exchange(problem.line_observations, {});
  const EliminationPlan of_points = PlanElimination(SharingPoses(problem, stop), stop);
  problem.line_observations = std::move(lines);
  const double size = limit;
  return IteratingWork(of_points, blocks) > size * size * size / 6;
}

// Poses and points of a problem, to be kept and put back without its observations.
struct PosesAndPoints {
  std::vector<BaProblem::Pose> poses;
  std::vector<Eigen::Vector3d> points;

  void Exchange(BaProblem& problem) {
    std::swap(poses, problem.poses);
    std::swap(points, problem.points);
  }
};

// Returns the solution with unconstrained and inconsistent poses fixed (SolveWithPoseLimits),
// scaled as the poses and points `start` were (FixScaleToOldestKeyFrame). `start` has no pose fixed
// but the first, so that all are scaled. The observations, the largest part of a problem, are not
// copied.
std::optional<BaResult> SolveAndFixScale(BaProblem& problem,
                                         PosesAndPoints& start,
                                         const LocalBaOptions& options,
                                         BaSolver solve,
                                         const PoseLimits& limits,
                                         const StopCheck& stop) {
  const auto fix_scale = [&](BaResult& solution) {
    start.Exchange(problem);
    FixScaleToOldestKeyFrame(problem, solution);
    start.Exchange(problem);
  };
  return SolveWithPoseLimits(problem, options, solve, limits, fix_scale, stop);
}

// Adjusts poses and points, without lines, to a corrected lens. It starts from the places that were
// found when the lens was learned, or else from those of the problem. Another lens changes the
// scale from place to place by more than AdjustWholeMap accepts before it sees a tear in the map,
// so that poses and points have to move there first. Returns nullopt when stopped.
std::optional<BaResult> SolveForLens(const RadialCalibration& lens,
                                     const MappingOptions& options,
                                     BaProblem problem,
                                     const StopCheck& stop) {
  for (std::size_t i = 0; i < lens.poses.size(); ++i) {
    problem.poses[i].cam_from_world = lens.poses[i];
  }
  if (!lens.points.empty()) problem.points = lens.points;
  problem.lines.clear();
  problem.line_observations.clear();
  const LocalBaOptions ba = LensAdjustmentOptions(options.ba);
  PosesAndPoints start{problem.poses, problem.points};
  return SolveAndFixScale(problem, start, ba, SolveLocalBa, options.window.local_limits(), stop);
}

// Returns the poses and points of an adjustment, and the lens correction of the features combined
// with the newly learned one.
MapCorrection CorrectionOf(const Map& map,
                           const MapProblem& whole,
                           const RadialCalibration& learned,
                           const BaResult& result) {
  MapCorrection correction;
  const std::vector<double> scales = ScalesOf(whole.problem, result);
  const Rigid3 world_from_problem = Inverse(whole.problem_from_world);
  for (std::size_t k = 0; k < whole.keyframes.size(); ++k) {
    const KeyFrameId id = whole.keyframes[k];
    const Rigid3& before = map.Find(id)->frame.cam_from_world;
    const bool fixed = whole.problem.poses[k].fixed;
    correction.keyframes[id] = {
        before, fixed ? before : result.poses[k] * whole.problem_from_world, scales[k]};
  }
  for (std::size_t k = 0; k < whole.points.size(); ++k) {
    const PointId id = whole.points[k];
    correction.points[id] = {map.Find(id)->position, world_from_problem * result.points[k]};
  }
  correction.outliers = OutliersOf(whole, result);
  correction.lens_is_right = learned.is_right;
  const double change_px = learned.correction.border_px();
  if (change_px != 0) {
    const double border_px = map.correction().lens.border_px() + change_px;
    correction.lens =
        border_px == 0 ? LensCorrection() : LensCorrection(whole.problem.camera, border_px);
  }
  return correction;
}

// Adjusts keyframes and points of a map that will still grow to a change of the lens.
MapCorrection AdjustPointsToLens(const Map& map,
                                 const RadialCalibration& change,
                                 const MappingOptions& options,
                                 MapProblem whole,
                                 const StopCheck& stop) {
  Correct(change.correction, whole.problem);
  std::optional<BaResult> result = SolveForLens(change, options, whole.problem, stop);
  if (!result) return {};
  const std::vector<PoseUncertainty> sigmas = SigmasOfPoses(whole.problem, *result);
  const auto is_fixed = [&](std::size_t k) {
    return sigmas[k].AtMost(options.window.max_pose_sigma);
  };
  std::size_t newest = whole.keyframes.size() - 1;
  while (newest > 0 && !is_fixed(newest)) --newest;
  KeepPlaceOf(newest, whole.problem, *result);
  // CorrectionOf leaves fixed keyframes in their places, and the first one has moved with the rest.
  whole.problem.poses.front().fixed = false;
  MapCorrection correction = CorrectionOf(map, whole, change, *result);
  for (std::size_t k = 0; k < whole.keyframes.size(); ++k) {
    if (!is_fixed(k)) correction.keyframes.erase(whole.keyframes[k]);
  }
  return correction;
}

// Learns the lens of a single camera, and adjusts poses and points to it. Returns an empty
// correction if there is nothing to adjust them to, and nullopt when stopped.
std::optional<MapCorrection> AdjustPointsToFinalLens(const Map& map,
                                                     const MappingOptions& options,
                                                     MapProblem whole,
                                                     const StopCheck& stop) {
  const double known_px = map.correction().lens.border_px();
  const RadialCalibration learned = options.lens_calibration
                                        ? CalibrateRadialDistortion(whole.problem, known_px, stop)
                                        : RadialCalibration{};
  // A map that has a lens correction may have taken in keyframes of a map that had another one.
  if (learned.poses.empty() && known_px == 0) {
    MapCorrection none;
    none.lens_is_right = learned.is_right;
    return none;
  }
  Correct(learned.correction, whole.problem);
  std::optional<BaResult> moved = SolveForLens(learned, options, whole.problem, stop);
  if (!moved) return std::nullopt;
  FixScaleToOldestKeyFrame(whole.problem, *moved);
  MapCorrection correction = CorrectionOf(map, whole, learned, *moved);
  correction.outliers.clear();  // the adjustment with lines tells them
  return correction;
}

// Returns the correction that does what `first` and then `second` do, where `second` was computed
// on the map after `first`. All keyframes of one are in the other, and `second` leaves the lens.
MapCorrection Joined(const MapCorrection& first, MapCorrection second) {
  for (auto& [id, place] : second.keyframes) {
    const auto before = first.keyframes.find(id);
    if (before == first.keyframes.end()) continue;
    place.before = before->second.before;
    place.scale *= before->second.scale;
  }
  for (auto& [id, place] : second.points) {
    const auto before = first.points.find(id);
    if (before != first.points.end()) place.before = before->second.before;
  }
  second.lens = first.lens;
  second.lens_is_right = first.lens_is_right;
  return second;
}

}  // namespace

bool IsAdjustedAsAWhole(const Map& map,
                        const CameraAndPyramid& imaging,
                        const LineWeights& weights,
                        const MappingOptions& options,
                        const StopCheck& stop) {
  constexpr std::size_t kMinKeyFrames = 3;
  const int limit = options.final_adjustment_keyframes;
  const std::size_t count = map.keyframes().size();
  if (count < kMinKeyFrames || limit == 0 || IsToStop(stop)) return false;
  if (count <= static_cast<std::size_t>(limit)) return true;
  MapProblem points = MakeWholeMap(map, imaging, weights, {}, stop);
  return !TakesTooLong(points.problem, limit, stop);
}

MapCorrection AdjustWholeMap(const Map& map,
                             const CameraAndPyramid& imaging,
                             const LineSettings& lines,
                             const MappingOptions& options,
                             const StopCheck& stop,
                             AdjustmentProgress* progress) {
  // The search for lines is skipped if the points alone show that the map takes too long.
  if (!IsAdjustedAsAWhole(map, imaging, lines.weights(), options, stop)) return {};
  const int limit = options.final_adjustment_keyframes;
  const bool large = map.keyframes().size() > static_cast<std::size_t>(limit);
  const auto without_lines = [&](const Map& of) {
    return MakeWholeMap(of, imaging, lines.weights(), {}, stop);
  };
  MapCorrection to_lens;
  std::optional<Map> moved;
  AdjustmentProgress not_wanted;
  auto& [steps, on_lens] = progress != nullptr ? *progress : not_wanted;
  if (imaging.camera.baseline == 0) {
    std::optional<MapCorrection> adjusted;
    Timed("finish_lens", steps, [&] {
      adjusted = AdjustPointsToFinalLens(map, options, without_lines(map), stop);
    });
    if (!adjusted || IsToStop(stop)) return {};
    to_lens = *std::move(adjusted);
    if (to_lens.lens && on_lens) on_lens(*to_lens.lens);
    if (!to_lens.empty()) moved.emplace(map).Apply(RebaseCorrection(to_lens, map));
  }
  const Map& at_lens = moved ? *moved : map;
  std::vector<WellSeenLine> well_seen;
  Timed("finish_lines", steps, [&] {
    well_seen = FindWellSeenLines(at_lens, imaging, kAdjustedLines, stop);
  });
  if (IsToStop(stop)) return {};
  MapProblem whole = MakeWholeMap(at_lens, imaging, lines.weights(), well_seen, stop);
  // Long lines that are seen from far away can tie many keyframes together, so that solving would
  // take too long.
  if (large && TakesTooLong(whole.problem, limit, stop)) whole = without_lines(at_lens);
  if (IsToStop(stop)) return {};
  PosesAndPoints start{whole.problem.poses, whole.problem.points};
  std::optional<BaResult> result;
  Timed("finish_adjust", steps, [&] {
    result = SolveAndFixScale(whole.problem,
                              start,
                              options.ba,
                              lines.method.adjust_map,
                              options.window.whole_map_limits(),
                              stop);
  });
  if (!result) return {};
  start.Exchange(whole.problem);
  return Joined(to_lens, CorrectionOf(at_lens, whole, {}, *result));
}

MapCorrection AdjustToLens(const Map& map,
                           const CameraAndPyramid& imaging,
                           const LineWeights& weights,
                           const MappingOptions& options,
                           const StopCheck& stop) {
  if (map.keyframes().empty() || IsToStop(stop)) return {};
  MapProblem whole = MakeWholeMap(map, imaging, weights, {}, stop);
  if (IsToStop(stop)) return {};
  const RadialCalibration learned =
      CalibrateRadialDistortion(whole.problem, map.correction().lens.border_px(), stop);
  if (learned.poses.empty()) {
    MapCorrection none;
    none.lens_is_right = learned.is_right;
    return none;
  }
  return AdjustPointsToLens(map, learned, options, std::move(whole), stop);
}

MapCorrection BringToLens(const Map& map,
                          const CameraAndPyramid& imaging,
                          const LineWeights& weights,
                          const MappingOptions& options,
                          const LensCorrection& lens,
                          const StopCheck& stop) {
  const double change = lens.border_px() - map.correction().lens.border_px();
  if (change == 0 || map.keyframes().empty()) return {};
  const RadialCalibration known{{imaging.camera, change}, {}, {}, false};
  MapProblem whole = MakeWholeMap(map, imaging, weights, {}, stop);
  if (IsToStop(stop)) return {};
  return AdjustPointsToLens(map, known, options, std::move(whole), stop);
}

}  // namespace plumbline
