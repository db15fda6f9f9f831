// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/image/image.h"
#include "worlds/ray_table.h"
#include "worlds/scene.h"

#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Image of an ideal sensor.
struct Rendering {
  // 255 is white at exposure 1; before response, noise and rounding. Black where the lens has no
  // ray
  Image<float> light;
  DepthImage depth;  // metres along z at the pixel centres; 0 without a hit, and beside the camera
};

// Exposure times of the rows of an image. Row y is open for `exposure` seconds around
// centre + ((y + 0.5) / height - 0.5) * readout.
struct Shutter {
  double centre = 0;    // seconds
  double exposure = 0;  // seconds; 0: an instant
  double readout = 0;   // seconds from the first row to the last; 0: all at once
};

struct RendererOptions {
  int samples = 4;        // per pixel; edges get at least 16
  int time_samples = 16;  // least number of them while a shutter is open
  // Size of the texture cells of each surface, metres; empty: 3 mm everywhere. Light is kept on a
  // grid 3 times as coarse (6 to 100 mm).
  std::vector<double> texels;
  int threads = 1;  // for baking textures and light; the result does not depend on it
};

// Ray tracer for worlds of textured rectangles under lamps, diffuse surfaces without
// interreflection.
//
// An instant: one ray finds the surface at each pixel centre. If all nine centres around agree, the
// pixel is the mean of `samples` texture samples; otherwise, at edges, at least 16 rays are traced.
// A body that covers no pixel centre at all may be missed.
// An open shutter: each pixel is the mean of rays at different positions in it and times; their
// number is the image motion in pixels, at least `time_samples` and at most 64, so that blur has no
// steps. (The motion is estimated from the camera's motion past the nearest surface.) Light on
// static surfaces is baked (LightMaps); shadows of bodies, and light on them, are traced.
//
// Render may be called from several threads; its result depends only on its arguments. Cost at 752
// x 480 on one core: 0.1 s for an instant, about 0.08 s for each time sample.
class Renderer {
 public:
  using PoseAt = std::function<Rigid3(double time)>;  // world_from_camera

  Renderer(const Scene& scene, const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The image and, at the middle of each row's exposure, the depth.
  Rendering Render(const RayTable& rays, const PoseAt& pose_at, const Shutter& shutter) const;
  // An image without exposure time.
  Rendering Render(const RayTable& rays, const Rigid3& world_from_camera) const;

  // Returns true if nothing is between two points of the world at a time, both moved `margin`
  // metres inwards.
  bool Sees(const Eigen::Vector3d& from,
            const Eigen::Vector3d& to,
            double margin,
            double time) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumbline
