// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/stereo_correction.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/map/map.h"

#include <Eigen/Core>

namespace plumbline {

// Learns the smooth part of the errors of disparities (StereoCorrection) from a map.
//
// Where at least three keyframes show a point in their left images, these and the poses tell where
// the right image should show it; what the right image was measured to show is off by c(x, y).
// Points alone: where there are none, lines learned a correction that bent the map. A normal
// distribution for each coefficient, its deviation 4e-4 of the image's width, comes before all
// evidence; the evidence enters under the Huber loss. The mean of c over all evidence is left as it
// is: with the poses that were found with the same disparities it tells little, and the scale of
// the map, which hangs on it, is the calibration's to say.
class StereoCalibrator {
 public:
  explicit StereoCalibrator(const RectifiedCamera& camera);

  // Takes in the disparities of one keyframe. To be called once for each, when others after it show
  // the same landmarks. Nothing with a single camera. Cost: a triangulation for each landmark.
  void Observe(const Map& map, const KeyFrame& keyframe);

  // The correction that all evidence so far speaks for; none before there is any.
  StereoCorrection Estimate() const;

 private:
  // A displacement measured at a place of the right image, with its variance.
  void Add(const StereoCorrection& current,
           const Eigen::Vector2d& px,
           double displacement,
           double variance);

  RectifiedCamera camera_;
  Matrix6d information_ = Matrix6d::Zero();
  Vector6d weighted_ = Vector6d::Zero();
};

}  // namespace plumbline
