// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/optimization/problem.h"

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
  struct PointPair {
    CameraPoint in_query, in_candidate;
  };
  struct LinePair {
    LineModel in_query, in_candidate;
  };
  // An observation by one of the two cameras of a point whose position only the other one knows.
  struct Sighting {
    bool known_to_query = true;
    CameraPoint point;
    PointMeasurement measurement;  // measurement by the other camera
  };

  RectifiedCamera camera;
  bool free_scale = false;  // true with one camera, whose scale is unknown
  std::vector<PointPair> points;
  std::vector<LinePair> lines;
  std::vector<Sighting> sightings;
};

}  // namespace plumbline
