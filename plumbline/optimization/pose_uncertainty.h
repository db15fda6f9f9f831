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

// How well a pose is known: standard deviations in the worst direction, each with the other five
// degrees of freedom unknown (marginal). Infinite where the information leaves a direction open.
struct PoseUncertainty {
  double rotation = 0;     // radians
  double translation = 0;  // relative to the depth of the scene
  double scene_depth = 0;  // median of the landmarks; 0: there are none

  // Whether both deviations are at most `limit`. Counts of inliers do not tell it. A hundred
  // parallel lines leave the pose open, six in three directions fix it.
  bool AtMost(double limit) const { return rotation <= limit && translation <= limit; }
};

// How well a pose is known, from the information of a left perturbation [rotation, translation] of
// cam_from_world, the translation in the unit of scene_depth: the median depth of the landmarks,
// greater than 0 (with any other depth the result is infinite). Having no unit, one limit serves a
// room, a road and a map from one camera.
PoseUncertainty SigmaOfPose(const Matrix6d& information, double scene_depth);

// Returns how well each pose of a problem is known from its observations, with all landmarks held.
// The function uses nothing of `state` but poses, points, lines and inliers.
std::vector<PoseUncertainty> SigmasOfPoses(const BaProblem& problem, const BaResult& state);

// Marks free poses as fixed that the observations in use do not fix to `limit`: `sigmas` are those
// of the poses (SigmasOfPoses). Such a pose fits its few observations almost anywhere, so that a
// solution would take it there. Returns whether there were any. The caller has to solve again, from
// the problem's poses.
bool FixUnconstrainedPoses(const std::vector<PoseUncertainty>& sigmas,
                           double limit,
                           BaProblem& problem);

// The limits within which a pose is adjusted.
struct PoseLimits {
  double sigma = 0;  // largest PoseUncertainty
  // Largest change against the pose before it: in radians, and relative to the scene's depth.
  double change = 0;
};

// Marks consecutive poses of the problem as fixed that the solution, in which the poses are known
// to `sigmas`, moves against one another by more than `limits.change`. The landmarks of each fix
// its pose then, but what ties their parts of the map leaves a direction open (lines along a road).
// Poses that are loose themselves are passed over; a pose that does not follow (BaProblem::Pose) is
// not compared with those before it. Returns whether there were any that were not fixed yet.
bool FixInconsistentPoses(const BaResult& solution,
                          const std::vector<PoseUncertainty>& sigmas,
                          const PoseLimits& limits,
                          BaProblem& problem);

// Returns the solution of `solve`, in which loose and torn poses are held (marked as fixed in the
// problem). Poses are held that are loose before a solution, or by the observations that it
// rejects. The problem is solved again until no two consecutive poses are torn apart
// (FixInconsistentPoses), up to four times, the last time with all poses held. Returns nullopt
// where the numbers are not finite, and when stopped, since a solution halfway is of no use.
// `normalize`, if any, is applied to each solution before it is looked at. Cost: most often that of
// one solution, at most that of eight.
std::optional<BaResult> SolveWithPoseLimits(BaProblem& problem,
                                            const LocalBaOptions& options,
                                            BaSolver solve,
                                            const PoseLimits& limits,
                                            const std::function<void(BaResult&)>& normalize = {},
                                            const StopCheck& stop = {});

}  // namespace plumbline
