// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A pixel measurement of a point in the left camera, with its disparity if measured. Residual (px -
// projection) / sigma_px and, as a third row, (disparity - predicted) / its sigma: the disparity,
// not the right column, because its error is independent of the left column's.
struct PointMeasurement {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  std::optional<Disparity> disparity;
};

// A segment measured in the left or right camera. Residual: signed distances of its two end points
// from the projected infinite line (Lee and Hwang, ICCV 2019, eq. 13), weighted by the inverse of
// `covariance` (2 x 2, px^2). Two measurements of one line in the two cameras of a pair are two
// LineMeasurements.
struct LineMeasurement {
  Segment2 segment;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  int camera = 0;  // camera of the pair: 0 the left (or only) one, 1 the right one
};

// Bundle adjustment as plain data, independent of the map.
struct BaProblem {
  // Initial pose of a camera.
  struct Pose {
    Rigid3 cam_from_world;
    bool fixed = false;
    // True if it comes soon after the previous pose in time (FixInconsistentPoses); not used by
    // SolveLocalBa.
    bool follows = true;
  };
  // An observation of a point; indices into `poses` and `points`.
  struct PointObservation {
    int pose = 0;
    int point = 0;
    PointMeasurement measurement;
  };
  // An observation of a line; indices into `poses` and `lines`.
  struct LineObservation {
    int pose = 0;
    int line = 0;
    LineMeasurement measurement;
  };
  // A line that is parallel to an axis, with either sense; indices into `axes` and `lines`.
  // Residual: the two components of the line's unit direction across the axis, over sigma.
  struct ParallelLine {
    int axis = 0;
    int line = 0;
    double sigma = 1;  // rad, per component
  };

  RectifiedCamera camera;
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;  // in the world
  std::vector<OrthonormalLine> lines;   // in the world
  // The two ends of each line, in the world, for solvers whose lines are two points; else empty.
  std::vector<Segment3> line_ends;
  std::vector<PointObservation> point_observations;
  std::vector<LineObservation> line_observations;
  std::vector<Eigen::Vector3d> axes;  // constant unit vectors in the world
  std::vector<ParallelLine> parallel_lines;
};

// Prior of a pose: normally distributed about `cam_from_world`, with the information of the left
// perturbation [rotation, translation]. Zero information: no prior.
struct PosePrior {
  Rigid3 cam_from_world;
  Matrix6d information = Matrix6d::Zero();
};

// A camera pose to be estimated from fixed landmarks by SolvePose (pose_only.h).
struct PoseProblem {
  // A point of the map and its measurement in the frame.
  struct PointMatch {
    Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
    PointMeasurement measurement;
    // Covariance of the point in the world [map scale^2], in addition to that of the measurement;
    // zero if the position counts as exact.
    Eigen::Matrix3d point_covariance = Eigen::Matrix3d::Zero();
  };
  // A line of the map and its measurement in the frame.
  struct LineMatch {
    PluckerLine line_in_world;
    LineMeasurement measurement;
    int group = 0;  // measurements of one landmark share a group and are kept or rejected together
    // Ends, in the world, of the part of the line in use; eq. 13 does not need them.
    Segment3 ends = {};
  };

  RectifiedCamera camera;
  Rigid3 cam_from_world;  // initial pose
  PosePrior prior;
  std::vector<PointMatch> points;
  std::vector<LineMatch> lines;
};

}  // namespace plumbline
