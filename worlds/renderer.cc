// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/renderer.h"

#include "worlds/light_map.h"
#include "worlds/noise.h"
#include "worlds/ray_tracer.h"
#include "worlds/shading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kPacket = RayTracer::kPacket;
constexpr unsigned kNothing = RayTracer::kNothing;
constexpr float kWhite = 255;
constexpr int kEdgeSamples = 16;
constexpr int kMostTimeSamples = 64;

struct CameraPose {
  Eigen::Matrix3f rotation;  // world_from_camera
  Vector3f origin;

  explicit CameraPose(const Rigid3& world_from_camera)
      : rotation(world_from_camera.rotation.toRotationMatrix().cast<float>()),
        origin(world_from_camera.translation.cast<float>()) {}
  Vector3f Direction(const Vector3f& ray) const { return rotation * ray; }
};

// Sample positions within a pixel, with their mean exactly at its centre: a grid for square
// numbers, otherwise a sequence of low discrepancy (with distant neighbours; always used if samples
// also differ in time).
std::vector<Vector2f> PixelPlaces(int count, bool in_time) {
  std::vector<Vector2f> places;
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  if (!in_time && side * side == count) {
    for (int i = 0; i < count; ++i) {
      const int row = i / side;
      places.emplace_back((static_cast<float>(i % side) + 0.5F) / static_cast<float>(side) - 0.5F,
                          (static_cast<float>(row) + 0.5F) / static_cast<float>(side) - 0.5F);
    }
    return places;
  }
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;  // plastic number
  Vector2f mean = Vector2f::Zero();
  for (int i = 0; i < count; ++i) {
    const double x = 0.5 + kStepX * i, y = 0.5 + kStepY * i;
    places.emplace_back(static_cast<float>(x - std::floor(x)),
                        static_cast<float>(y - std::floor(y)));
    mean += places.back() / static_cast<float>(count);
  }
  for (Vector2f& place : places) place -= mean;
  return places;
}

// The camera and the world while an image is taken, as functions of time within it. The pose is
// interpolated between 33 exact ones: within a millisecond it is straight enough, and the path may
// be costly.
class Take {
 public:
  Take(const Renderer::PoseAt& pose_at, const Shutter& shutter, const Shading& shading, int height)
      : shutter_(shutter), height_(height) {
    const double half = 0.5 * (shutter.exposure + shutter.readout);
    begin_ = shutter.centre - half;
    span_ = 2 * half;
    const int count = span_ > 0 ? kPieces + 1 : 1;
    for (int i = 0; i < count; ++i) {
      const double time = begin_ + span_ * i / kPieces;
      poses_.push_back(pose_at(time));
      instants_.push_back(shading.At(time));
    }
  }

  bool moving() const { return span_ > 0; }

  double RowTime(int y) const {
    return shutter_.centre + ((y + 0.5) / height_ - 0.5) * shutter_.readout;
  }
  // Time of one of `count` samples of a row.
  double SampleTime(int y, int sample, int count) const {
    return RowTime(y) + ((sample + 0.5) / count - 0.5) * shutter_.exposure;
  }
  CameraPose PoseAt(double time) const {
    if (!moving()) return CameraPose(poses_[0]);
    const double place = Place(time);
    const auto before = std::min(static_cast<std::size_t>(place), poses_.size() - 2);
    const double share = place - static_cast<double>(before);
    return CameraPose(Interpolate(poses_[before], poses_[before + 1], share));
  }
  const Instant& InstantAt(double time) const {
    return instants_[moving() ? static_cast<std::size_t>(std::lround(Place(time))) : 0];
  }
  const Rigid3& first() const { return poses_.front(); }
  const Rigid3& last() const { return poses_.back(); }

 private:
  static constexpr int kPieces = 32;

  double Place(double time) const {
    return std::clamp((time - begin_) / span_, 0.0, 1.0) * kPieces;
  }

  Shutter shutter_;
  int height_;
  double begin_ = 0, span_ = 0;
  std::vector<Rigid3> poses_;
  std::vector<Instant> instants_;
};

}  // namespace

