// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/bundle_adjustment_result.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <vector>

namespace plumbline {

// Returns for each pose the factor by which a solution has changed the depths of the points that
// this pose shows, as the median over these points; 1 where lengths are measured. A pose that shows
// fewer than ten points in front of it gets the factor of the pose before it; the first ones get
// that of the first pose that shows enough.
std::vector<double> ScalesOf(const BaProblem& problem, const BaResult& result);

// Scales a solution for a single camera about the camera of its first pose, so that the depths that
// this pose shows stay as they were in the median. Does nothing where lengths are measured, or
// where two or more poses are fixed, which hold the unit of length. Otherwise no measurement holds
// it, and the damped steps of an adjustment leave it somewhere else: a map of twenty keyframes grew
// by two thirds within a second of forward motion, and the poses reported before fitted no later
// ones.
void FixScaleToOldestKeyFrame(const BaProblem& problem, BaResult& result);

// Moves a solution for a single camera as a whole, poses, points and lines, so that one of its
// poses is where it was, and scales it so that the depths which this pose shows stay as they were
// in the median. Where it is the newest one, poses that are reported from then on go on from those
// before without a step. Does nothing where lengths are measured.
void KeepPlaceOf(std::size_t pose, const BaProblem& problem, BaResult& result);

}  // namespace plumbline
