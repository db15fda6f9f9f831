// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/trajectory_error.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace plumbline {
namespace {

constexpr double kSecondsPerNanosecond = 1e-9;

std::vector<EvaluatedPose> Associate(const Trajectory& reference,
                                     const Trajectory& estimate,
                                     const TrajectoryErrorOptions& options) {
  std::vector<EvaluatedPose> poses;
  for (std::size_t row = 0; row < estimate.size(); ++row) {
    const StampedPose& pose = estimate[row];
    std::optional<Rigid3> match;
    if (options.association == TrajectoryAssociation::kInterpolate) {
      match = InterpolateAt(reference, pose.stamp_ns, options.max_gap_ns);
    } else if (const auto nearest =
                   NearestIndex(reference, pose.stamp_ns, options.max_difference_ns)) {
      match = reference[*nearest].world_from_camera;
    }
    if (match) poses.push_back({row, pose.stamp_ns, *match, pose.world_from_camera});
  }
  return poses;
}

// Returns the root mean square distance from the mean.
double Spread(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  double sum = 0;
  for (const Eigen::Vector3d& point : points) sum += (point - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

struct PathSpread {
  double reference = 0, estimate = 0;
};

PathSpread SpreadOf(std::span<const EvaluatedPose> poses) {
  std::vector<Eigen::Vector3d> reference, estimate;
  for (const EvaluatedPose& pose : poses) {
    reference.push_back(pose.reference.translation);
    estimate.push_back(pose.estimate.translation);
  }
  return {Spread(reference), Spread(estimate)};
}

// Returns the alignment of poses whose positions do not determine all of it. The positions
// determine what they can: the direction of a line, the scale along it and the mean. The
// orientations determine the rest, with a weight that changes nothing else: the rotation about the
// line, or the whole rotation if all positions coincide. The rotation is that of Umeyama's eq. 40,
// for which only the sum of both correlations is needed.
Similarity3 AlignByOrientations(std::span<const EvaluatedPose> poses, bool free_scale) {
  constexpr double kWeight = 1e-9;     // weight of orientations, relative to that of positions
  constexpr double kRounding = 1e-12;  // spread relative to the coordinates
  const double share = 1 / static_cast<double>(poses.size());
  Eigen::Vector3d source = Eigen::Vector3d::Zero(), target = source;
  for (const EvaluatedPose& pose : poses) {
    source += share * pose.estimate.translation;
    target += share * pose.reference.translation;
  }
  Eigen::Matrix3d positions = Eigen::Matrix3d::Zero(), orientations = positions;
  for (const EvaluatedPose& pose : poses) {
    positions += share * (pose.reference.translation - target) *
                 (pose.estimate.translation - source).transpose();
    orientations +=
        share * (pose.reference.rotation * pose.estimate.rotation.conjugate()).toRotationMatrix();
  }
  const PathSpread spread = SpreadOf(poses);
  const bool moves = spread.estimate > kRounding * (1e-3 + source.norm()) &&
                     spread.reference > kRounding * (1e-3 + target.norm());
  Eigen::Matrix3d correlation = kWeight * orientations;
  if (moves) correlation += positions / (spread.reference * spread.estimate);
  const Eigen::Matrix3d rotation = FitRotation(correlation).rotation;
  Similarity3 result;
  result.rotation = Eigen::Quaterniond(rotation).normalized();
  if (moves && free_scale) {  // eq. 42
    const double along = (rotation.transpose() * positions).trace();
    if (along > 0) result.scale = along / (spread.estimate * spread.estimate);
  }
  result.translation = target - result.scale * (result.rotation * source);
  return result;
}

void Align(TrajectoryAlignment alignment, TrajectoryError& result) {
  if (alignment == TrajectoryAlignment::kNone) return;
  std::vector<Eigen::Vector3d> source, target;
  for (const EvaluatedPose& pose : result.poses) {
    source.push_back(pose.estimate.translation);
    target.push_back(pose.reference.translation);
  }
  const bool free_scale = alignment == TrajectoryAlignment::kSim3;
  const auto aligned =
      AlignPoints(source, target, free_scale ? AlignmentScale::kFree : AlignmentScale::kFixed);
  if (aligned) {
    result.reference_from_estimate = aligned->target_from_source;
    return;
  }
  result.degenerate = aligned.error();
  result.reference_from_estimate = AlignByOrientations(result.poses, free_scale);
}

void ApplyAlignment(TrajectoryError& result) {
  const Similarity3& similarity = result.reference_from_estimate;
  std::vector<double> errors;
  for (EvaluatedPose& pose : result.poses) {
    pose.estimate = TransformPose(similarity, pose.estimate);
    pose.position_error = (pose.estimate.translation - pose.reference.translation).norm();
    pose.rotation_error = AngularDistance(pose.estimate.rotation, pose.reference.rotation);
    errors.push_back(pose.position_error);
  }
  result.ate = *StatisticsOf(std::move(errors));
}

// Returns the value below which a share of the sorted values lies.
double QuantileOf(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double between = place - static_cast<double>(below);
  return (1 - between) * sorted[below] + between * sorted[above];
}

// Returns index pairs into the associated poses that are a duration apart.
std::vector<std::pair<std::size_t, std::size_t>> PairsByTime(
    const std::vector<EvaluatedPose>& poses, std::int64_t duration_ns) {
  constexpr std::int64_t kToleranceDivisor = 20;
  Trajectory stamps;
  for (const EvaluatedPose& pose : poses) stamps.push_back({pose.stamp_ns, {}});
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < poses.size(); ++a) {
    const auto b =
        NearestIndex(stamps, poses[a].stamp_ns + duration_ns, duration_ns / kToleranceDivisor);
    if (b && *b > a) pairs.emplace_back(a, *b);
  }
  return pairs;
}

// Returns index pairs into the associated poses that are a number of rows of the estimate apart.
std::vector<std::pair<std::size_t, std::size_t>> PairsByRow(const std::vector<EvaluatedPose>& poses,
                                                            const Trajectory& estimate,
                                                            int frames) {
  constexpr double kLongestShare = 1.5;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (estimate.size() < 2) return pairs;
  std::vector<double> spacing;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    spacing.push_back(static_cast<double>(estimate[i].stamp_ns - estimate[i - 1].stamp_ns));
  }
  std::sort(spacing.begin(), spacing.end());
  const double longest = kLongestShare * frames * QuantileOf(spacing, 0.5);
  std::size_t b = 0;
  for (std::size_t a = 0; a < poses.size(); ++a) {
    const std::size_t row = poses[a].row + static_cast<std::size_t>(frames);
    while (b < poses.size() && poses[b].row < row) ++b;
    if (b == poses.size()) break;
    if (poses[b].row != row) continue;
    if (static_cast<double>(poses[b].stamp_ns - poses[a].stamp_ns) <= longest) {
      pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

void CompareMotions(const Trajectory& estimate,
                    const RelativeWindow& window,
                    TrajectoryError& result) {
  const std::vector<EvaluatedPose>& poses = result.poses;
  const auto pairs = window.frames > 0 ? PairsByRow(poses, estimate, window.frames)
                                       : PairsByTime(poses, window.duration_ns);
  std::vector<double> translation, rotation;
  for (const auto& [a, b] : pairs) {
    const Rigid3 reference_motion = Inverse(poses[a].reference) * poses[b].reference;
    const Rigid3 estimate_motion = Inverse(poses[a].estimate) * poses[b].estimate;
    const Rigid3 error = Inverse(reference_motion) * estimate_motion;
    const double seconds =
        static_cast<double>(poses[b].stamp_ns - poses[a].stamp_ns) * kSecondsPerNanosecond;
    translation.push_back(error.translation.norm() / seconds);
    rotation.push_back(AngularDistance(error.rotation, Eigen::Quaterniond::Identity()) / seconds);
    result.relative.push_back({a, b, translation.back(), rotation.back()});
  }
  result.rpe = StatisticsOf(std::move(translation));
  result.roe = StatisticsOf(std::move(rotation));
}

}  // namespace

std::optional<ErrorStatistics> StatisticsOf(std::vector<double> errors) {
  if (errors.empty()) return std::nullopt;
  ErrorStatistics statistics;
  statistics.count = errors.size();
  const auto count = static_cast<double>(errors.size());
  double squares = 0, sum = 0;
  for (const double error : errors) {
    squares += error * error;
    sum += error;
    statistics.max = std::max(statistics.max, error);
  }
  statistics.rmse = std::sqrt(squares / count);
  statistics.mean = sum / count;
  for (const double error : errors) {
    statistics.deviation += (error - statistics.mean) * (error - statistics.mean) / count;
  }
  statistics.deviation = std::sqrt(statistics.deviation);
  std::sort(errors.begin(), errors.end());
  statistics.median = QuantileOf(errors, 0.5);
  statistics.p75 = QuantileOf(errors, 0.75);
  statistics.p95 = QuantileOf(errors, 0.95);
  return statistics;
}

std::optional<TrajectoryError> CompareTrajectories(const Trajectory& given_reference,
                                                   const Trajectory& given_estimate,
                                                   const TrajectoryErrorOptions& options) {
  PLUMBLINE_CHECK(options.window.frames > 0 || options.window.duration_ns > 0, "empty window");
  const Trajectory reference = WithUnitRotations(given_reference, "reference");
  const Trajectory estimate = WithUnitRotations(given_estimate, "estimate");
  TrajectoryError result;
  result.estimated = estimate.size();
  result.poses = Associate(reference, estimate, options);
  if (result.poses.empty()) return std::nullopt;
  if (options.known_alignment) {
    result.reference_from_estimate = *options.known_alignment;
  } else {
    Align(options.alignment, result);
  }
  ApplyAlignment(result);
  const bool has_scale = !result.degenerate || result.degenerate == AlignmentFailure::kCollinear;
  if (options.alignment == TrajectoryAlignment::kSim3 && has_scale) {
    result.scale_drift = ScaleDrift(result.poses);
  }
  CompareMotions(estimate, options.window, result);
  return result;
}

std::optional<double> ScaleDrift(std::span<const EvaluatedPose> poses) {
  constexpr std::size_t kStretches = 5;
  constexpr double kFar = 1.0 / 20;
  const std::size_t size = poses.size() / kStretches;
  if (size == 0) return std::nullopt;
  const PathSpread all = SpreadOf(poses);
  const PathSpread first = SpreadOf(poses.first(size));
  const PathSpread last = SpreadOf(poses.last(size));
  const double least = kFar * all.reference;
  if (!(least > 0) || first.reference < least || last.reference < least || !(first.estimate > 0)) {
    return std::nullopt;
  }
  return (last.estimate / last.reference) / (first.estimate / first.reference) - 1;
}

Similarity3 AlignPoses(std::span<const EvaluatedPose> poses) {
  constexpr double kLever = 1;  // metres
  std::vector<Eigen::Vector3d> source, target;
  const auto add = [&](const EvaluatedPose& pose, const Eigen::Vector3d& in_camera) {
    source.push_back(pose.estimate * in_camera);
    target.push_back(pose.reference * in_camera);
  };
  for (const EvaluatedPose& pose : poses) {
    add(pose, Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3; ++axis) {
      add(pose, kLever * Eigen::Vector3d::Unit(axis));
      add(pose, -kLever * Eigen::Vector3d::Unit(axis));
    }
  }
  const auto aligned = AlignPoints(source, target, AlignmentScale::kFixed);
  if (aligned) return aligned->target_from_source;
  // Beside a straight path of thousands of kilometres, or of metres that are written as
  // millimetres, the levers are too short to count.
  return AlignByOrientations(poses, false);
}

Trajectory OfCamera(const Trajectory& body, const Rigid3& body_from_camera) {
  Trajectory camera = WithUnitRotations(body, "body");
  const Rigid3 mounting{UnitRotation(body_from_camera.rotation, "body_from_camera"),
                        body_from_camera.translation};
  for (StampedPose& pose : camera) {
    pose.world_from_camera = pose.world_from_camera * mounting;
  }
  return camera;
}

Trajectory MirroredY(const Trajectory& trajectory) {
  Trajectory mirrored = WithUnitRotations(trajectory, "trajectory");
  for (StampedPose& pose : mirrored) {
    // M R M negates the entries of R with exactly one index y: the rotation axis keeps its y and
    // negates x and z.
    Eigen::Quaterniond& q = pose.world_from_camera.rotation;
    q.x() = -q.x();
    q.z() = -q.z();
    pose.world_from_camera.translation.y() = -pose.world_from_camera.translation.y();
  }
  return mirrored;
}

}  // namespace plumbline
