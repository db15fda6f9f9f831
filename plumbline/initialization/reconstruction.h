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

// Motion and structure from tracks: the reference's camera is the world, its unit free.
struct Reconstruction {
  std::vector<Rigid3> cam_from_reference;  // by view
  std::vector<Eigen::Vector3d> points;     // by point of the reference
  std::vector<bool> is_known;              // by point: false where there is no place for it
  // The place of each line of the reference view, nullopt where none was found; empty where lines
  // do not take part.
  std::vector<std::optional<PluckerLine>> lines = {};

  // Returns the pose of a view: 0 is the reference, later views count from 1.
  Rigid3 Pose(std::size_t view) const {
    return view == 0 ? Rigid3{} : cam_from_reference[view - 1];
  }
};

// The camera whose pixels are ideal image coordinates.
inline constexpr RectifiedCamera kIdealCamera = [] {
  RectifiedCamera camera;
  camera.fx = camera.fy = 1;
  return camera;
}();

// What a frame shows of point or line k, the standard deviation of a line times `noise`.
PointMeasurement MeasurementOf(const TrackedPoints& view, std::size_t k);
LineMeasurement MeasurementOf(const TrackedLines& view, std::size_t k, double noise = 1);

// Puts the points where all their rays from the poses of a reconstruction meet, and leaves those
// whose rays do not meet in front.
void TriangulatePoints(const Tracks& tracks, Reconstruction& reconstruction);

// Finds the lines of the tracks from the poses (TriangulateLine); those that would lie behind a
// camera, or whose views hardly differ, have no place.
void TriangulateLines(const Tracks& tracks, Reconstruction& reconstruction);

// How well the points of a reconstruction fit the tracks.
struct ReprojectionFit {
  // Squared reprojection errors over their variances, each at most `max_chi2`, summed over all
  // matches of all points with the reference: those of points without a place count in full.
  double cost = 0;
  int measurements = 0;  // that are summed, two coordinates each
  int inliers = 0;       // measurements within max_chi2
  // Noise of a measurement in units of the standard deviation assumed: the root mean square of the
  // errors, each limited as in `cost`, over the degrees of freedom that the parameters leave.
  double noise = 0;
};

// The inlier test of all points.
//   max_chi2  in variances as assumed
ReprojectionFit EvaluatePoints(const Tracks& tracks,
                               const Reconstruction& reconstruction,
                               double max_chi2);

// Squared distances of the ends of a line's segments from its image over their variances.
struct LineFit {
  double cost = 0;      // each view at most `max_chi2`; those of a line without a place in full
  bool inlier = false;  // in every view that shows it
  double chi2 = 0;      // not limited
  int freedom = 0;      // two a view, less four
};

// The inlier test of each line.
//   max_chi2  of the two ends in one view
//   returns   by line of the tracks; empty where lines do not take part
std::vector<LineFit> EvaluateLines(const Tracks& tracks,
                                   const Reconstruction& reconstruction,
                                   double max_chi2);

// A short joint bundle adjustment of all frames, points and lines that have a place on the matches
// alone (interpolated places are not measurements). The reference and, by damping, the unit stay.
Reconstruction BundleAdjust(const Tracks& tracks,
                            Reconstruction reconstruction,
                            int max_iterations);

// Scales the reconstruction so that the median depth in the reference is one; lines are left.
void ScaleToMedianDepth(Reconstruction& reconstruction);

}  // namespace plumbline
