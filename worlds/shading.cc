// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/shading.h"

#include "plumbline/base/parallel.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kLift = 0.002F;  // metres off a surface, not to be shadowed by itself
constexpr double kFill = 0.2;    // light from other surfaces that a moving body gets

std::vector<double> LightCells(std::span<const double> texels) {
  std::vector<double> cells;
  for (const double texel : texels) cells.push_back(std::clamp(3 * texel, 0.006, 0.1));
  return cells;
}

}  // namespace

Shading::Shading(const Scene& scene,
                 const RayTracer& tracer,
                 std::span<const double> texels,
                 int threads)
    : scene_(scene), tracer_(tracer), lights_(scene, tracer, LightCells(texels), threads) {
  for (const Surface& surface : scene_.surfaces) {
    const Vector3d normal = surface.Normal();
    const Vector3d u = surface.side_u / surface.side_u.squaredNorm();
    const Vector3d v = surface.side_v / surface.side_v.squaredNorm();
    planes_.push_back({normal.cast<float>(),
                       u.cast<float>(),
                       v.cast<float>(),
                       static_cast<float>(normal.dot(surface.origin)),
                       static_cast<float>(u.dot(surface.origin)),
                       static_cast<float>(v.dot(surface.origin)),
                       surface.body.value_or(-1),
                       surface.circuit,
                       static_cast<float>(surface.glow)});
  }
  textures_ = ParallelMap<Texture>(static_cast<int>(planes_.size()), threads, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const Surface& surface = scene_.surfaces[index];
    return Texture::Bake(
        surface.texture, surface.side_u.norm(), surface.side_v.norm(), texels[index]);
  });
}

Instant Shading::At(double time) const {
  Instant instant{tracer_.At(time), lights_.Levels(time), {1}};
  for (const Circuit& circuit : scene_.circuits) {
    instant.glows.push_back(static_cast<float>(circuit.level(time)));
  }
  return instant;
}

Shading::LocalRay Shading::ToSurface(const SurfaceHit& hit,
                                     const Plane& plane,
                                     const Instant& instant) const {
  if (plane.body < 0) return {hit.origin, hit.direction};
  const RayTracer::Moment::Pose& pose = instant.moment.bodies[static_cast<std::size_t>(plane.body)];
  return {pose.rotation * hit.origin + pose.translation, pose.rotation * hit.direction};
}

float Shading::Distance(const SurfaceHit& hit, const Instant& instant) const {
  const Plane& plane = planes_[hit.surface];
  const LocalRay ray = ToSurface(hit, plane, instant);
  return (plane.offset - plane.normal.dot(ray.origin)) / plane.normal.dot(ray.direction);
}

int Shading::LevelOf(const SurfaceHit& hit,
                     const Vector3f& right,
                     const Vector3f& down,
                     const Instant& instant) const {
  const Plane& plane = planes_[hit.surface];
  const Texture& texture = textures_[hit.surface];
  const LocalRay ray = ToSurface(hit, plane, instant);
  const float slope = plane.normal.dot(ray.direction);
  const float distance = (plane.offset - plane.normal.dot(ray.origin)) / slope;
  // Derivative of the point on the plane by the ray, in texels: the geometric mean of the two sides
  // is the square root of the determinant.
  Eigen::Matrix2f texel_from_step;
  for (int k = 0; k < 2; ++k) {
    Vector3f step = k == 0 ? right : down;
    if (plane.body >= 0) {
      step = instant.moment.bodies[static_cast<std::size_t>(plane.body)].rotation * step;
    }
    const Vector3f moved = distance * (step - (plane.normal.dot(step) / slope) * ray.direction);
    texel_from_step(0, k) = plane.u.dot(moved) * static_cast<float>(texture.width());
    texel_from_step(1, k) = plane.v.dot(moved) * static_cast<float>(texture.height());
  }
  return texture.LevelFor(std::sqrt(std::abs(texel_from_step.determinant())));
}

float Shading::StillLight(const SurfaceHit& hit,
                          const Vector3f& point,
                          const Vector2f& place,
                          const Instant& instant) const {
  float light = 0;
  for (const LightMaps::Layer& layer : lights_.LayersOf(hit.surface)) {
    const float level = instant.levels[static_cast<std::size_t>(layer.source)];
    if (level == 0) continue;
    if (const Lamp* lamp = lights_.LampOf(layer.source)) {
      const Vector3f place_on_lamp = PlaceOn(*lamp, hit.sample % kLampPoints).cast<float>();
      if (!tracer_.BodiesLetPass(point, place_on_lamp, kLift, instant.moment)) continue;
    }
    light += level * LightMaps::Sample(layer.grid, place.x(), place.y());
  }
  return light;
}

float Shading::BodyLight(const SurfaceHit& hit,
                         const Vector3f& point,
                         const Instant& instant) const {
  const Plane& plane = planes_[hit.surface];
  const Eigen::Matrix3f world_from_body =
      instant.moment.bodies[static_cast<std::size_t>(plane.body)].rotation.transpose();
  const Vector3f normal = world_from_body * plane.normal;
  double light = kFill * (1 + 0.25 * static_cast<double>(normal.z()));
  const Vector3f lifted = point + kLift * normal;
  for (const Lamp& lamp : scene_.lamps) {
    const float level = instant.glows[static_cast<std::size_t>(lamp.circuit)];
    const LampPoint from =
        LightFrom(lamp, hit.sample % kLampPoints, lifted.cast<double>(), normal.cast<double>());
    if (level == 0 || from.light <= 0) continue;
    const Vector3f place = from.position.cast<float>();
    if (tracer_.StillSees(lifted, place, kLift) &&
        tracer_.BodiesLetPass(lifted, place, kLift, instant.moment)) {
      light += static_cast<double>(level) * from.light;
    }
  }
  return static_cast<float>(light);
}

float Shading::Shade(const SurfaceHit& hit, int level, const Instant& instant) const {
  const Plane& plane = planes_[hit.surface];
  const LocalRay ray = ToSurface(hit, plane, instant);
  const float distance =
      (plane.offset - plane.normal.dot(ray.origin)) / plane.normal.dot(ray.direction);
  const Vector3f local = ray.origin + distance * ray.direction;
  const Vector2f place(plane.u.dot(local) - plane.u0, plane.v.dot(local) - plane.v0);
  const Vector3f point = hit.origin + distance * hit.direction;
  const float glow = plane.glow * instant.glows[static_cast<std::size_t>(plane.circuit)];
  const float light =
      plane.body < 0 ? StillLight(hit, point, place, instant) : BodyLight(hit, point, instant);
  return textures_[hit.surface].Sample(place.x(), place.y(), level) * (light + glow);
}

}  // namespace plumbline
