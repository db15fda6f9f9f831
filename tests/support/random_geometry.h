// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>

namespace plumbline {

// Every entry normal with the given standard deviation.
template <int kSize>
Eigen::Matrix<double, kSize, 1> RandomVector(Rng& rng, double sigma = 1) {
  Eigen::Matrix<double, kSize, 1> v;
  for (int i = 0; i < kSize; ++i) v(i) = rng.Normal(sigma);
  return v;
}

// A positive definite matrix of widely different eigenvalues.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> RandomInformation(Rng& rng) {
  Eigen::Matrix<double, kSize, kSize> root;
  for (int i = 0; i < kSize; ++i) root.col(i) = (i + 1) * RandomVector<kSize>(rng);
  return root * root.transpose() + 0.1 * Eigen::Matrix<double, kSize, kSize>::Identity();
}

// A rotation by a uniform angle below max_angle about a random axis, and a random translation.
inline Rigid3 RandomRigid(Rng& rng, double max_angle = 3, double translation_sigma = 1) {
  const Eigen::Vector3d axis = RandomVector<3>(rng).normalized();
  const double angle = rng.Uniform(0, max_angle);
  return {ExpSo3(angle * axis), RandomVector<3>(rng, translation_sigma)};
}

// A stereo camera like EuRoC's after rectification; fx and fy differ to reveal confusion.
inline RectifiedCamera TestCamera() {
  return {
      .fx = 435, .fy = 420, .cx = 367, .cy = 252, .baseline = 0.11, .width = 752, .height = 480};
}

}  // namespace plumbline