class Renderer::Implementation {
 public:
  Implementation(const Scene& scene, const RendererOptions& options)
      : samples_(options.samples),
        time_samples_(options.time_samples),
        inside_places_(PixelPlaces(options.samples, false)),
        edge_places_(PixelPlaces(std::max(options.samples, kEdgeSamples), false)),
        inside_spacing_(1 / std::sqrt(static_cast<float>(options.samples))),
        sky_(kWhite * static_cast<float>(scene.ambient)),
        tracer_(scene),
        shading_(scene,
                 tracer_,
                 options.texels.empty() ? std::vector<double>(scene.surfaces.size(), 0.003)
                                        : options.texels,
                 options.threads) {}

  Rendering Render(const RayTable& rays, const PoseAt& pose_at, const Shutter& shutter) const;

  bool Sees(const Vector3d& from, const Vector3d& to, double margin, double time) const {
    const Vector3f a = from.cast<float>(), b = to.cast<float>();
    const auto inwards = static_cast<float>(margin);
    return tracer_.StillSees(a, b, inwards) &&
           tracer_.BodiesLetPass(a, b, inwards, tracer_.At(time));
  }

 private:
  // The rays of a row at one time.
  struct RowView {
    const RayTable& rays;
    int y;
    CameraPose pose;
    const Instant& instant;
  };

  void TraceRow(const RowView& view, const Vector2f& place, unsigned* hits) const;
  int LevelAt(const RowView& view, int x, unsigned surface, float spacing) const;
  float ShadeAt(const RowView& view,
                int x,
                const Vector2f& place,
                unsigned surface,
                int level,
                int sample) const;
  float ShadeInside(const RowView& view, int x, unsigned surface) const;
  float ShadeEdge(const RowView& view, int x) const;
  void RenderInstant(const RayTable& rays,
                     const Take& take,
                     const Image<unsigned>& centres,
                     Image<float>& light) const;
  void RenderOpen(const RayTable& rays,
                  const Take& take,
                  const DepthImage& depth,
                  Image<float>& light) const;
  int TimeSamples(const RayTable& rays, const Take& take, const DepthImage& depth) const;

  // Which of the points of a lamp a sample looks at: all of them in turn within a pixel, from
  // another one on in each pixel.
  static int SampleNumber(int x, int y, int sample) {
    return static_cast<int>(HashCell(x, y, 0) % kLampPoints) + 5 * sample;
  }

  int samples_, time_samples_;
  std::vector<Vector2f> inside_places_, edge_places_;
  float inside_spacing_;  // of the samples within a pixel
  float sky_;             // where there is nothing
  RayTracer tracer_;
  Shading shading_;
};

void Renderer::Implementation::TraceRow(const RowView& view,
                                        const Vector2f& place,
                                        unsigned* hits) const {
  RayTracer::Rays packet;
  packet.origin = view.pose.origin;
  for (int x = 0; x < view.rays.width(); x += kPacket) {
    packet.count = std::min(kPacket, view.rays.width() - x);
    for (int i = 0; i < packet.count; ++i) {
      packet.directions[static_cast<std::size_t>(i)] =
          view.pose.Direction(view.rays.at(x + i, view.y).At(place.x(), place.y()));
    }
    unsigned found[kPacket];
    tracer_.Trace(packet, view.instant.moment, found);
    std::copy_n(found, packet.count, hits + x);
  }
}

int Renderer::Implementation::LevelAt(const RowView& view,
                                      int x,
                                      unsigned surface,
                                      float spacing) const {
  const RayTable::Entry& entry = view.rays.at(x, view.y);
  const Eigen::Matrix<float, 3, 2> step = spacing * entry.slope;
  const SurfaceHit hit{surface, view.pose.origin, view.pose.Direction(entry.ray), 0};
  return shading_.LevelOf(
      hit, view.pose.rotation * step.col(0), view.pose.rotation * step.col(1), view.instant);
}

