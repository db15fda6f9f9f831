// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cutting_problem.h"

#include "plumbline/base/error.h"

namespace plumbline {

Eigen::Matrix3d CovarianceFromInverseDepth(const RectifiedCamera& camera,
                                           const Eigen::Vector3d& point_in_cam,
                                           double sigma_px,
                                           double sigma_inverse_depth) {
  const double z = point_in_cam.z();
  PLUMBLINE_CHECK(z > 0, "a covariance is asked for a point behind the camera");
  const double sigma_x = sigma_px * z / camera.fx;
  const double sigma_y = sigma_px * z / camera.fy;
  const Eigen::Vector3d along_ray = sigma_inverse_depth * z * point_in_cam;
  Eigen::Matrix3d covariance = along_ray * along_ray.transpose();
  covariance(0, 0) += sigma_x * sigma_x;
  covariance(1, 1) += sigma_y * sigma_y;
  return covariance;
}

Eigen::Matrix3d CovarianceFromDisparity(const RectifiedCamera& camera,
                                        const Eigen::Vector3d& point_in_cam,
                                        double sigma_px,
                                        double sigma_disparity_px) {
  PLUMBLINE_CHECK(camera.baseline > 0, "no disparity without a baseline");
  return CovarianceFromInverseDepth(
      camera, point_in_cam, sigma_px, sigma_disparity_px / (camera.fx * camera.baseline));
}

}  // namespace plumbline
