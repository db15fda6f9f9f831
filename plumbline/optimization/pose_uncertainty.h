// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/bundle_adjustment.h"
#include "plumbline/optimization/problem.h"

#include <functional>
#include <optional>
#include <vector>

namespace plumbline {

// Uncertainty of a pose: standard deviations in the worst direction, marginalized over the other
// degrees of freedom. Infinite if the information leaves a direction undetermined.
struct PoseUncertainty {
  double rotation = 0;     // radians
  double translation = 0;  // relative to the depth of the scene
  double scene_depth = 0;  // median depth of the landmarks; 0: no landmarks

  // Returns true if both deviations are at most `limit`. Numbers of inliers cannot replace it: a
  // hundred parallel lines leave the pose undetermined, six in three directions determine it.
  bool AtMost(double limit) const { return rotation <= limit && translation <= limit; }
};

// Uncertainty of a pose from the information of a left perturbation [rotation, translation] of
// cam_from_world, with the translation in the same scale as scene_depth: the median depth of the
// landmarks, greater than 0 (otherwise the result is infinite). It is dimensionless, so that one
// limit serves a room, a road and a map of a single camera.
PoseUncertainty SigmaOfPose(const Matrix6d& information, double scene_depth);

// Returns the uncertainty of each pose of a problem given its observations, with all landmarks
// fixed. Only poses, points, lines and inliers of `state` are used.
std::vector<PoseUncertainty> SigmasOfPoses(const BaProblem& problem, const BaResult& state);

// Marks free poses as fixed whose uncertainty exceeds `limit`: `sigmas` are those of the poses
// (SigmasOfPoses). Such a pose fits its few observations almost anywhere, so that a solution would
// move it arbitrarily. Returns true if any was marked; the caller must then solve again, from the
// problem's poses.
bool FixUnconstrainedPoses(const std::vector<PoseUncertainty>& sigmas,
                           double limit,
                           BaProblem& problem);

// Limits on the adjustment of a pose.
struct PoseLimits {
  double sigma = 0;  // largest PoseUncertainty
  // Largest change relative to the previous pose: in radians, and relative to the scene's depth.
  double change = 0;
};

// Marks consecutive poses of the problem as fixed that the solution, in which the poses have the
// uncertainties `sigmas`, moves relative to one another by more than `limits.change`. Each of them
// is then determined by its landmarks, but the connection between their parts of the map leaves a
// direction undetermined (lines along a road). Unconstrained poses are skipped; a pose that does
// not follow (BaProblem::Pose) is not compared with those before it. Returns true if any was not
// fixed yet.
bool FixInconsistentPoses(const BaResult& solution,
                          const std::vector<PoseUncertainty>& sigmas,
                          const PoseLimits& limits,
                          BaProblem& problem);

// Returns the solution of `solve` with unconstrained and inconsistent poses fixed (marked as fixed
// in the problem). Poses are fixed that are unconstrained before a solution, or by the observations
// that it rejects. The problem is solved again until no two consecutive poses are inconsistent
// (FixInconsistentPoses), up to four times, the last time with all poses fixed. Returns nullopt if
// the numbers are not finite, and when stopped, since a partial solution is useless. `normalize`,
// if any, is applied to each solution before it is checked. Cost: usually that of one solution, at
// most that of eight.
std::optional<BaResult> SolveWithPoseLimits(BaProblem& problem,
                                            const LocalBaOptions& options,
                                            BaSolver solve,
                                            const PoseLimits& limits,
                                            const std::function<void(BaResult&)>& normalize = {},
                                            const StopCheck& stop = {});

}  // namespace plumbline
