// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/light_map.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/parallel.h"
#include "worlds/direct_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Directions of a cosine-weighted half sphere around z (Hammersley points).
std::vector<Vector3f> HalfSphere(unsigned count) {
  std::vector<Vector3f> directions;
  for (unsigned i = 0; i < count; ++i) {
    double radical = 0, digit = 0.5;
    for (unsigned bits = i; bits != 0; bits >>= 1, digit *= 0.5) radical += (bits & 1U) * digit;
    const double r2 = (i + 0.5) / count, angle = 2 * std::numbers::pi * radical;
    const double r = std::sqrt(r2);
    directions.push_back(
        Vector3d(r * math::Cos(angle), r * math::Sin(angle), std::sqrt(1 - r2)).cast<float>());
  }
  return directions;
}

// Intersection of a ray with the plane of a surface, as shares of its sides.
Eigen::Vector2f MeetingPoint(const Surface& surface, const Vector3f& from, const Vector3f& along) {
  const Vector3d origin = from.cast<double>(), direction = along.cast<double>();
  const Vector3d normal = surface.side_u.cross(surface.side_v);
  const double distance = normal.dot(surface.origin - origin) / normal.dot(direction);
  const Vector3d offset = origin + distance * direction - surface.origin;
  return Eigen::Vector2d(offset.dot(surface.side_u) / surface.side_u.squaredNorm(),
                         offset.dot(surface.side_v) / surface.side_v.squaredNorm())
      .cast<float>();
}

std::vector<LightMaps::Layer> WithoutDark(std::vector<Image<float>> grids) {
  std::vector<LightMaps::Layer> layers;
  for (std::size_t source = 0; source < grids.size(); ++source) {
    const Image<float>& grid = grids[source];
    const auto count =
        static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height());
    const bool dark =
        std::all_of(grid.data(), grid.data() + count, [](float value) { return value < 1e-4F; });
    if (!dark) layers.push_back({static_cast<int>(source), std::move(grids[source])});
  }
  return layers;
}

// Adds layers of a coarse grid to those of a fine one.
void AddLayers(const std::vector<LightMaps::Layer>& coarse,
               const SurfaceGrid& grid,
               std::vector<LightMaps::Layer>& fine) {
  for (const LightMaps::Layer& from : coarse) {
    auto to = std::find_if(fine.begin(), fine.end(), [&](const LightMaps::Layer& layer) {
      return layer.source == from.source;
    });
    if (to == fine.end()) {
      to = fine.insert(fine.end(), {from.source, Image<float>(grid.columns(), grid.rows())});
    }
    for (int y = 0; y < grid.rows(); ++y) {
      for (int x = 0; x < grid.columns(); ++x) {
        to->grid.at(x, y) +=
            LightMaps::Sample(from.grid,
                              static_cast<float>(x) / static_cast<float>(grid.columns() - 1),
                              static_cast<float>(y) / static_cast<float>(grid.rows() - 1));
      }
    }
  }
}

}  // namespace

LightMaps::LightMaps(const Scene& scene,
                     const RayTracer& tracer,
                     std::span<const double> cells,
                     int threads)
    : scene_(scene), lamps_apart_(!scene.bodies.empty()) {
  constexpr int kRounds = 2;
  constexpr double kCoarser = 25, kFinest = 0.1, kCoarsest = 0.4;
  const auto count = static_cast<int>(scene_.surfaces.size());
  using Layers = std::vector<Layer>;
  const std::vector<Layers> direct = ParallelMap<Layers>(count, threads, [&](int i) {
    return BakeDirect(static_cast<unsigned>(i), tracer, cells[static_cast<std::size_t>(i)]);
  });
  layers_ = direct;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Layers> gathered = ParallelMap<Layers>(count, threads, [&](int i) {
      const double cell =
          std::clamp(kCoarser * cells[static_cast<std::size_t>(i)], kFinest, kCoarsest);
      return Gather(static_cast<unsigned>(i), tracer, cell, layers_);
    });
    layers_ = direct;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      AddLayers(gathered[i], SurfaceGrid(scene_.surfaces[i], cells[i]), layers_[i]);
    }
  }
}

int LightMaps::SourceOf(std::size_t lamp) const {
  return lamps_apart_ ? static_cast<int>(lamp) + 1 : scene_.lamps[lamp].circuit;
}

int LightMaps::source_count() const {
  return 1 + static_cast<int>(lamps_apart_ ? scene_.lamps.size() : scene_.circuits.size());
}

