// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"
#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/image.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// True depth of one frame. Points are in the frame of the rectified camera, metres.
class TrueDepth {
 public:
  virtual ~TrueDepth() = default;
  // Returns the point at a pixel of the rectified image; nullopt if it is not reliable: without
  // measurement, at the edge of a body.
  virtual std::optional<Eigen::Vector3d> PointAt(const Eigen::Vector2d& px) const = 0;
  // Points spread over the image, for measuring parallax.
  virtual std::vector<Eigen::Vector3d> Samples() const = 0;
};

// Depth from a depth image registered to the camera as delivered.
class TrueDepthOfImage : public TrueDepth {
 public:
  //   depth                metres along z of `raw`
  //   rectified_from_raw  rotates directions of the camera as delivered into the rectified one
  TrueDepthOfImage(DepthImage depth,
                   const Camera& raw,
                   const RectifiedCamera& rectified,
                   const Eigen::Quaterniond& rectified_from_raw);

  // Known if the 3x3 pixels around the position are measured and differ by at most 5 %.
  std::optional<Eigen::Vector3d> PointAt(const Eigen::Vector2d& px) const override;
  // Of a grid, every 24 pixels.
  std::vector<Eigen::Vector3d> Samples() const override;

 private:
  DepthImage depth_;
  Camera raw_;
  RectifiedCamera rectified_;
  Eigen::Quaterniond rectified_from_raw_;
};

// Depth from single points, for example of a stereo pair.
class TrueDepthOfPoints : public TrueDepth {
 public:
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // frame of the rectified camera
    bool accurate = true;  // enough to compare depths; otherwise for parallax only
  };
  TrueDepthOfPoints(std::vector<Point> points, const RectifiedCamera& camera);

  // Returns the accurate point projected nearest to the pixel, at most 1.5 px away.
  std::optional<Eigen::Vector3d> PointAt(const Eigen::Vector2d& px) const override;
  std::vector<Eigen::Vector3d> Samples() const override;

 private:
  std::vector<Point> points_;
  std::vector<Eigen::Vector2d> pixels_;
};

// The points of a measured stereo frame: those with a deviation of the disparity of at most 5 % are
// accurate.
//
//   features, stereo     with disparities, and the rectified camera of the pair
//   camera_from_stereo  rotates directions of that camera into those of `camera` (same centre)
//   camera               the rectified camera of the left images alone
TrueDepthOfPoints TrueDepthOfStereo(const Features& features,
                                    const RectifiedCamera& stereo,
                                    const Eigen::Quaterniond& camera_from_stereo,
                                    const RectifiedCamera& camera);

}  // namespace plumbline
