// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/shadow_edges.h"

#include "plumbline/base/parallel.h"
#include "worlds/collinear.h"
#include "worlds/lamp_light.h"
#include "worlds/pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLift = 0.001;      // metres off a surface, not to be shadowed by itself
constexpr double kThrownBack = 0.3;  // light from other surfaces, relative to that of the lamps

bool Sees(const RayTracer& tracer, const Vector3d& from, const Vector3d& to) {
  return tracer.StillSees(from.cast<float>(), to.cast<float>(), static_cast<float>(kLift));
}

// Light of an unoccluded lamp.
double OpenLight(const Lamp& lamp, const Vector3d& point, const Vector3d& normal) {
  double sum = 0;
  for (int i = 0; i < kLampPoints; ++i) sum += LightFrom(lamp, i, point, normal).light;
  return sum / kLampPoints;
}

// Shadow borders of one lamp.
class LampShadows {
 public:
  LampShadows(const Scene& scene,
              const Lamp& lamp,
              const RayTracer& tracer,
              const ShadowLimits& limits)
      : scene_(scene), lamp_(lamp), tracer_(tracer), limits_(limits) {
    for (const Surface& surface : scene.surfaces) {
      if (!surface.body && IsLit(surface)) receivers_.push_back(&surface);
    }
  }

  std::vector<Segment3> Of(std::span<const Segment3> edges) const {
    std::vector<Segment3> borders;
    for (const Segment3& edge : edges) {
      const auto outline = OutlineOf(edge);
      if (!outline) continue;
      for (const Surface* receiver : receivers_) {
        if (const auto shadow = Project(*outline, *receiver)) {
          AppendBorders(*outline, *shadow, *receiver, &borders);
        }
      }
    }
    return JoinCollinear(borders, 0.001);
  }

 private:
  bool IsLit(const Surface& surface) const;
  std::optional<Segment3> OutlineOf(const Segment3& edge) const;
  std::optional<Segment3> Project(const Segment3& edge, const Surface& receiver) const;
  void AppendBorders(const Segment3& edge,
                     const Segment3& shadow,
                     const Surface& receiver,
                     std::vector<Segment3>* borders) const;
  bool IsBorder(const Segment3& edge,
                const Vector3d& point,
                const Vector3d& across,
                const Surface& receiver) const;

  const Scene& scene_;
  const Lamp& lamp_;
  const RayTracer& tracer_;
  ShadowLimits limits_;
  std::vector<const Surface*> receivers_;
};

// Returns true if the lamp shines on a part of the surface, by 4 x 4 positions and the nearest one.
bool LampShadows::IsLit(const Surface& surface) const {
  constexpr int kSide = 4;
  const Vector3d normal = surface.Normal();
  if (normal.dot(lamp_.centre - surface.origin) <= kLift) return false;
  const Vector3d offset = lamp_.centre - surface.origin;
  const auto clamped = [](double share) { return std::clamp(share, 0.01, 0.99); };
  std::vector<Vector2d> places{
      {clamped(offset.dot(surface.side_u) / surface.side_u.squaredNorm()),
       clamped(offset.dot(surface.side_v) / surface.side_v.squaredNorm())}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) places.emplace_back((x + 0.5) / kSide, (y + 0.5) / kSide);
  }
  return std::any_of(places.begin(), places.end(), [&](const Vector2d& place) {
    const Vector3d point = surface.PointAt(place.x(), place.y()) + kLift * normal;
    const double light = OpenLight(lamp_, point, normal);
    return light * surface.texture.tone >= limits_.min_step && Sees(tracer_, point, lamp_.centre);
  });
}

// The part of an edge at which the lamp sees something end: free on one side, stopped on the other.
std::optional<Segment3> LampShadows::OutlineOf(const Segment3& edge) const {
  constexpr double kAside = 0.003, kBeyond = 0.004, kSpacing = 0.05;  // metres
  const Vector3d way = edge.end - edge.start;
  const int count = std::clamp(static_cast<int>(edge.Length() / kSpacing), 5, 100);
  int first = count, last = -1;
  for (int i = 0; i < count; ++i) {
    const Vector3d point = edge.start + (i + 0.5) / count * way;
    const Vector3d ray = point - lamp_.centre;
    const Vector3d aside = kAside * ray.cross(way).normalized();
    const Vector3d beyond = point + kBeyond * ray.normalized();
    if (Sees(tracer_, lamp_.centre, beyond + aside) ==
        Sees(tracer_, lamp_.centre, beyond - aside)) {
      continue;
    }
    first = std::min(first, i);
    last = i;
  }
  if (last < first) return std::nullopt;
  return Segment3{edge.start + static_cast<double>(first) / count * way,
                  edge.start + (last + 1.0) / count * way};
}

