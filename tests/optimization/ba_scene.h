// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/optimization/random_scene.h"
#include <algorithm>
#include <vector>

namespace plumbline::testing {

struct BaSceneOptions {
  int poses = 15;
  int free_poses = 10;  // the last ones
  int points = 400;
  int lines = 80;
  int weak_lines = 0;  // seen in two views only, however short and however placed
  int views = 6;       // consecutive poses that see a landmark
  double sigma = 0;
  double outliers = 0;
  double perturbation = 1;  // of the start: 1 means 0.01 rad, 5 cm
};

// A bundle adjustment problem with its true answer.
struct BaScene {
  BaProblem problem;  // perturbed
  BaProblem truth;    // exact poses and landmarks, the same measurements
  std::vector<bool> point_outlier, line_outlier;  // per observation
};

// Camera i looks along z from (0.25 i, small, 0.05 i), so that all see the space ahead.
inline Rigid3 SceneCamera(Random& random, int i) {
  Vector6d twist = random.Twist(0.03, 0.05);
  Rigid3 out = ExpSe3(twist);
  out.translation -= Eigen::Vector3d(0.25 * i, 0, 0.05 * i);
  return out;
}

// A segment ahead of the camera. Unless weak, it is neither short in the image nor in one plane
// with the motion (along x), where its 3D line would not be determined.
inline Segment3 SceneSegment(Random& random, const RectifiedCamera& camera, bool weak) {
  for (;;) {
    const Segment3 segment{random.PointInView(camera), random.PointInView(camera)};
    const Eigen::Vector2d a = camera.Project(segment.start);
    const Eigen::Vector2d b = camera.Project(segment.end);
    const bool is_long = (a - b).norm() > 60;
    const bool is_upright = std::abs(a.y() - b.y()) > 0.2 * (a - b).norm();
    if (weak || (is_long && is_upright)) return segment;
  }
}

inline void AddPointObservations(Random& random,
                                 const BaSceneOptions& o,
                                 int first,
                                 BaScene& scene) {
  const RectifiedCamera& camera = scene.truth.camera;
  const int point = static_cast<int>(scene.truth.points.size()) - 1;
  for (int k = first; k < std::min(o.poses, first + o.views); ++k) {
    auto m = MeasurePoint(camera,
                          scene.truth.poses[static_cast<std::size_t>(k)].cam_from_world,
                          scene.truth.points.back(),
                          (point + k) % 3 != 0,
                          o.sigma > 0 ? o.sigma : 1);
    AddNoise(random, o.sigma, m);
    const bool outlier = random.Uniform(0, 1) < o.outliers;
    if (outlier) m.px += Eigen::Vector2d(random.Uniform(15, 60), random.Uniform(15, 60));
    scene.point_outlier.push_back(outlier);
    scene.truth.point_observations.push_back({k, point, m});
  }
}

inline void AddLineObservations(
    Random& random, const BaSceneOptions& o, int first, const Segment3& segment, BaScene& scene) {
  const RectifiedCamera& camera = scene.truth.camera;
  const int line = static_cast<int>(scene.truth.lines.size()) - 1;
  for (int k = first; k < std::min(o.poses, first + o.views); ++k) {
    for (const bool right : {false, true}) {
      if (right && (line + k) % 2 == 0) continue;
      auto m = MeasureLine(camera,
                           scene.truth.poses[static_cast<std::size_t>(k)].cam_from_world,
                           segment,
                           right,
                           o.sigma > 0 ? o.sigma : 1);
      AddNoise(random, o.sigma, m);
      const bool outlier = random.Uniform(0, 1) < o.outliers;
      if (outlier) {
        const Eigen::Vector2d along = m.segment.Direction();
        const Eigen::Vector2d across(-along.y(), along.x());
        m.segment.start += random.Uniform(15, 60) * across;
        m.segment.end += random.Uniform(15, 60) * across;
      }
      scene.line_outlier.push_back(outlier);
      scene.truth.line_observations.push_back({k, line, m});
    }
  }
}

inline void Perturb(Random& random, double size, BaProblem& problem) {
  for (auto& pose : problem.poses) {
    if (pose.fixed) continue;
    pose.cam_from_world = RetractLeft(pose.cam_from_world, size * random.Twist(0.01, 0.05));
  }
  for (auto& point : problem.points) point += random.NormalVector(0.1 * size);
  for (auto& line : problem.lines) {
    Eigen::Vector4d delta;
    delta << random.NormalVector(0.02 * size), random.Normal(0.01 * size);
    line = Retract(line, delta);
  }
}

inline BaScene MakeBaScene(unsigned seed, const BaSceneOptions& o) {
  Random random(seed);
  BaScene scene;
  BaProblem& truth = scene.truth;
  truth.camera = StereoCamera();
  for (int i = 0; i < o.poses; ++i) {
    truth.poses.push_back({SceneCamera(random, i), i < o.poses - o.free_poses});
  }
  const int starts = std::max(1, o.poses - o.views + 1);
  for (int i = 0; i < o.points; ++i) {
    const int first = random.Index(starts);
    const Eigen::Vector3d local = random.PointInView(truth.camera) + Eigen::Vector3d(0, 0, 2);
    truth.points.push_back(Inverse(truth.poses[static_cast<std::size_t>(first)].cam_from_world) *
                           local);
    AddPointObservations(random, o, first, scene);
  }
  BaSceneOptions weak = o;
  weak.views = 2;
  for (int i = 0; i < o.lines + o.weak_lines; ++i) {
    const bool is_weak = i >= o.lines;
    const int first = random.Index(starts);
    const Rigid3 world_from_cam =
        Inverse(truth.poses[static_cast<std::size_t>(first)].cam_from_world);
    Segment3 segment = SceneSegment(random, truth.camera, is_weak);
    segment.start = world_from_cam * (segment.start + Eigen::Vector3d(0, 0, 2));
    segment.end = world_from_cam * (segment.end + Eigen::Vector3d(0, 0, 2));
    truth.lines.push_back(ToOrthonormal(LineThroughPoints(segment.start, segment.end)));
    AddLineObservations(random, is_weak ? weak : o, first, segment, scene);
  }
  scene.problem = truth;
  Perturb(random, o.perturbation, scene.problem);
  return scene;
}

}  // namespace plumbline::testing
