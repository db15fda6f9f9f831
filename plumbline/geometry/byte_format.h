// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_format.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Transfer (base/byte_format.h) of motions and cameras.

template <class Archive, class Scalar, int kRows, int kColumns>
void Transfer(Archive& archive, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) archive(matrix.data()[i]);
}
template <class Archive, class Scalar, int kRows, int kColumns>
requires(!Archive::kReading) void Transfer(Archive& archive,
                                           const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) archive(matrix.data()[i]);
}

template <class Archive, Like<Eigen::Quaterniond> T>
void Transfer(Archive& archive, T& q) {
  Transfer(archive, q.coeffs());
}
template <class Archive, Like<Rigid3> T>
void Transfer(Archive& archive, T& motion) {
  TransferAll(archive, motion.rotation, motion.translation);
}
template <class Archive, Like<RectifiedCamera> T>
void Transfer(Archive& archive, T& c) {
  TransferAll(archive, c.fx, c.fy, c.cx, c.cy, c.baseline, c.width, c.height);
}

}  // namespace plumbline
