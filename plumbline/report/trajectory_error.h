// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/alignment.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/geometry/trajectory.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Alignment of the whole estimate before positions are compared.
enum class TrajectoryAlignment {
  kNone,  // both are already in the same world
  kSe3,   // rotation and translation
  kSim3,  // rotation, translation and scale (monocular)
};
constexpr auto EnumNames(std::type_identity<TrajectoryAlignment>) {
  return std::array{std::pair{TrajectoryAlignment::kNone, "none"},
                    std::pair{TrajectoryAlignment::kSe3, "se3"},
                    std::pair{TrajectoryAlignment::kSim3, "sim3"}};
}

// Association of a reference pose with a pose of the estimate.
enum class TrajectoryAssociation {
  kInterpolate,  // the reference is interpolated at the time of the estimate
  // the reference pose nearest in time, as in older tools
  kNearest,
};
constexpr auto EnumNames(std::type_identity<TrajectoryAssociation>) {
  return std::array{std::pair{TrajectoryAssociation::kInterpolate, "interpolate"},
                    std::pair{TrajectoryAssociation::kNearest, "nearest"}};
}

// Time between the two poses of a relative motion.
struct RelativeWindow {
  std::int64_t duration_ns = 3'000'000'000;  // used when frames == 0
  int frames = 0;                            // > 0: a number of rows of the estimate instead
};

// Alignment, association and windows of CompareTrajectories.
struct TrajectoryErrorOptions {
  TrajectoryAlignment alignment = TrajectoryAlignment::kSe3;
  // The alignment, if known from elsewhere: it is applied unchanged, and `alignment` tells its
  // kind.
  std::optional<Similarity3> known_alignment = {};
  TrajectoryAssociation association = TrajectoryAssociation::kInterpolate;
  // Largest gap between reference poses for interpolation (KITTI: 0.25 s).
  std::int64_t max_gap_ns = 100'000'000;
  // Largest distance in time of the nearest reference pose.
  std::int64_t max_difference_ns = 20'000'000;
  RelativeWindow window = {};
};

// Statistics of a set of non-negative errors. The median of an even number of them is the mean of
// the middle two; other percentiles are interpolated in the same way, linearly between the two
// nearest of the sorted errors.
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0, mean = 0, median = 0, max = 0;
  double deviation = 0;     // standard deviation: root mean square distance from the mean
  double p75 = 0, p95 = 0;  // percentiles
};

// Returns the statistics of some errors; nullopt if empty. O(n).
std::optional<ErrorStatistics> StatisticsOf(std::vector<double> errors);

// A pose of the estimate with its reference at that time.
struct EvaluatedPose {
  std::size_t row = 0;  // row in the estimate
  std::int64_t stamp_ns = 0;
  Rigid3 reference;           // world_from_camera
  Rigid3 estimate;            // world_from_camera, aligned to the world of the reference
  double position_error = 0;  // metres
  double rotation_error = 0;  // radians
};

// Error of the motion from one evaluated pose to another one, a window later.
struct RelativeError {
  std::size_t from = 0, to = 0;  // indices into TrajectoryError::poses
  double translation = 0;        // metres per second
  double rotation = 0;           // radians per second
};

// Result of CompareTrajectories.
struct TrajectoryError {
  std::size_t estimated = 0;            // number of poses of the estimate
  Similarity3 reference_from_estimate;  // the alignment
  // reason why positions alone do not determine the alignment
  std::optional<AlignmentFailure> degenerate;
  std::vector<EvaluatedPose> poses;     // the associated poses, in order of time
  std::vector<RelativeError> relative;  // pairs that span the window, in order of time
  ErrorStatistics ate;                  // distances of positions after alignment, metres
  std::optional<double> scale_drift;    // only for kSim3; see ScaleDrift
  std::optional<ErrorStatistics> rpe;   // metres per second; nullopt: no pair spans the window
  std::optional<ErrorStatistics> roe;   // radians per second
};

// Compares an estimated trajectory with a reference.
//
// ATE: distances of corresponding positions after the alignment that minimises their squares
// (Umeyama), over all associated poses. If the positions are collinear or coincide, `degenerate`
// says so, and the undetermined rotation, about the line or the whole, follows from the
// orientations of all poses. The scale is 1 if the positions coincide.
//
// RPE and ROE (relative position and orientation error): for every pair (a, b) of associated poses
// one window apart, E = (A_ref^-1 B_ref)^-1 (A_est^-1 B_est); |translation of E| and rotation angle
// of E, divided by the time between a and b in the estimate. The estimate has the scale of the
// alignment; rotation and translation of the alignment do not matter. Pairs:
//   duration   b is the associated pose nearest to a's time plus the duration (the earlier of two),
//              used if within 5 % of the duration
//   frames     b is this many rows of the estimate after a, used if the time between is at most
//              1.5 times that of the median spacing of rows (a longer one spans lost frames)
//
//   reference, estimate  of the same camera, stamps ascending, metres
//   fails    nullopt if no pose of the estimate has a reference; throws InputError for an invalid
//            rotation (UnitRotation)
//   cost     O(n log n)
std::optional<TrajectoryError> CompareTrajectories(const Trajectory& reference,
                                                   const Trajectory& estimate,
                                                   const TrajectoryErrorOptions& options);

// Returns the motion of the whole estimate, already aligned, that best aligns its poses. Positions
// and orientations count together, as the squared distances of the camera centre and of the six
// points 1 m from it along the camera's axes. Positions alone do not determine the rotation of a
// path that is short or straight, though all landmarks depend on that rotation.
//
//   poses    at least one; the estimates as in the result of CompareTrajectories
//   result   reference_from_aligned, scale 1
//   cost     O(n)
Similarity3 AlignPoses(std::span<const EvaluatedPose> poses);

// Returns the relative drift of the scale of an estimate: its scale in the last fifth of the poses,
// divided by that in the first fifth, minus 1. Positive: the estimate has become larger.
//
// The scale of a part is its spread (root mean square distance from the mean position) over the
// true one. For small errors this is the scale of its own alignment, and it is defined on straight
// paths, too.
//
//   poses    in order of time; the estimates in any world and scale, but all in the same: scales of
//            two maps of one camera are unrelated
//   fails    nullopt if the camera moves too little in one of the two fifths: their true spread
//            must be a twentieth of that of all poses
//   cost     O(n)
std::optional<double> ScaleDrift(std::span<const EvaluatedPose> poses);

// Returns the trajectory of the camera, given that of the body that carries it: world_from_body *
// body_from_camera. Throws InputError for an invalid rotation (UnitRotation).
Trajectory OfCamera(const Trajectory& body, const Rigid3& body_from_camera);

// Returns the trajectory in the world mirrored in y, seen by a camera mirrored in y, for ground
// truth with a negative focal length fy (ICL-NUIM). It is M R M and M t with M = diag(1, -1, 1).
// Throws InputError for an invalid rotation (UnitRotation).
Trajectory MirroredY(const Trajectory& trajectory);

}  // namespace plumbline