float Renderer::Implementation::ShadeAt(const RowView& view,
                                        int x,
                                        const Vector2f& place,
                                        unsigned surface,
                                        int level,
                                        int sample) const {
  const Vector3f ray = view.rays.at(x, view.y).At(place.x(), place.y());
  return shading_.Shade(
      {surface, view.pose.origin, view.pose.Direction(ray), sample}, level, view.instant);
}

float Renderer::Implementation::ShadeInside(const RowView& view, int x, unsigned surface) const {
  const std::vector<Vector2f>& places = inside_places_;
  const int level = LevelAt(view, x, surface, inside_spacing_);
  float sum = 0;
  int sample = 0;
  for (const Vector2f& place : places) {
    sum += ShadeAt(view, x, place, surface, level, SampleNumber(x, view.y, sample++));
  }
  return sum / static_cast<float>(places.size());
}

float Renderer::Implementation::ShadeEdge(const RowView& view, int x) const {
  const auto count = static_cast<int>(edge_places_.size());
  const RayTable::Entry& entry = view.rays.at(x, view.y);
  RayTracer::Rays packet;
  packet.origin = view.pose.origin;
  float sum = 0;
  unsigned surface = kNothing;
  int level = 0;
  for (int begin = 0; begin < count; begin += kPacket) {
    packet.count = std::min(kPacket, count - begin);
    for (int i = 0; i < packet.count; ++i) {
      const Vector2f& place = edge_places_[static_cast<std::size_t>(begin + i)];
      packet.directions[static_cast<std::size_t>(i)] =
          view.pose.Direction(entry.At(place.x(), place.y()));
    }
    unsigned hits[kPacket];
    tracer_.Trace(packet, view.instant.moment, hits);
    for (int i = 0; i < packet.count; ++i) {
      if (hits[i] == kNothing) {
        sum += sky_;
        continue;
      }
      if (hits[i] != surface) {
        surface = hits[i];
        level = LevelAt(view, x, surface, inside_spacing_);
      }
      const SurfaceHit hit{surface,
                           packet.origin,
                           packet.directions[static_cast<std::size_t>(i)],
                           SampleNumber(x, view.y, begin + i)};
      sum += shading_.Shade(hit, level, view.instant);
    }
  }
  return sum / static_cast<float>(count);
}

void Renderer::Implementation::RenderInstant(const RayTable& rays,
                                             const Take& take,
                                             const Image<unsigned>& centres,
                                             Image<float>& light) const {
  const int width = rays.width(), height = rays.height();
  for (int y = 0; y < height; ++y) {
    const double time = take.RowTime(y);
    const RowView view{rays, y, take.PoseAt(time), take.InstantAt(time)};
    const unsigned* rows[3] = {
        centres.row(std::max(y - 1, 0)), centres.row(y), centres.row(std::min(y + 1, height - 1))};
    for (int x = 0; x < width; ++x) {
      const unsigned hit = rows[1][x];
      bool inside = true;
      for (const unsigned* row : rows) {
        inside = inside && row[std::max(x - 1, 0)] == hit && row[x] == hit &&
                 row[std::min(x + 1, width - 1)] == hit;
      }
      light.at(x, y) = !inside           ? ShadeEdge(view, x)
                       : hit == kNothing ? sky_
                                         : ShadeInside(view, x, hit);
    }
  }
}

// The image motion of the nearest surface meanwhile, in pixels.
int Renderer::Implementation::TimeSamples(const RayTable& rays,
                                          const Take& take,
                                          const DepthImage& depth) const {
  const Rigid3 last_from_first = Inverse(take.last()) * take.first();
  double farthest = 0;
  const int step_x = std::max(1, rays.width() / 16), step_y = std::max(1, rays.height() / 16);
  for (int y = step_y / 2; y < rays.height(); y += step_y) {
    for (int x = step_x / 2; x < rays.width(); x += step_x) {
      const RayTable::Entry& entry = rays.at(x, y);
      if (depth.at(x, y) <= 0) continue;
      const Vector3d ray = entry.ray.cast<double>();
      const auto moved = rays.Scaled(last_from_first * (depth.at(x, y) / ray.z() * ray));
      if (!moved) continue;
      const Eigen::Matrix<double, 3, 2> slope = entry.slope.cast<double>();
      const Eigen::Matrix2d squared = slope.transpose() * slope;
      farthest =
          std::max(farthest, (squared.inverse() * (slope.transpose() * (*moved - ray))).norm());
    }
  }
  const int least = std::max(time_samples_, samples_);
  return std::clamp(
      static_cast<int>(std::ceil(farthest)), least, std::max(least, kMostTimeSamples));
}

