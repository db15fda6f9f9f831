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
  ReprojectionFit fit;  // how well the points fit
  double cost = 0;      // cost of points and, where they take part, lines
  int lines = 0;        // number of lines that are inliers in every view that shows them
  // Noise of these lines, in units of the standard deviation assumed.
  double line_noise = 1;
};

// Motions are the same if their rotations and their directions differ by less than this [radians].
inline constexpr double kSameRotation = 0.3 * kDegree;
inline constexpr double kSameDirection = 3 * kDegree;
// Whether two poses have the same rotation and direction of translation, whatever their units.
bool IsSameMotion(const Rigid3& a, const Rigid3& b);

// Adds a model. Of two models with the same newest pose only the cheaper stays.
void InsertModel(CandidateModel model, std::vector<CandidateModel>& models);

void SortByCost(std::vector<CandidateModel>& models);

// Adjusts all poses, points and lines that have a place; sets fit and cost to those of the points
// after it.
void AdjustModel(const FeatureTracks& tracks, CandidateModel& model);

// Adjusts models that were found by points to points and lines together.
//
//  - Lines are triangulated from the poses of each model and join its bundle adjustment. Their
//    noise is that of their fit to the best model, but at least `min_noise` of the deviation
//    assumed.
//  - A line supports a model when it is an inlier in every view that shows it. The cost of a model
//    is that of its points and of the lines that are inliers of any model. Wrong matches fit no
//    model and do not count.
//  - The cost is a valley along the direction that is fixed least, and may have two minima there
//    that lie further apart than either covariance says. The best model is therefore moved 6
//    degrees to either side along the valley and adjusted again; another minimum is another model.
//
//   tracks   the noise of its lines is set to what was found
//   models   the best first; not empty
//   returns  distinct models, the best first
//   cost     some milliseconds for 50 points and 30 lines in four views
std::vector<CandidateModel> AdjustWithLines(FeatureTracks& tracks,
                                            std::vector<CandidateModel> models,
                                            double min_noise);

}  // namespace plumbline
