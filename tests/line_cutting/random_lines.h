// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/line_cutting/cut_lines.h"

#include "tests/support/random_geometry.h"

namespace plumbline {

// A line 2 to 7 m in front of the test camera with covariances of a stereo measurement. The
// measured image line is off the projected one by `offset_px` at one end, so that residuals are not
// zero.
inline CuttableLine RandomLine(Rng& rng, double sigma_disparity = 1, double offset_px = 0) {
  const RectifiedCamera camera = TestCamera();
  CuttableLine line;
  const auto end = [&] {
    return Eigen::Vector3d(rng.Uniform(-2, 2), rng.Uniform(-1.5, 1.5), rng.Uniform(2, 7));
  };
  line.segment_in_cam = {end(), end()};
  line.start_covariance =
      CovarianceFromDisparity(camera, line.segment_in_cam.start, 1, sigma_disparity);
  line.end_covariance =
      CovarianceFromDisparity(camera, line.segment_in_cam.end, 1, sigma_disparity);
  Segment2 image{camera.Project(line.segment_in_cam.start),
                 camera.Project(line.segment_in_cam.end)};
  image.start.y() += offset_px;
  line.image_line = LineThrough(image);
  line.sigma_px = 1;
  return line;
}

inline CuttingProblem RandomProblem(std::uint64_t seed, int lines, double offset_px = 0) {
  Rng rng(seed, "cutting problem");
  CuttingProblem problem;
  problem.camera = TestCamera();
  for (int i = 0; i < lines; ++i) problem.lines.push_back(RandomLine(rng, 1, offset_px));
  return problem;
}

}  // namespace plumbline
