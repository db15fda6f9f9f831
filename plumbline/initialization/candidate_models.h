// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/units.h"
#include "plumbline/initialization/reconstruction.h"

#include <vector>

namespace plumbline {

// One of the models of motion and structure among which the tracks decide, and how well it fits.
struct CandidateModel {
  Reconstruction reconstruction;
  ReprojectionFit fit;    // of the points
  double cost = 0;        // of points and, where they take part, lines
  int lines = 0;          // inliers in every view which shows them
  double line_noise = 1;  // of the inliers, in units of the standard deviation assumed
};

// Motions nearer to each other than this, radians, are the same.
inline constexpr double kSameRotation = 0.3 * kDegree;
inline constexpr double kSameDirection = 3 * kDegree;
// Whether two poses are, whatever their units.
bool IsSameMotion(const Rigid3& a, const Rigid3& b);

// Adds a model; of two whose newest poses are the same the cheaper stays.
void InsertModel(CandidateModel model, std::vector<CandidateModel>& models);

void SortByCost(std::vector<CandidateModel>& models);

// Bundle adjustment of all that has a place; fit and cost are those of the points after it.
void AdjustModel(const Tracks& tracks, CandidateModel& model);

// Adjusts models found by points to points and lines together.
//
//  - Lines are triangulated from the poses of each model and join its bundle adjustment, with the
//    noise of their fit to the best one, at least `min_noise` of what is said.
//  - A line speaks for a model when it is an inlier in every view that shows it; the cost of a
//    model is that of its points and of the lines that are inliers of any model. Wrong matches,
//    which fit none, do not count.
//  - The cost is a valley along what is least known, and may have two minima there that lie further
//    apart than either covariance says. So the best model is moved 6 degrees to either side along
//    the valley and adjusted again: another minimum is another model.
//
//   tracks   its lines get the noise found
//   models   the best first; not empty
//   returns  distinct ones, the best first
//   cost     some milliseconds for 50 points and 30 lines in four views
std::vector<CandidateModel> AdjustWithLines(Tracks& tracks,
                                            std::vector<CandidateModel> models,
                                            double min_noise);

}  // namespace plumbline
