// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/optimization/local_ba.h"
#include "plumbline/optimization/problem.h"

#include <functional>
#include <optional>
#include <vector>

namespace plumbline {

// How well a pose is known: standard deviations in the worst direction, each with the other five
// degrees of freedom unknown (marginal). Infinite where the information leaves a direction open.
struct PoseSigma {
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
PoseSigma SigmaOfPose(const Matrix6d& information, double scene_depth);

// How well each pose of a problem is known from its observations, with all landmarks where they
// are; of `state` only poses, points, lines and inliers are used.
std::vector<PoseSigma> SigmasOfPoses(const BaProblem& problem, const BaResult& state);

// Marks the free poses as fixed that the observations in use do not fix to `limit`: whatever lets
// them fit the few observations they have is cheap, and takes them anywhere. Returns whether there
// were any. The caller solves again, from the problem's poses.
bool HoldLoosePoses(const BaResult& state, double limit, BaProblem& problem);

// What a pose must keep to, to be adjusted.
struct PoseLimits {
  double sigma = 0;   // PoseSigma at most
  double change = 0;  // against the pose before it at most: radians, and of the scene's depth
};

// Marks as fixed the poses of the problem that follow each other and that the solution moves
// against one another by more than `limits.change`: what ties their parts of the map leaves a
// direction open (lines along a road), though the landmarks of each fix its pose. Those that are
// loose themselves are passed over; between a pose that does not follow (BaProblem::Pose) and
// those before it there is no tear. Returns whether there were any that were not fixed yet.
bool HoldTornPoses(const BaResult& solution, const PoseLimits& limits, BaProblem& problem);

// The solution of `solve` with those poses held that are loose before it, or by what it leaves of
// their observations (they are marked as fixed in the problem), again until no two that follow each
// other are torn apart (HoldTornPoses), up to four times, the last time with all poses held.
// nullopt where the numbers are not finite, and when stopped: a solution halfway is none.
// `normalize`, if any, is applied to each solution before it is looked at. Cost: most often that of
// one solution, at most eight.
std::optional<BaResult> SolveInOnePiece(BaProblem& problem,
                                        const LocalBaOptions& options,
                                        BaSolver solve,
                                        const PoseLimits& limits,
                                        const std::function<void(BaResult&)>& normalize = {},
                                        const StopCheck& stop = {});

}  // namespace plumbline
