// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/optimization/random_scene.h"
#include <vector>

namespace plumbline::testing {

// A pose problem with its true answer.
struct PoseScene {
  PoseProblem problem;
  Rigid3 truth;
  std::vector<bool> point_outlier;
  std::vector<bool> line_outlier;
};

struct PoseSceneOptions {
  int points = 200;
  int lines = 50;  // each seen in the left and the right camera
  double sigma = 0;
  double outliers = 0;
  bool disparity = true;
  double rotation_error = 0.02;
  double translation_error = 0.1;
};

inline PoseScene MakePoseScene(unsigned seed, const PoseSceneOptions& o) {
  Random random(seed);
  PoseScene scene;
  PoseProblem& problem = scene.problem;
  problem.camera = StereoCamera();
  scene.truth = ExpSe3(random.Twist(0.5, 2));
  const Rigid3 world_from_cam = Inverse(scene.truth);
  const double unit = o.sigma > 0 ? o.sigma : 1;
  for (int i = 0; i < o.points; ++i) {
    const Eigen::Vector3d point = world_from_cam * random.PointInView(problem.camera);
    auto m = MeasurePoint(problem.camera, scene.truth, point, o.disparity && i % 3 != 0, unit);
    AddNoise(random, o.sigma, m);
    const bool outlier = random.Uniform(0, 1) < o.outliers;
    if (outlier) m.px = {random.Uniform(0, 752), random.Uniform(0, 480)};
    scene.point_outlier.push_back(outlier);
    problem.points.push_back({point, m});
  }
  for (int i = 0; i < o.lines; ++i) {
    const Segment3 segment{world_from_cam * random.PointInView(problem.camera),
                           world_from_cam * random.PointInView(problem.camera)};
    const bool outlier = random.Uniform(0, 1) < o.outliers;
    const Eigen::Vector2d shift(random.Uniform(30, 200), random.Uniform(30, 200));
    for (const bool right : {false, true}) {
      auto m = MeasureLine(problem.camera, scene.truth, segment, right, unit);
      AddNoise(random, o.sigma, m);
      if (outlier) {
        m.segment.start += shift;
        m.segment.end -= shift;
      }
      scene.line_outlier.push_back(outlier);
      problem.lines.push_back({LineThroughPoints(segment.start, segment.end), m, 100 - i});
    }
  }
  problem.cam_from_world =
      RetractLeft(scene.truth, random.Twist(o.rotation_error, o.translation_error));
  return scene;
}

}  // namespace plumbline::testing
