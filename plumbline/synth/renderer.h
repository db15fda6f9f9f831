// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/image/image.h"
#include "plumbline/synth/scene.h"

#include <memory>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The ray of every pixel of a camera on the plane z = 1, and how it changes across the pixel: the
// lens model is then evaluated once for a sequence instead of once for a sample.
class RayTable {
 public:
  // Throws InputError when some pixel of the camera has no ray (distortion not invertible there).
  explicit RayTable(const Camera& camera);

  struct Entry {
    Eigen::Vector2f ray;    // x / z, y / z at the centre of the pixel
    Eigen::Matrix2f slope;  // d(ray) / d(pixel)

    Eigen::Vector2f At(float dx, float dy) const { return ray + slope * Eigen::Vector2f(dx, dy); }
  };

  int width() const { return width_; }
  int height() const { return height_; }
  const Entry& at(int x, int y) const {
    return entries_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<Entry> entries_;
};

// What an ideal sensor would see.
struct Rendering {
  Image<float> light;  // 0-255, before exposure, noise and rounding
  DepthImage depth;    // metres along z at the pixel centres; 0 where nothing is hit
};

struct RendererOptions {
  double texel = 0.003;  // size of a texture cell, metres
  int threads = 1;       // for baking the textures; the result does not depend on it
};

// Ray tracer for still scenes of textured rectangles.
//
// One ray (Embree) finds the surface at each pixel centre. Where all nine centres around agree, the
// pixel is shaded with 2 x 2 texture samples; elsewhere, that is at edges, 4 x 4 rays are traced.
// A body that covers no pixel centre at all may be missed. Texture coordinates come from the plane
// of the surface, so that they are as exact as the geometry. Render may be called from several
// threads; what it returns depends on nothing but its arguments.
class Renderer {
 public:
  Renderer(const Scene& scene, const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  Rendering Render(const RayTable& rays, const Rigid3& world_from_camera) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumbline
