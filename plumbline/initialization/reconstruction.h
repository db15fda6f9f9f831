// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/initialization/tracks.h"
#include "plumbline/optimization/problem.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Motion and structure from tracks. The world is the reference's camera; the scale is arbitrary.
struct Reconstruction {
  std::vector<Rigid3> cam_from_reference;  // one pose for each view
  std::vector<Eigen::Vector3d> points;     // one point for each point of the reference
  std::vector<bool> is_known;              // false if a point has no position
  // Position of each line of the reference; nullopt if unknown. Empty if lines are not used.
  std::vector<std::optional<PluckerLine>> lines = {};

  // Returns the pose of a view: 0 is the reference, later views count from 1.
  Rigid3 Pose(std::size_t view) const {
    return view == 0 ? Rigid3{} : cam_from_reference[view - 1];
  }
};

// A camera whose pixels are ideal image coordinates (x/z, y/z).
inline constexpr RectifiedCamera kIdealCamera = [] {
  RectifiedCamera camera;
  camera.fx = camera.fy = 1;
  return camera;
}();

// Returns the measurement of point or line k in a frame. The standard deviation of a line is
// multiplied by `noise`.
PointMeasurement MeasurementOf(const ViewPoints& view, std::size_t k);
LineMeasurement MeasurementOf(const ViewLines& view, std::size_t k, double noise = 1);

// Triangulates each point from all its rays and the poses of a reconstruction. Points whose rays do
// not intersect in front get no position.
void TriangulatePoints(const FeatureTracks& tracks, Reconstruction& reconstruction);

// Triangulates the lines of the tracks from the poses (TriangulateLine). Lines behind a camera, or
// whose views hardly differ, get no position.
void TriangulateLines(const FeatureTracks& tracks, Reconstruction& reconstruction);

// Fit of the points of a reconstruction to the tracks.
struct ReprojectionFit {
  // Sum of the squared reprojection errors over their variances, each at most `max_chi2`, over all
  // matches of all points with the reference. Matches of points without a position count
  // `max_chi2`.
  double cost = 0;
  int measurements = 0;  // number of errors in the sum, of two coordinates each
  int inliers = 0;       // measurements whose error is within max_chi2
  // Noise of a measurement in units of the assumed standard deviation: the square root of `cost`
  // over the degrees of freedom left by the parameters.
  double noise = 0;
};

// Tests all points against their measurements.
//   max_chi2  limit of an error, in assumed variances
ReprojectionFit EvaluatePoints(const FeatureTracks& tracks,
                               const Reconstruction& reconstruction,
                               double max_chi2);

// Fit of a line: squared distances of the ends of its segments from its projection, over their
// variances.
struct LineFit {
  // Sum over views, each at most `max_chi2`; every view of a line without a position counts
  // `max_chi2`.
  double cost = 0;
  bool inlier = false;  // true if the line is an inlier in all its views
  double chi2 = 0;      // sum over views without a limit
  int freedom = 0;      // degrees of freedom: two for each view, minus four
};

// Tests each line against its measurements.
//   max_chi2  limit for the two ends in one view
//   returns   one for each line of the tracks; empty if lines are not used
std::vector<LineFit> EvaluateLines(const FeatureTracks& tracks,
                                   const Reconstruction& reconstruction,
                                   double max_chi2);

// A short joint bundle adjustment of all frames, and of all points and lines with a position. It
// uses only the matches, since interpolated positions are not measurements. The reference is fixed;
// damping fixes the scale.
Reconstruction BundleAdjust(const FeatureTracks& tracks,
                            Reconstruction reconstruction,
                            int max_iterations);

// Scales poses and points to a median depth of one in the reference. Lines do not change.
void ScaleToMedianDepth(Reconstruction& reconstruction);

}  // namespace plumbline
