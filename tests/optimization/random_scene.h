// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/optimization/problem.h"

#include <random>
#include <vector>

#include <Eigen/Core>

namespace plumbline::testing {

// Random numbers of the tests: seeded, one stream per scene.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  double Normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(engine_); }
  int Index(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  Eigen::Vector3d NormalVector(double sigma) {
    const double x = Normal(sigma);
    const double y = Normal(sigma);
    return {x, y, Normal(sigma)};
  }
  Vector6d Twist(double rotation, double translation) {
    Vector6d twist;
    twist << NormalVector(rotation), NormalVector(translation);
    return twist;
  }
  // In front of a camera at the origin that looks along z, 3 to 12 m away.
  Eigen::Vector3d PointInView(const RectifiedCamera& camera) {
    const double u = Uniform(0, camera.width);
    const double v = Uniform(0, camera.height);
    return camera.Unproject({u, v}) * Uniform(3, 12);
  }

 private:
  std::mt19937_64 engine_;
};

inline RectifiedCamera StereoCamera() {
  return {
      .fx = 460, .fy = 455, .cx = 372, .cy = 241, .baseline = 0.11, .width = 752, .height = 480};
}

// The exact image of a 3D segment in the left or right camera.
inline LineMeasurement MeasureLine(const RectifiedCamera& camera,
                                   const Rigid3& cam_from_world,
                                   const Segment3& segment,
                                   bool right,
                                   double sigma) {
  const Eigen::Vector3d shift(right ? -camera.baseline : 0, 0, 0);
  LineMeasurement out;
  out.segment = {camera.Project(cam_from_world * segment.start + shift),
                 camera.Project(cam_from_world * segment.end + shift)};
  out.covariance = Eigen::Vector2d::Constant(sigma * sigma).asDiagonal();
  out.camera = right ? 1 : 0;
  return out;
}

inline PointMeasurement MeasurePoint(const RectifiedCamera& camera,
                                     const Rigid3& cam_from_world,
                                     const Eigen::Vector3d& point,
                                     bool disparity,
                                     double sigma) {
  const Eigen::Vector3d p = cam_from_world * point;
  PointMeasurement out{.px = camera.Project(p), .sigma_px = sigma, .disparity = std::nullopt};
  if (disparity) out.disparity = Disparity{camera.DisparityFromDepth(p.z()), sigma};
  return out;
}

inline void AddNoise(Random& random, double sigma, PointMeasurement& m) {
  m.px.x() += random.Normal(sigma);
  m.px.y() += random.Normal(sigma);
  if (m.disparity) m.disparity->px += random.Normal(sigma);
}

inline void AddNoise(Random& random, double sigma, LineMeasurement& m) {
  for (Eigen::Vector2d* px : {&m.segment.start, &m.segment.end}) {
    px->x() += random.Normal(sigma);
    px->y() += random.Normal(sigma);
  }
}

// A segment somewhere in view of a camera somewhere, and its image with noise. The covariance of
// the image is one that mixes the two residuals.
struct MeasuredSegment {
  Rigid3 cam_from_world;
  Segment3 segment;
  LineMeasurement m;
};

inline MeasuredSegment RandomMeasuredSegment(Random& random, bool right) {
  const RectifiedCamera camera = StereoCamera();
  MeasuredSegment out{ExpSe3(random.Twist(0.7, 2)), {}, {}};
  const Rigid3 world_from_cam = Inverse(out.cam_from_world);
  out.segment = {world_from_cam * random.PointInView(camera),
                 world_from_cam * random.PointInView(camera)};
  out.m = MeasureLine(camera, out.cam_from_world, out.segment, right, 1);
  AddNoise(random, 4, out.m);
  out.m.covariance << 2, 0.6, 0.6, 1;
  return out;
}

}  // namespace plumbline::testing
