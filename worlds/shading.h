// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/lamp_light.h"
#include "worlds/light_map.h"
#include "worlds/ray_tracer.h"
#include "worlds/scene.h"
#include "worlds/texture.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// State of the world at an instant: poses of bodies, brightness of lamps.
struct Instant {
  RayTracer::Moment moment;
  std::vector<float> levels;  // of the sources of light, see LightMaps
  std::vector<float> glows;   // of the circuits
};

// Intersection of a ray with a surface.
struct SurfaceHit {
  unsigned surface = RayTracer::kNothing;
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();      // of the ray, world
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // world, any length
  int sample = 0;  // number of the sample, selects the points on lamps
};

// Brightness of hit surfaces: textures times light.
class Shading {
 public:
  // `texels` are the cells of the textures, metres, one for each surface.
  Shading(const Scene& scene, const RayTracer& tracer, std::span<const double> texels, int threads);

  Instant At(double time) const;

  // Distance along the ray in units of its direction.
  float Distance(const SurfaceHit& hit, const Instant& instant) const;

  // Texture level for samples that are apart by these changes of the direction, right and down
  // (world).
  int LevelOf(const SurfaceHit& hit,
              const Eigen::Vector3f& right,
              const Eigen::Vector3f& down,
              const Instant& instant) const;

  // 255 for white.
  float Shade(const SurfaceHit& hit, int level, const Instant& instant) const;

 private:
  // A precomputed surface: a = u.dot(p) - u0, b = v.dot(p) - v0 on it.
  struct Plane {
    Eigen::Vector3f normal, u, v;
    float offset = 0, u0 = 0, v0 = 0;
    int body = -1;
    int circuit = 0;
    float glow = 0;
  };
  struct LocalRay {
    Eigen::Vector3f origin, direction;
  };

  LocalRay ToSurface(const SurfaceHit& hit, const Plane& plane, const Instant& instant) const;
  float StillLight(const SurfaceHit& hit,
                   const Eigen::Vector3f& point,
                   const Eigen::Vector2f& place,
                   const Instant& instant) const;
  float BodyLight(const SurfaceHit& hit,
                  const Eigen::Vector3f& point,
                  const Instant& instant) const;

  Scene scene_;
  const RayTracer& tracer_;
  LightMaps lights_;
  std::vector<Plane> planes_;
  std::vector<Texture> textures_;
};

}  // namespace plumbline
