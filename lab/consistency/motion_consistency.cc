// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/motion_consistency.h"

#include <cmath>
#include <cstdlib>
#include <optional>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

struct KnownPose {
  std::int64_t stamp_ns = 0;
  Rigid3 estimate, truth;  // world_from_camera, metres
  Matrix6d covariance;
};

std::vector<KnownPose> KnownPoses(const PromisedPoses& estimate,
                                  const Trajectory& truth,
                                  std::int64_t max_gap_ns) {
  std::vector<KnownPose> known;
  Matrix6d unit = Matrix6d::Identity();
  unit.topLeftCorner<3, 3>() *= estimate.metres_per_unit;
  for (const StampedPose& pose : estimate.poses) {
    const auto covariance = estimate.covariances.find(pose.stamp_ns);
    const auto reference = InterpolateAt(truth, pose.stamp_ns, max_gap_ns);
    if (covariance == estimate.covariances.end() || !reference) continue;
    Rigid3 scaled = pose.world_from_camera;
    scaled.translation *= estimate.metres_per_unit;
    known.push_back({pose.stamp_ns, scaled, *reference, unit * covariance->second * unit});
  }
  return known;
}

// Returns the pose nearest to `stamp_ns`, if within `slack_ns`.
std::optional<std::size_t> NearestPose(const std::vector<KnownPose>& poses,
                                       std::int64_t stamp_ns,
                                       std::int64_t slack_ns) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::int64_t off = std::abs(poses[i].stamp_ns - stamp_ns);
    if (off > slack_ns) continue;
    nearest = i;
    slack_ns = off - 1;
  }
  return nearest;
}

// With errors d of the place and w of the rotation, both along the axes of the world, the motion
// from a to b, along the same axes, is off by d_b - d_a + (c_b - c_a) x w_a and w_b - w_a.
double MotionNees(const KnownPose& a, const KnownPose& b) {
  const Rigid3 estimated = Inverse(a.estimate) * b.estimate;
  const Rigid3 truly = Inverse(a.truth) * b.truth;
  Vector6d e;
  e << a.estimate.rotation * (truly.translation - estimated.translation),
      a.estimate.rotation * LogSo3(truly.rotation * estimated.rotation.conjugate());
  Matrix6d J_a = -Matrix6d::Identity();
  J_a.topRightCorner<3, 3>() = Skew(b.estimate.translation - a.estimate.translation);
  const Matrix6d S = J_a * a.covariance * J_a.transpose() + b.covariance;
  return e.dot(S.ldlt().solve(e));
}

}  // namespace

std::vector<ConsistencySample> MotionSamples(ConsistencyKind kind,
                                             const PromisedPoses& estimate,
                                             const Trajectory& truth,
                                             std::int64_t max_gap_ns,
                                             std::int64_t duration_ns) {
  const std::vector<KnownPose> poses = KnownPoses(estimate, truth, max_gap_ns);
  std::vector<ConsistencySample> samples;
  for (const KnownPose& from : poses) {
    const auto to = NearestPose(poses, from.stamp_ns + duration_ns, duration_ns / 20);
    if (!to) continue;
    ConsistencySample sample;
    sample.kind = kind;
    sample.nees = MotionNees(from, poses[*to]);
    sample.dimensions = 6;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace plumbline
