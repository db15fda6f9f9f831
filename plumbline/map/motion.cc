// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/motion.h"

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

using Matrix64 = Eigen::Matrix<double, 6, 4>;

// Returns d(moment, direction) / d(tangent) with |direction| = 1, by dividing the homogeneous
// vector of the orthonormal form by the length of its direction.
Matrix64 PluckerJacobian(const OrthonormalLine& line) {
  const Eigen::Matrix<double, 6, 1> h = line.Homogeneous();
  const Matrix64 dh = HomogeneousJacobian(line);
  const double length = h.tail<3>().norm();
  const Eigen::RowVector4d dlength = h.tail<3>().transpose() * dh.bottomRows<3>() / length;
  return dh / length - h * dlength / (length * length);
}

// Returns d(tangent of the moved line) / d(tangent of the line).
Eigen::Matrix4d TangentJacobian(const Similarity3& s,
                                const OrthonormalLine& from,
                                const OrthonormalLine& to) {
  const Matrix64 before = PluckerJacobian(from);
  const Matrix64 after = PluckerJacobian(to);
  const Eigen::Matrix3d rotation = s.rotation.toRotationMatrix();
  const Eigen::Matrix3d shift = Skew(s.translation) * rotation;
  Matrix64 moved;
  moved.topRows<3>() = s.scale * (rotation * before.topRows<3>()) + shift * before.bottomRows<3>();
  moved.bottomRows<3>() = rotation * before.bottomRows<3>();
  const Eigen::Matrix4d normal = after.transpose() * after;
  return normal.ldlt().solve(after.transpose() * moved);
}

}  // namespace

PluckerLine Transform(const Similarity3& s, const PluckerLine& line) {
  PluckerLine moved;
  moved.direction = s.rotation * line.direction;
  moved.moment = s.scale * (s.rotation * line.moment) + s.translation.cross(moved.direction);
  return moved;
}

void Move(const Similarity3& new_from_old, KeyFrame& keyframe) {
  keyframe.frame.cam_from_world =
      Inverse(TransformPose(new_from_old, Inverse(keyframe.frame.cam_from_world)));
  keyframe.scale *= new_from_old.scale;
}

void Move(const Similarity3& new_from_old, PointModel& point) {
  point.position = new_from_old * point.position;
  point.view_direction = new_from_old.rotation * point.view_direction;
  point.reference_distance *= new_from_old.scale;
}

void Move(const Similarity3& new_from_old, LineModel& line) {
  const PluckerLine moved = Transform(new_from_old, line.line);
  const double start = moved.ParameterOf(new_from_old * line.line.PointAt(line.start));
  const double end = moved.ParameterOf(new_from_old * line.line.PointAt(line.end));
  const Eigen::Matrix4d old_from_new =
      TangentJacobian(new_from_old, ToOrthonormal(line.line), ToOrthonormal(moved)).inverse();
  line.information = old_from_new.transpose() * line.information * old_from_new;
  line.line = moved;
  line.start = start;
  line.end = end;
  line.view_direction = new_from_old.rotation * line.view_direction;
}

}  // namespace plumbline
