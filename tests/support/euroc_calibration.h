// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"

namespace plumbline {

// The stereo pair of the EuRoC MH sequences, numbers as in their sensor.yaml.
inline Calibration EurocCalibration() {
  const auto rigid = [](const Eigen::Matrix4d& m) {
    return Rigid3{Eigen::Quaterniond(Eigen::Matrix3d(m.topLeftCorner<3, 3>())).normalized(),
                  m.topRightCorner<3, 1>()};
  };
  Eigen::Matrix4d body_from_left;
  body_from_left << 0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,  //
      0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,                    //
      -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,                //
      0, 0, 0, 1;
  Eigen::Matrix4d body_from_right;
  body_from_right << 0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556,  //
      0.999598781151, 0.0130119051815, 0.0251588363115, 0.0453689425024,                   //
      -0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038,                 //
      0, 0, 0, 1;
  Calibration calibration;
  calibration.left = Camera({.fx = 458.654,
                             .fy = 457.296,
                             .cx = 367.215,
                             .cy = 248.375,
                             .width = 752,
                             .height = 480,
                             .model = DistortionModel::kRadTan,
                             .distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}});
  calibration.right = Camera({.fx = 457.587,
                              .fy = 456.134,
                              .cx = 379.999,
                              .cy = 255.238,
                              .width = 752,
                              .height = 480,
                              .model = DistortionModel::kRadTan,
                              .distortion = {-0.28368365, 0.07451284, -0.00010473, -3.555907e-05}});
  calibration.right_from_left = Inverse(rigid(body_from_right)) * rigid(body_from_left);
  calibration.rate_hz = 20;
  calibration.body_from_left = rigid(body_from_left);
  return calibration;
}

}  // namespace plumbline
