// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/true_line.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Whether nothing of the world lies between two points when a frame is taken. Called from several
// threads.
using SightTest =
    std::function<bool(const Eigen::Vector3d& from, const Eigen::Vector3d& to, std::size_t frame)>;

// Where the camera is in a frame.
struct TimedView {
  double time = 0;  // seconds
  Rigid3 world_from_camera;
};

struct VisibilityLimits {
  double min_visible_px = 40;  // longest piece without interruption, pixels of the image
};

// Tells in which frames a line is seen.
//
// A line is seen in a frame when a piece of it, at least min_visible_px long in the image (lens
// distortion included), lies inside the image and is hidden by nothing: rays go to samples at most
// 8 px apart, to points 1 mm before the line, so that the surface it lies on does not hide it; the
// ends of pieces are then found by bisection. What is narrower than 8 px may hide nothing. Blur,
// noise and contrast do not count.
//
// Cost: some 30 ns for a line out of view, about 6 rays for one in view, and all samples of the
// stretches that have never been seen: 12 000 lines in 2000 frames take 4 s on one core.
class LineVisibility {
 public:
  // Keeps references to what it is given.
  LineVisibility(const Camera& camera,
                 std::span<const TimedView> views,
                 const SightTest& sees,
                 const VisibilityLimits& limits = {});
  ~LineVisibility();
  LineVisibility(const LineVisibility&) = delete;
  LineVisibility& operator=(const LineVisibility&) = delete;

  // The line cut down to the shortest stretch that holds all pieces seen in some frame (to 5 mm),
  // with the frames that see it; nullopt when none does. `present`, where not empty, tells for each
  // frame whether the line is there at all.
  std::optional<TrueLine> Trim(const TrueLine& line, const std::vector<bool>& present = {}) const;

 private:
  class Sweep;
  struct Window;

  std::optional<Window> FindWindow(const Segment3& line, std::size_t frame) const;

  const Camera& camera_;
  std::span<const TimedView> views_;
  const SightTest& sees_;
  VisibilityLimits limits_;
  std::vector<Rigid3> camera_from_world_;
  std::vector<Eigen::Matrix3d> rotations_;
  // Bounds of x / z and y / z of all rays of the image.
  Eigen::Vector2d low_, high_;
};

}  // namespace plumbline
