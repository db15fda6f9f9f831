// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Cuts 3D lines to the piece that tells most about the pose of the camera.
#include <iostream>

#include <plumbline/line_cutting/cut_lines.h>

int main() {
  using namespace plumbline;
  CuttingProblem problem;
  problem.camera = {.fx = 400, .fy = 400, .cx = 320, .cy = 240, .width = 640, .height = 480};
  for (int i = 0; i < 6; ++i) {
    CuttableLine line;  // one end is known to 1 cm, the other one, further away, to 20 cm
    line.segment_in_cam = {{0.4 * i - 1, i % 2 - 0.5, 3}, {0.3 * i - 1, 0.5 - i % 3, 6}};
    line.start_covariance = 1e-4 * Eigen::Matrix3d::Identity();
    line.end_covariance = 4e-2 * Eigen::Matrix3d::Identity();
    line.image_line = LineThrough({problem.camera.Project(line.segment_in_cam.start),
                                   problem.camera.Project(line.segment_in_cam.end)});
    problem.lines.push_back(line);
  }
  for (const LineCut& cut : CutLines(problem)) {
    std::cout << "from " << 100 * cut.first << " % to " << 100 * cut.second << " % of its length\n";
  }
}