void Renderer::Implementation::RenderOpen(const RayTable& rays,
                                          const Take& take,
                                          const DepthImage& depth,
                                          Image<float>& light) const {
  const int width = rays.width(), height = rays.height();
  const int count = TimeSamples(rays, take, depth);
  const std::vector<Vector2f> places = PixelPlaces(count, true);
  const float spacing = 1 / std::sqrt(static_cast<float>(std::min(count, kEdgeSamples)));
  struct Known {
    unsigned surface;
    int level;
  };
  std::vector<unsigned> hits(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    // The texture level belongs to surface and pixel; it hardly changes between the times.
    std::vector<Known> known(static_cast<std::size_t>(width), {kNothing, 0});
    for (int s = 0; s < count; ++s) {
      const double time = take.SampleTime(y, s, count);
      const RowView view{rays, y, take.PoseAt(time), take.InstantAt(time)};
      const Vector2f& place = places[static_cast<std::size_t>(s)];
      TraceRow(view, place, hits.data());
      for (int x = 0; x < width; ++x) {
        const auto column = static_cast<std::size_t>(x);
        const unsigned surface = hits[column];
        if (surface == kNothing) {
          light.at(x, y) += sky_ / static_cast<float>(count);
          continue;
        }
        Known& last = known[column];
        if (last.surface != surface) last = {surface, LevelAt(view, x, surface, spacing)};
        light.at(x, y) += ShadeAt(view, x, place, surface, last.level, SampleNumber(x, y, s)) /
                          static_cast<float>(count);
      }
    }
  }
}

Rendering Renderer::Implementation::Render(const RayTable& rays,
                                           const PoseAt& pose_at,
                                           const Shutter& shutter) const {
  const int width = rays.width(), height = rays.height();
  const Take take(pose_at, shutter, shading_, height);
  Rendering result{Image<float>(width, height), DepthImage(width, height)};
  Image<unsigned> centres(width, height);
  for (int y = 0; y < height; ++y) {
    const double time = take.RowTime(y);
    const RowView view{rays, y, take.PoseAt(time), take.InstantAt(time)};
    TraceRow(view, Vector2f::Zero(), centres.row(y));
    for (int x = 0; x < width; ++x) {
      const unsigned surface = centres.at(x, y);
      const RayTable::Entry& entry = rays.at(x, y);
      // What is beside the camera or behind it has no depth.
      if (surface == kNothing || !entry.seen || !(entry.ray.z() > 0)) continue;
      const SurfaceHit hit{surface, view.pose.origin, view.pose.Direction(entry.ray), 0};
      result.depth.at(x, y) = entry.ray.z() * shading_.Distance(hit, view.instant);
    }
  }
  if (shutter.exposure > 0) {
    RenderOpen(rays, take, result.depth, result.light);
  } else {
    RenderInstant(rays, take, centres, result.light);
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!rays.at(x, y).seen) result.light.at(x, y) = 0;
    }
  }
  return result;
}

Renderer::Renderer(const Scene& scene, const RendererOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;

Rendering Renderer::Render(const RayTable& rays,
                           const PoseAt& pose_at,
                           const Shutter& shutter) const {
  return implementation_->Render(rays, pose_at, shutter);
}

Rendering Renderer::Render(const RayTable& rays, const Rigid3& world_from_camera) const {
  return Render(
      rays, [&](double) { return world_from_camera; }, Shutter{});
}

bool Renderer::Sees(const Vector3d& from, const Vector3d& to, double margin, double time) const {
  return implementation_->Sees(from, to, margin, time);
}

}  // namespace plumbline