const Lamp* LightMaps::LampOf(int source) const {
  return lamps_apart_ && source > 0 ? &scene_.lamps[static_cast<std::size_t>(source) - 1] : nullptr;
}

std::vector<float> LightMaps::Levels(double time) const {
  std::vector<float> levels;
  for (int source = 0; source < source_count(); ++source) {
    const Lamp* lamp = LampOf(source);
    const int circuit = lamps_apart_ ? (lamp != nullptr ? lamp->circuit : 0) : source;
    levels.push_back(static_cast<float>(scene_.Level(circuit, time)));
  }
  return levels;
}

std::vector<LightMaps::Layer> LightMaps::BakeDirect(unsigned index,
                                                    const RayTracer& tracer,
                                                    double cell) const {
  const Surface& surface = scene_.surfaces[index];
  if (surface.body) return {};
  const SurfaceGrid grid(surface, cell);
  std::vector<int> sources;
  for (std::size_t k = 0; k < scene_.lamps.size(); ++k) sources.push_back(SourceOf(k));
  return WithoutDark(DirectLight(grid, scene_.lamps, sources, source_count(), tracer));
}

// Light on each point from the surfaces around it, lit by `light`, and from the sky.
std::vector<LightMaps::Layer> LightMaps::Gather(
    unsigned index,
    const RayTracer& tracer,
    double cell,
    const std::vector<std::vector<Layer>>& light) const {
  const Surface& surface = scene_.surfaces[index];
  if (surface.body) return {};
  constexpr double kSmall = 0.15;  // metres; so small a thing may do with fewer rays
  constexpr unsigned kRays = 64, kFewRays = 16;
  static_assert(kRays % RayTracer::kPacket == 0 && kFewRays % RayTracer::kPacket == 0);
  const bool small = surface.side_u.norm() + surface.side_v.norm() < kSmall;
  const std::vector<Vector3f> directions = HalfSphere(small ? kFewRays : kRays);
  const float share = 1 / static_cast<float>(directions.size());
  const SurfaceGrid grid(surface, cell);
  Eigen::Matrix3f axes;
  axes << surface.side_u.normalized().cast<float>(), surface.side_v.normalized().cast<float>(),
      grid.normal().cast<float>();
  std::vector<Image<float>> sums(static_cast<std::size_t>(source_count()),
                                 Image<float>(grid.columns(), grid.rows()));
  const RayTracer::Moment nobody;
  for (int y = 0; y < grid.rows(); ++y) {
    for (int x = 0; x < grid.columns(); ++x) {
      RayTracer::Rays rays;
      rays.origin = grid.At(x, y).cast<float>();
      rays.count = RayTracer::kPacket;
      for (std::size_t begin = 0; begin < directions.size(); begin += RayTracer::kPacket) {
        for (std::size_t i = 0; i < RayTracer::kPacket; ++i) {
          rays.directions[i] = axes * directions[begin + i];
        }
        unsigned hits[RayTracer::kPacket];
        tracer.Trace(rays, nobody, hits);
        for (std::size_t i = 0; i < RayTracer::kPacket; ++i) {
          if (hits[i] == RayTracer::kNothing) {
            sums[0].at(x, y) += share * static_cast<float>(scene_.ambient);
            continue;
          }
          const Surface& other = scene_.surfaces[hits[i]];
          const Eigen::Vector2f place = MeetingPoint(other, rays.origin, rays.directions[i]);
          for (const Layer& layer : light[hits[i]]) {
            sums[static_cast<std::size_t>(layer.source)].at(x, y) +=
                share * static_cast<float>(other.texture.tone) *
                Sample(layer.grid, place.x(), place.y());
          }
        }
      }
    }
  }
  return WithoutDark(std::move(sums));
}

float LightMaps::Sample(const Image<float>& grid, float a, float b) {
  const float x = std::clamp(a, 0.0F, 1.0F) * static_cast<float>(grid.width() - 1);
  const float y = std::clamp(b, 0.0F, 1.0F) * static_cast<float>(grid.height() - 1);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, grid.width() - 1), y1 = std::min(y0 + 1, grid.height() - 1);
  const float ax = x - static_cast<float>(x0), ay = y - static_cast<float>(y0);
  const float top = grid.at(x0, y0) + ax * (grid.at(x1, y0) - grid.at(x0, y0));
  const float bottom = grid.at(x0, y1) + ax * (grid.at(x1, y1) - grid.at(x0, y1));
  return top + ay * (bottom - top);
}

}  // namespace plumbline
