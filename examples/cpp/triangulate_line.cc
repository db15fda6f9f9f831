// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes a 3D line of its segments in two images, in Plücker coordinates.
#include <iostream>

#include <plumbline/geometry/triangulation.h>

int main() {
  using namespace plumbline;
  const RectifiedCamera camera{
      .fx = 400, .fy = 400, .cx = 320, .cy = 240, .width = 640, .height = 480};
  const Segment3 truth{{-1, -0.5, 4}, {0.8, 0.9, 5}};  // metres, world = first camera
  std::vector<LineView> views;
  for (const double x : {0.0, 0.3}) {  // the second camera stands 30 cm to the right
    const Rigid3 cam_from_world{Eigen::Quaterniond::Identity(), {-x, 0, 0}};
    const Segment2 segment{camera.Project(cam_from_world * truth.start),
                           camera.Project(cam_from_world * truth.end)};
    views.push_back({cam_from_world, segment, 0.5});  // ends are known to half a pixel across
  }
  const auto line = TriangulateLine(camera, views);
  if (!line) return 1;  // line.error() says why
  const PluckerLine& found = line->line;
  std::cout << "direction " << found.direction.transpose() << ", moment "
            << found.moment.transpose() << "\nstandard deviations of the four parameters "
            << line->covariance.diagonal().cwiseSqrt().transpose() << "\nerror "
            << found.DistanceTo(truth.start) + found.DistanceTo(truth.end) << " m\n";
}
