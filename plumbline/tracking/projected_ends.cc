// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/projected_ends.h"

namespace plumbline {
namespace {

// Distance of a point from the measured line before whitening, and its derivative by the point.
struct EndDistance {
  double distance = 0;
  Eigen::Vector3d gradient;
};

bool MeasureEnd(const ProjectedEndsTerm& term, const Eigen::Vector3d& in_left, EndDistance& out) {
  const double z = in_left.z();
  if (!(z > kMinDepth) || term.line.isZero(0)) return false;
  const double iz = 1 / z;
  out.distance = (term.line.dot(in_left) + term.line.x() * term.shift) * iz;
  out.gradient = term.line * iz;
  out.gradient.z() -= out.distance * iz;
  return true;
}

}  // namespace

ProjectedEndsTerm MakeProjectedEndsTerm(const RectifiedCamera& camera,
                                        const LineMeasurement& measurement) {
  const LineTerm whitening = MakeLineTerm(camera, measurement);
  ProjectedEndsTerm term{.line = Eigen::Vector3d::Zero(),
                         .w00 = whitening.w00,
                         .w10 = whitening.w10,
                         .w11 = whitening.w11,
                         .shift = whitening.shift};
  if (measurement.segment.start == measurement.segment.end) return term;
  const Eigen::Vector3d l = LineThrough(measurement.segment);
  term.line = {camera.fx * l.x(),
               camera.fy * l.y(),
               camera.cx * l.x() + camera.cy * l.y() + l.z()};  // K^T l
  return term;
}

bool LinearizeProjectedEnds(const ProjectedEndsTerm& term,
                            const Segment3& ends,
                            ProjectedEndsLinearization& out) {
  EndDistance start;
  EndDistance end;
  if (!MeasureEnd(term, ends.start, start) || !MeasureEnd(term, ends.end, end)) return false;
  out.r = {term.w00 * start.distance, term.w10 * start.distance + term.w11 * end.distance};
  out.h0 = term.w00 * start.gradient;
  out.h1_start = term.w10 * start.gradient;
  out.h1_end = term.w11 * end.gradient;
  return true;
}

bool WhitenedEndDistances(const ProjectedEndsTerm& term, const Segment3& ends, Eigen::Vector2d& r) {
  if (!(ends.start.z() > kMinDepth && ends.end.z() > kMinDepth) || term.line.isZero(0)) {
    return false;
  }
  const double shift = term.line.x() * term.shift;
  const double r0 = (term.line.dot(ends.start) + shift) / ends.start.z();
  const double r1 = (term.line.dot(ends.end) + shift) / ends.end.z();
  r = {term.w00 * r0, term.w10 * r0 + term.w11 * r1};
  return true;
}

ProjectedEndsPoseRows PoseRows(const ProjectedEndsLinearization& lin, const Segment3& ends) {
  ProjectedEndsPoseRows rows;
  rows.a << ends.start.cross(lin.h0), lin.h0;
  rows.b << ends.start.cross(lin.h1_start) + ends.end.cross(lin.h1_end), lin.h1_start + lin.h1_end;
  return rows;
}

Matrix6d EndsJacobian(const Vector6d& homogeneous, const LineInterval& interval) {
  // X = d x m / |d|^2 + t d / |d|.
  const Eigen::Vector3d m = homogeneous.head<3>();
  const Eigen::Vector3d d = homogeneous.tail<3>();
  const double inverse = 1 / d.norm();
  const double inverse2 = inverse * inverse;
  const Eigen::Vector3d u = d * inverse;
  const Eigen::Matrix3d by_moment = Skew(d) * inverse2;
  const Eigen::Matrix3d foot_by_direction =
      -Skew(m) * inverse2 - 2 * inverse * (inverse2 * d.cross(m)) * u.transpose();
  const Eigen::Matrix3d unit_by_direction =
      inverse * (Eigen::Matrix3d::Identity() - u * u.transpose());
  Matrix6d J;
  J << by_moment, foot_by_direction + interval.start * unit_by_direction, by_moment,
      foot_by_direction + interval.end * unit_by_direction;
  return J;
}

std::optional<LineResidual> EvaluateProjectedEnds(const RectifiedCamera& camera,
                                                  const Rigid3& cam_from_world,
                                                  const OrthonormalLine& line_in_world,
                                                  const LineInterval& interval,
                                                  const LineMeasurement& measurement) {
  const Segment3 ends = SegmentOf(ToPlucker(line_in_world), interval);
  const Segment3 in_cam{cam_from_world * ends.start, cam_from_world * ends.end};
  ProjectedEndsLinearization lin;
  if (!LinearizeProjectedEnds(MakeProjectedEndsTerm(camera, measurement), in_cam, lin)) {
    return std::nullopt;
  }
  const Eigen::Matrix3d R = cam_from_world.rotation.toRotationMatrix();
  const ProjectedEndsPoseRows rows = PoseRows(lin, in_cam);
  LineResidual out;
  out.r = lin.r;
  out.J_pose << rows.a.transpose(), rows.b.transpose();
  Eigen::Matrix<double, 2, 6> J_ends;
  J_ends << lin.h0.transpose() * R, Eigen::RowVector3d::Zero(), lin.h1_start.transpose() * R,
      lin.h1_end.transpose() * R;
  out.J_line = J_ends * EndsJacobian(line_in_world.Homogeneous(), interval) *
               HomogeneousJacobian(line_in_world);
  return out;
}

Eigen::Matrix2d ProjectedEndsCovariance(const RectifiedCamera& camera,
                                        const Rigid3& cam_from_world,
                                        const Segment3& ends,
                                        const LineMeasurement& measurement) {
  constexpr double kFloor = 1e-4;  // of the mean variance: keeps coincident ends regular
  const Eigen::Vector3d shift(camera.ShiftInto(measurement.camera), 0, 0);
  const Segment2& segment = measurement.segment;
  const double length = segment.Length();
  Eigen::Matrix2d A;
  for (const bool is_end : {false, true}) {
    const Eigen::Vector3d p = cam_from_world * (is_end ? ends.end : ends.start) + shift;
    if (!(p.z() > kMinDepth) || !(length > 0)) return measurement.covariance;
    const double s = (camera.Project(p) - segment.start).dot(segment.Direction()) / length;
    A.row(is_end ? 1 : 0) << 1 - s, s;
  }
  const Eigen::Matrix2d covariance = A * measurement.covariance * A.transpose();
  return covariance + kFloor * 0.5 * covariance.trace() * Eigen::Matrix2d::Identity();
}

}  // namespace plumbline