// Intersection of the light past the edge with the rectangle.
std::optional<Segment3> LampShadows::Project(const Segment3& edge, const Surface& receiver) const {
  constexpr double kBehind = 0.001;  // metres between edge and surface
  const Vector3d normal = receiver.Normal();
  const double height = normal.dot(lamp_.centre - receiver.origin);
  // Heights of the edge over the surface; it must be above it and below the lamp.
  const double low = kBehind, high = height - 0.01;
  const double a = normal.dot(edge.start - receiver.origin);
  const double b = normal.dot(edge.end - receiver.origin);
  if (std::max(a, b) <= low || std::min(a, b) >= high) return std::nullopt;
  const auto share_at = [a, b](double level) { return (level - a) / (b - a); };
  double from = 0, to = 1;
  if (a < low) from = share_at(low);
  if (a > high) from = share_at(high);
  if (b < low) to = share_at(low);
  if (b > high) to = share_at(high);
  const Vector3d u = receiver.side_u / receiver.side_u.squaredNorm();
  const Vector3d v = receiver.side_v / receiver.side_v.squaredNorm();
  Segment2 flat;
  for (const bool end : {false, true}) {
    const Vector3d point = edge.start + (end ? to : from) * (edge.end - edge.start);
    const double level = normal.dot(point - receiver.origin);
    const Vector3d offset =
        lamp_.centre + height / (height - level) * (point - lamp_.centre) - receiver.origin;
    (end ? flat.end : flat.start) = {u.dot(offset), v.dot(offset)};
  }
  const auto inside = ClipToBox(flat, {Vector2d::Zero(), Vector2d::Ones()});
  if (!inside) return std::nullopt;
  const Segment3 shadow{receiver.PointAt(inside->start.x(), inside->start.y()),
                        receiver.PointAt(inside->end.x(), inside->end.y())};
  if (shadow.Length() < limits_.min_length) return std::nullopt;
  return shadow;
}

bool LampShadows::IsBorder(const Segment3& edge,
                           const Vector3d& point,
                           const Vector3d& across,
                           const Surface& receiver) const {
  const Vector3d normal = receiver.Normal();
  // The point of the edge that casts this part of the shadow: the intersection of ray and edge.
  const Vector3d ray = point - lamp_.centre, way = edge.end - edge.start;
  const Vector3d plane = ray.cross(way).normalized();
  const Vector3d beside = way.cross(plane);  // in the plane of shadow, normal to the edge
  const double share = beside.dot(edge.start - lamp_.centre) / beside.dot(ray);
  if ((1 - share) * ray.norm() < limits_.min_throw) return false;
  const double lamp_across = std::abs(lamp_.side_u.dot(plane)) + std::abs(lamp_.side_v.dot(plane));
  const double penumbra = lamp_across * (1 - share) / share / std::abs(plane.dot(across));
  if (!(penumbra <= limits_.max_penumbra)) return false;
  constexpr double kClear = 0.002;  // metres outside the penumbra
  const Vector3d step = (0.5 * penumbra + kClear) * across;
  const Vector3d lifted = point + kLift * normal;
  const bool left = Sees(tracer_, lifted + step, lamp_.centre);
  if (left == Sees(tracer_, lifted - step, lamp_.centre)) return false;
  const Vector3d lit = lifted + (left ? 1.0 : -1.0) * step;
  const double given = OpenLight(lamp_, lit, normal);
  if (given * receiver.texture.tone < limits_.min_step) return false;
  double total = 0;
  for (const Lamp& other : scene_.lamps) {
    const double light = OpenLight(other, lit, normal);
    if (light > 1e-3 && Sees(tracer_, lit, other.centre)) total += light;
  }
  return given >= limits_.min_contrast * ((1 + kThrownBack) * total + receiver.glow);
}

void LampShadows::AppendBorders(const Segment3& edge,
                                const Segment3& shadow,
                                const Surface& receiver,
                                std::vector<Segment3>* borders) const {
  constexpr double kSpacing = 0.01, kRim = 0.004;  // metres
  const Vector3d along = shadow.Direction();
  const Vector3d across = receiver.Normal().cross(along);
  const int count = std::max(3, static_cast<int>(shadow.Length() / kSpacing));
  const Vector3d way = shadow.end - shadow.start;
  const auto near_rim = [&](const Vector3d& point) {
    const Vector3d offset = point - receiver.origin;
    const double u = offset.dot(receiver.side_u.normalized());
    const double v = offset.dot(receiver.side_v.normalized());
    return std::min({u, v, receiver.side_u.norm() - u, receiver.side_v.norm() - v}) < kRim;
  };
  int begin = -1;
  for (int i = 0; i <= count; ++i) {
    const Vector3d point = shadow.start + (i + 0.5) / count * way;
    const bool border = i < count && !near_rim(point) && IsBorder(edge, point, across, receiver);
    if (border && begin < 0) begin = i;
    if (border || begin < 0) continue;
    const Segment3 part{shadow.start + static_cast<double>(begin) / count * way,
                        shadow.start + static_cast<double>(i) / count * way};
    if (part.Length() >= limits_.min_length) borders->push_back(part);
    begin = -1;
  }
}

}  // namespace

std::vector<ShadowEdge> ShadowEdges(const Scene& scene,
                                    std::span<const Segment3> edges,
                                    const RayTracer& tracer,
                                    const ShadowLimits& limits,
                                    int threads) {
  const auto borders =
      ParallelMap<std::vector<Segment3>>(static_cast<int>(scene.lamps.size()), threads, [&](int i) {
        return LampShadows(scene, scene.lamps[static_cast<std::size_t>(i)], tracer, limits)
            .Of(edges);
      });
  std::vector<ShadowEdge> shadows;
  for (std::size_t i = 0; i < borders.size(); ++i) {
    for (const Segment3& border : borders[i]) shadows.push_back({border, scene.lamps[i].circuit});
  }
  return shadows;
}

}  // namespace plumbline
