// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/optimization/problem.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The relative pose of two cameras, "query" and "candidate", from landmarks known to both, as plain
// data. Each landmark is in the frame and scale of one of the two.

// A point in the frame of a camera.
struct CameraPoint {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// The matches between the landmarks and images of the two cameras.
struct AlignmentProblem {
  // An observation by one of the two cameras of a point whose position only the other one knows.
  struct Sighting {
    bool known_to_query = true;
    CameraPoint point;
    PointMeasurement measurement;  // measurement by the other camera
  };

  RectifiedCamera camera;
  bool free_scale = false;  // true with one camera, whose scale is unknown
  std::vector<LandmarkPair<CameraPoint>> points;
  std::vector<LandmarkPair<LineModel>> lines;
  std::vector<Sighting> sightings;
};

// A relative pose, and its inlier matches.
struct AlignmentResult {
  Similarity3 candidate_from_query;
  // Covariance of the left perturbation [rotation, translation, log scale], multiplied by the mean
  // squared residual if that is above 1. Without free scale the last row and column are zero.
  Matrix7d covariance = Matrix7d::Zero();
  std::vector<bool> points, lines, sightings;  // true for inliers
};

// Estimates a relative pose from matches with many outliers, by LO-RANSAC (ransac.h) over samples
// of three points or lines in any mixture (AlignSample). Poses are scored by RefineAlignment's
// residuals. The same input and seed give the same result.
//
// Returns nullopt with less than three matches, and if no sample determines a pose. Sightings are
// not used. Cost: about 2 ms for 100 matches, a third of which are right.
std::optional<Similarity3> AlignByRansac(const AlignmentProblem& problem, std::uint64_t seed);

// Refines a relative pose near a given one with all matches, and classifies them.
//
// Residuals: points have their difference in the image of the candidate's camera, in column, row
// and inverse depth, where their errors are nearly normal; lines have the distances of two points
// of the query's line from the candidate's line, across it; sightings have their error in the pixel
// (and the disparity). All are whitened by the covariance of both sides, so that every measurement
// behind the landmarks counts once. Gauss-Newton with Huber's loss; matches further off than `gate`
// times the 95 % limit of chi2 are not used.
//
// Returns nullopt if the matches leave a direction undetermined, or fewer than three agree.
// O(matches).
std::optional<AlignmentResult> RefineAlignment(const AlignmentProblem& problem,
                                               const Similarity3& near,
                                               double gate);

// Returns the similarity (scale 1 unless it is free) from the query's camera to the candidate's
// that aligns a few points and lines. Three matches are needed; two are enough if at least one is
// of lines.
//
// The rotation best aligns unit vectors (Kabsch 1976): the directions of lines (lines are
// directed), those between points, and those from lines to points, perpendicular to the lines.
// Scale and translation then solve the linear equations that points coincide, and that points of
// the query's lines lie on the candidate's.
//
// Returns nullopt if the matches are degenerate (collinear points, parallel lines alone, coplanar
// lines with free scale), or if the scale is negative.
std::optional<Similarity3> AlignSample(std::span<const LandmarkPair<CameraPoint>> points,
                                       std::span<const LandmarkPair<LineModel>> lines,
                                       bool free_scale);

}  // namespace plumbline
