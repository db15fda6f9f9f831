// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/bundle_adjustment_result.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns for each pose the factor by which a solution has changed the depths of its points, as the
// median over these points; 1 if depth is measured. A pose with fewer than ten points in front of
// it gets the factor of the pose before it; the first ones get that of the first pose with enough.
std::vector<double> ScalesOf(const BaProblem& problem, const BaResult& result);

// Scales a solution for a single camera about the camera of its first pose, so that the median
// depth of this pose's points is unchanged. Does nothing if depth is measured, or if two or more
// poses are fixed, which fix the scale. Otherwise no measurement fixes it, and the damped steps of
// an adjustment change it: a map of twenty keyframes grew by two thirds within a second of forward
// motion, and earlier reported poses were inconsistent with all later ones.
void FixScaleToOldestKeyFrame(const BaProblem& problem, BaResult& result);

// Moves a solution for a single camera as a whole, poses, points and lines, so that one of its
// poses is unchanged, and scales it so that the median depth of this pose's points is unchanged. If
// it is the newest one, later reported poses continue the earlier ones without a step. Does nothing
// if depth is measured.
void KeepPlaceOf(std::size_t pose, const BaProblem& problem, BaResult& result);

}  // namespace plumbline
