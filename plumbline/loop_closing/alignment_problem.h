// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/optimization/problem.h"

#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The relative pose of two cameras, "query" and "candidate", from landmarks that both of them know,
// as plain data. Each landmark is in the frame and the unit of one of the two.

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
  // A point whose place only one of the two cameras knows, and which the other one saw.
  struct Sighting {
    bool known_to_query = true;
    CameraPoint point;
    PointMeasurement measurement;  // what the other camera measured
  };

  RectifiedCamera camera;
  bool free_scale = false;  // true with one camera, where the unit of length is unknown
  std::vector<PointPair> points;
  std::vector<LinePair> lines;
  std::vector<Sighting> sightings;
};

}  // namespace plumbline
