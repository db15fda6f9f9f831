// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_format.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/geometry/sim3.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Transfer (base/byte_format.h) of motions, cameras and lines.

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
template <class Archive, Like<Similarity3> T>
void Transfer(Archive& archive, T& motion) {
  TransferAll(archive, motion.scale, motion.rotation, motion.translation);
}
template <class Archive, Like<RectifiedCamera> T>
void Transfer(Archive& archive, T& c) {
  TransferAll(archive, c.fx, c.fy, c.cx, c.cy, c.baseline, c.width, c.height);
}
template <class Archive, Like<PluckerLine> T>
void Transfer(Archive& archive, T& line) {
  TransferAll(archive, line.moment, line.direction);
}
template <class Archive, Like<Segment2> T>
void Transfer(Archive& archive, T& segment) {
  TransferAll(archive, segment.start, segment.end);
}

}  // namespace plumbline
