// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Bundle adjustment: two cameras, points and a line, from wrong starts to right places.
#include <iostream>

#include <plumbline/optimization/bundle_adjustment.h>

int main() {
  using namespace plumbline;
  BaProblem problem;
  const RectifiedCamera& camera = problem.camera = {400, 400, 320, 240, 0.1, 640, 480};
  const Segment3 edge{{-1, -0.5, 4}, {1, 0.8, 5}};
  for (int k = 0; k < 2; ++k) {
    const Rigid3 pose{Eigen::Quaterniond::Identity(), {-0.3 * k, 0, 0}};  // cam_from_world
    problem.poses.push_back({pose, k == 0});  // the first one stays; both start where they are
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector3d point(i % 3 - 1, i / 3 - 1, 4 + i % 2);
      if (k == 0) problem.points.push_back(1.1 * point);  // 10 % too far away
      const Disparity disparity{camera.DisparityFromDepth(point.z()), 0.5};
      problem.point_observations.push_back({k, i, {camera.Project(pose * point), 0.5, disparity}});
    }
    const Segment2 seen{camera.Project(pose * edge.start), camera.Project(pose * edge.end)};
    problem.line_observations.push_back({k, 0, {seen}});
  }
  problem.lines.push_back(ToOrthonormal(LineThroughPoints(edge.start, 1.02 * edge.end)));
  const BaResult result = SolveLocalBa(problem);
  std::cout << "cost " << result.initial_cost << " -> " << result.final_cost << "; line off by "
            << ToPlucker(result.lines[0]).DistanceTo(edge.end) << " m\n";
}
