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

// Motion and structure from tracks. The world is the reference's camera; the unit of length is
// free.
struct Reconstruction {
  std::vector<Rigid3> cam_from_reference;  // one pose for each view
  std::vector<Eigen::Vector3d> points;     // one point for each point of the reference
  std::vector<bool> is_known;              // false where a point has no place
  // The place of each line of the reference; nullopt where none was found. Empty where lines do not
  // take part.
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

// Puts each point where all its rays from the poses of a reconstruction meet. Points whose rays do
// not meet in front have no place.
void TriangulatePoints(const FeatureTracks& tracks, Reconstruction& reconstruction);

// Triangulates the lines of the tracks from the poses (TriangulateLine). Lines that would lie
// behind a camera, or whose views hardly differ, have no place.
void TriangulateLines(const FeatureTracks& tracks, Reconstruction& reconstruction);

// How well the points of a reconstruction fit the tracks.
struct ReprojectionFit {
  // Sum of the squared reprojection errors over their variances, each at most `max_chi2`, over all
  // matches of all points with the reference. Matches of points without a place count `max_chi2`.
  double cost = 0;
  int measurements = 0;  // number of errors in the sum, of two coordinates each
  int inliers = 0;       // measurements whose error is within max_chi2
  // Noise of a measurement in units of the standard deviation assumed: the square root of `cost`
  // over the degrees of freedom that the parameters leave.
  double noise = 0;
};

// Tests all points against their measurements.
//   max_chi2  limit of an error, in variances as assumed
ReprojectionFit EvaluatePoints(const FeatureTracks& tracks,
                               const Reconstruction& reconstruction,
                               double max_chi2);

// The squared distances of the ends of a line's segments from its image, over their variances.
struct LineFit {
  // Sum over views, each at most `max_chi2`; every view of a line without a place counts
  // `max_chi2`.
  double cost = 0;
  bool inlier = false;  // whether the line is an inlier in every view that shows it
  double chi2 = 0;      // sum over views without a limit
  int freedom = 0;      // degrees of freedom: two for each view, minus four
};

// Tests each line against its measurements.
//   max_chi2  limit for the two ends in one view
//   returns   one for each line of the tracks; empty where lines do not take part
std::vector<LineFit> EvaluateLines(const FeatureTracks& tracks,
                                   const Reconstruction& reconstruction,
                                   double max_chi2);

// A short joint bundle adjustment of all frames, and of all points and lines that have a place. It
// uses the matches alone, since interpolated places are not measurements. The reference is fixed;
// damping holds the unit.
Reconstruction BundleAdjust(const FeatureTracks& tracks,
                            Reconstruction reconstruction,
                            int max_iterations);

// Scales poses and points so that the median depth in the reference is one. Lines are left as they
// are.
void ScaleToMedianDepth(Reconstruction& reconstruction);

}  // namespace plumbline
