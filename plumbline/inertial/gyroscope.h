// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/sim3.h"
#include "plumbline/inertial/inertial_calibration.h"
#include "plumbline/inertial/inertial_sample.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Errors of a gyroscope at a camera: [bias, place, clock]. Bias in rad/s along the sensor's axes;
// place as the rotation vector in the camera that corrects the calibration's rotation; clock in
// seconds as InertialCalibration::time_offset.
using GyroscopeErrors = Vector7d;
using Matrix37d = Eigen::Matrix<double, 3, 7>;

// The turn of a camera between two frames a and b by a gyroscope.
struct CameraTurn {
  Eigen::Quaterniond b_from_a = Eigen::Quaterniond::Identity();
  // Covariance of the left perturbation of b_from_a: noise, gaps, errors of the sensor.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  // the part of it without the errors
  Matrix37d by_errors = Matrix37d::Zero();              // derivative of the left perturbation
};

// The gyroscope at a camera: turns of the camera between frames, and what the camera's own
// measurements of these turns tell about bias, place and clock of the sensor.
//
// A filter estimates the errors. It begins with deviations of 0.1 rad/s for the bias, 3 degrees
// for the place and 3 ms for the clock (10 ms if the calibration does not tell it), and learns by
// each turn that the camera measured, with its covariance. Where the camera contradicts, by more
// than three deviations in the mean of the last turns, the sensor is put aside (`agrees`) until it
// agrees again.
class Gyroscope {
 public:
  // calibration  with imu_from_left; without noise, that of InertialNoise's defaults is assumed
  // rectified_from_left  rotation of the camera whose turns are asked for
  Gyroscope(const InertialCalibration& calibration, const Eigen::Quaterniond& rectified_from_left);

  // Takes samples, in order of time; those that are not later than the newest are left out. The
  // last 20 seconds are kept.
  void Add(std::span<const InertialSample> samples);

  // Returns the turn between two stamps of the camera's clock. Returns nullopt where the samples
  // do not tell: missing at an end for more than 20 ms, a gap of more than 150 ms, a rate at the
  // range of the sensor or held exactly for three samples as by a range that nobody told. Cost:
  // some microseconds a sample.
  std::optional<CameraTurn> Turn(std::int64_t from_ns, std::int64_t to_ns) const;

  // Learns from a turn that the camera measured on its own, with the covariance of its left
  // perturbation.
  void Observe(const CameraTurn& turn,
               const Eigen::Quaterniond& b_from_a,
               const Eigen::Matrix3d& covariance,
               double seconds);
  // Learns from a pose that was estimated with a prediction by the turn.
  //
  //   predicted  covariance of the rotation that was predicted, more than that of the turn
  //   change     rotation vector from the predicted to the estimated rotation (left perturbation)
  //   estimated  covariance of the estimated rotation
  void ObserveChange(const CameraTurn& turn,
                     const Eigen::Matrix3d& predicted,
                     const Eigen::Vector3d& change,
                     const Eigen::Matrix3d& estimated,
                     double seconds);

  // Returns false while the camera contradicts.
  bool agrees() const { return agrees_; }
  std::int64_t observed() const { return observed_; }
  std::int64_t contradicted() const { return contradicted_; }  // turns observed while aside
  const GyroscopeErrors& errors() const { return errors_; }
  const Matrix7d& covariance() const { return covariance_; }

 private:
  std::vector<InertialSample> Between(std::int64_t from_ns, std::int64_t to_ns) const;
  void Judge(double chi2);
  // Updates the errors by a change of the predicted turn. `weight` is the inverse of the covariance
  // of the prediction, `innovation` the covariance of the change.
  void Learn(const CameraTurn& turn,
             const Eigen::Matrix3d& weight,
             const Eigen::Vector3d& change,
             const Eigen::Matrix3d& innovation,
             double seconds);
  void Grow(double seconds);

  InertialNoise noise_;
  InertialRange range_;
  Eigen::Quaterniond imu_from_camera_;  // of the calibration
  double time_offset_ = 0;              // of the calibration, 0 if it tells none
  std::vector<InertialSample> samples_;
  GyroscopeErrors errors_ = GyroscopeErrors::Zero();
  Matrix7d covariance_ = Matrix7d::Zero();
  double contradiction_ = 1;  // mean of chi2 / 3 over the last turns
  bool agrees_ = true;
  std::int64_t observed_ = 0, contradicted_ = 0;
};

}  // namespace plumbline
