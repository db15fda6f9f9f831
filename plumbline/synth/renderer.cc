// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/renderer.h"

#include "plumbline/base/error.h"
#include "plumbline/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <embree3/rtcore.h>

namespace plumbline {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kPacket = 8;
constexpr unsigned kNothing = RTC_INVALID_GEOMETRY_ID;

// A surface as one camera sees it: (u w, v w, w) = matrix * (ray.x, ray.y, 1), u and v in [0, 1];
// depth = 1 / w.
struct ProjectedSurface {
  Matrix3f matrix = Matrix3f::Identity();
};

ProjectedSurface ProjectSurface(const Surface& surface, const Rigid3& world_from_camera) {
  // A point depth * ray lies on the surface where its offset from the origin is u side_u + v
  // side_v.
  const Rigid3 camera_from_world = Inverse(world_from_camera);
  const Eigen::Vector3d origin = camera_from_world * surface.origin;
  const Eigen::Vector3d side_u = camera_from_world.rotation * surface.side_u;
  const Eigen::Vector3d side_v = camera_from_world.rotation * surface.side_v;
  const Eigen::Vector3d normal = side_u.cross(side_v);
  const double distance = normal.dot(origin);
  // In the plane of the camera centre it is never hit; any finite matrix will do.
  const double safe = std::abs(distance) > 1e-12 ? distance : 1e-12;
  const Eigen::RowVector3d inverse_depth = normal.transpose() / safe;
  Eigen::Matrix3d m;
  m.row(2) = inverse_depth;
  m.row(0) = (side_u.transpose() - side_u.dot(origin) * inverse_depth) / side_u.squaredNorm();
  m.row(1) = (side_v.transpose() - side_v.dot(origin) * inverse_depth) / side_v.squaredNorm();
  return {m.cast<float>()};
}

}  // namespace

RayTable::RayTable(const Camera& camera) : width_(camera.width()), height_(camera.height()) {
  entries_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const auto ray_at = [&camera](double x, double y) -> Eigen::Vector2d {
    const std::optional<Eigen::Vector3d> ray = camera.Unproject({x, y});
    if (!ray) {
      throw InputError("camera: expected a ray for every pixel, found none at (" +
                       std::to_string(x) + ", " + std::to_string(y) + ")");
    }
    return ray->head<2>();
  };
  // One ray a pixel, and one beyond each border; the slope comes from the two neighbours.
  std::vector<Eigen::Vector2d> grid;
  const int stride = width_ + 2;
  grid.reserve(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height_ + 2));
  for (int y = -1; y <= height_; ++y) {
    for (int x = -1; x <= width_; ++x) grid.push_back(ray_at(x, y));
  }
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2d* centre = grid.data() + (y + 1) * stride + x + 1;
      Entry entry;
      entry.ray = centre->cast<float>();
      entry.slope.col(0) = (0.5 * (centre[1] - centre[-1])).cast<float>();
      entry.slope.col(1) = (0.5 * (centre[stride] - centre[-stride])).cast<float>();
      entries_.push_back(entry);
    }
  }
}

class Renderer::Implementation {
 public:
  Implementation(const Scene& scene, const RendererOptions& options) : scene_(scene) {
    BuildTree();
    textures_.resize(scene_.surfaces.size());
    ParallelFor(static_cast<int>(scene_.surfaces.size()), options.threads, [&](int i) {
      const Surface& surface = scene_.surfaces[static_cast<std::size_t>(i)];
      textures_[static_cast<std::size_t>(i)] = Texture::Bake(surface.texture,
                                                             surface.side_u.norm(),
                                                             surface.side_v.norm(),
                                                             options.texel,
                                                             LightOn(surface));
    });
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    rtcReleaseScene(tree_);
    rtcReleaseDevice(device_);
  }

  Rendering Render(const RayTable& rays, const Rigid3& world_from_camera) const;

 private:
  // One view: the camera, the surfaces as it sees them, the surface at each pixel centre.
  struct View {
    const RayTable& rays;
    Matrix3f rotation;
    Vector3f origin;
    std::vector<ProjectedSurface> surfaces;
    Image<unsigned> hits;
  };

  void BuildTree();
  // Light on a surface with the shadows that the others throw on it, on a grid of some centimetres.
  Image<float> LightOn(const Surface& surface) const;
  bool Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  // Surfaces hit by up to kPacket rays (camera frame, z = 1); kNothing for none.
  void Trace(const View& view, const Vector2f* camera_rays, int count, unsigned* hits) const;
  void TraceCentres(View& view) const;
  float ShadeInside(const View& view, int x, int y, unsigned surface) const;
  float ShadeEdge(const View& view, int x, int y) const;
  float Lookup(const View& view, unsigned surface, const Vector2f& ray, int level) const;
  int LevelAt(const View& view, unsigned surface, int x, int y, float sample_spacing) const;

  Scene scene_;
  std::vector<Texture> textures_;
  RTCDevice device_ = nullptr;
  RTCScene tree_ = nullptr;
};

void Renderer::Implementation::BuildTree() {
  device_ = rtcNewDevice("threads=1");
  PLUMBLINE_CHECK(device_ != nullptr, "ray tracing device");
  tree_ = rtcNewScene(device_);
  rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
  const std::size_t count = scene_.surfaces.size();
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count));
  PLUMBLINE_CHECK(count == 0 || (vertices != nullptr && indices != nullptr), "geometry buffers");
  for (std::size_t i = 0; i < count; ++i) {
    const Surface& surface = scene_.surfaces[i];
    const Eigen::Vector3d corners[4] = {
        surface.PointAt(0, 0), surface.PointAt(1, 0), surface.PointAt(1, 1), surface.PointAt(0, 1)};
    for (std::size_t k = 0; k < 4; ++k) {
      indices[4 * i + k] = static_cast<unsigned>(4 * i + k);
      Eigen::Map<Vector3f>(vertices + 3 * (4 * i + k)) = corners[k].cast<float>();
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(tree_);
}

bool Renderer::Implementation::Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  RTCRay ray{};
  const Vector3f origin = from.cast<float>(), direction = (to - from).cast<float>();
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = 1;
  ray.mask = ~0U;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree_, &context, &ray);
  return ray.tfar > 0;  // minus infinity when something is in the way
}

Image<float> Renderer::Implementation::LightOn(const Surface& surface) const {
  constexpr double kCell = 0.05;    // metres
  constexpr double kMargin = 0.02;  // stay this share off the rim, which other bodies touch
  constexpr double kLift = 0.002;   // metres off the surface, not to be shadowed by itself
  const int columns = 2 + static_cast<int>(surface.side_u.norm() / kCell);
  const int rows = 2 + static_cast<int>(surface.side_v.norm() / kCell);
  const Eigen::Vector3d normal = surface.Normal();
  Image<float> light(columns, rows);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double a = std::clamp(x / (columns - 1.0), kMargin, 1 - kMargin);
      const double b = std::clamp(y / (rows - 1.0), kMargin, 1 - kMargin);
      const Eigen::Vector3d point = surface.PointAt(a, b) + kLift * normal;
      double sum = scene_.ambient * (1 + 0.25 * normal.z()) + surface.glow;
      for (const Lamp& lamp : scene_.lamps) {
        for (int i = 0; i < 4; ++i) {
          const Eigen::Vector3d place =
              lamp.centre + (i % 2 - 0.5) * 0.5 * lamp.side_u + (i / 2 - 0.5) * 0.5 * lamp.side_v;
          const Eigen::Vector3d offset = place - point;
          const double facing = normal.dot(offset);
          if (facing <= 0 || !Sees(point, place)) continue;
          sum += 0.25 * lamp.power * facing / std::pow(offset.squaredNorm(), 1.5);
        }
      }
      light.at(x, y) = static_cast<float>(sum);
    }
  }
  return light;
}

void Renderer::Implementation::Trace(const View& view,
                                     const Vector2f* camera_rays,
                                     int count,
                                     unsigned* hits) const {
  alignas(32) int valid[kPacket];
  RTCRayHit8 packet;
  for (int i = 0; i < kPacket; ++i) {
    const Vector2f& ray = camera_rays[std::min(i, count - 1)];
    const Vector3f direction = view.rotation * Vector3f(ray.x(), ray.y(), 1);
    valid[i] = i < count ? -1 : 0;
    packet.ray.org_x[i] = view.origin.x();
    packet.ray.org_y[i] = view.origin.y();
    packet.ray.org_z[i] = view.origin.z();
    packet.ray.dir_x[i] = direction.x();
    packet.ray.dir_y[i] = direction.y();
    packet.ray.dir_z[i] = direction.z();
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = kNothing;
    packet.hit.primID[i] = kNothing;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, tree_, &context, &packet);
  for (int i = 0; i < count; ++i) {
    hits[i] = packet.hit.geomID[i] == kNothing ? kNothing : packet.hit.primID[i];
  }
}

void Renderer::Implementation::TraceCentres(View& view) const {
  const int width = view.rays.width();
  Vector2f rays[kPacket];
  for (int y = 0; y < view.rays.height(); ++y) {
    for (int x = 0; x < width; x += kPacket) {
      const int count = std::min(kPacket, width - x);
      for (int i = 0; i < count; ++i) rays[i] = view.rays.at(x + i, y).ray;
      Trace(view, rays, count, view.hits.row(y) + x);
    }
  }
}

float Renderer::Implementation::Lookup(const View& view,
                                       unsigned surface,
                                       const Vector2f& ray,
                                       int level) const {
  const Matrix3f& m = view.surfaces[surface].matrix;
  const float w = 1 / (m(2, 0) * ray.x() + m(2, 1) * ray.y() + m(2, 2));
  const float u = (m(0, 0) * ray.x() + m(0, 1) * ray.y() + m(0, 2)) * w;
  const float v = (m(1, 0) * ray.x() + m(1, 1) * ray.y() + m(1, 2)) * w;
  return textures_[surface].Sample(u, v, level);
}

int Renderer::Implementation::LevelAt(
    const View& view, unsigned surface, int x, int y, float sample_spacing) const {
  const RayTable::Entry& entry = view.rays.at(x, y);
  const Matrix3f& m = view.surfaces[surface].matrix;
  const Texture& texture = textures_[surface];
  const Vector3f p = m * Vector3f(entry.ray.x(), entry.ray.y(), 1);
  const float w = 1 / p.z();
  // Size of a pixel in texels, the geometric mean of its two sides: the square root of the
  // determinant of d(texel)/d(pixel).
  Eigen::Matrix2f texel_from_ray;
  for (int k = 0; k < 2; ++k) {
    const float scale = static_cast<float>(k == 0 ? texture.width() : texture.height()) * w;
    texel_from_ray.row(k) = scale * (m.block<1, 2>(k, 0) - p(k) * w * m.block<1, 2>(2, 0));
  }
  const float area = std::abs((texel_from_ray * entry.slope).determinant());
  return texture.LevelFor(sample_spacing * std::sqrt(area));
}

float Renderer::Implementation::ShadeInside(const View& view,
                                            int x,
                                            int y,
                                            unsigned surface) const {
  const RayTable::Entry& entry = view.rays.at(x, y);
  const int level = LevelAt(view, surface, x, y, 0.5F);
  constexpr float kQuarter = 0.25F;
  float sum = 0;
  for (const float dy : {-kQuarter, kQuarter}) {
    for (const float dx : {-kQuarter, kQuarter})
      sum += Lookup(view, surface, entry.At(dx, dy), level);
  }
  return 0.25F * sum;
}

float Renderer::Implementation::ShadeEdge(const View& view, int x, int y) const {
  constexpr int kSide = 4, kSamples = kSide * kSide;
  static_assert(kSamples % kPacket == 0);
  const RayTable::Entry& entry = view.rays.at(x, y);
  Vector2f rays[kSamples];
  unsigned hits[kSamples];
  for (int i = 0; i < kSamples; ++i) {
    const float dx = (static_cast<float>(i % kSide) + 0.5F) / kSide - 0.5F;
    const float dy = (static_cast<float>(i / kSide) + 0.5F) / kSide - 0.5F;
    rays[i] = entry.At(dx, dy);
  }
  for (int i = 0; i < kSamples; i += kPacket) Trace(view, rays + i, kPacket, hits + i);
  float sum = 0;
  unsigned surface = kNothing;
  int level = 0;
  for (int i = 0; i < kSamples; ++i) {
    if (hits[i] == kNothing) continue;
    if (hits[i] != surface) {
      surface = hits[i];
      level = LevelAt(view, surface, x, y, 0.5F);
    }
    sum += Lookup(view, surface, rays[i], level);
  }
  return sum / kSamples;
}

Rendering Renderer::Implementation::Render(const RayTable& rays,
                                           const Rigid3& world_from_camera) const {
  const int width = rays.width(), height = rays.height();
  View view{rays,
            world_from_camera.rotation.toRotationMatrix().cast<float>(),
            world_from_camera.translation.cast<float>(),
            {},
            Image<unsigned>(width, height)};
  for (const Surface& surface : scene_.surfaces) {
    view.surfaces.push_back(ProjectSurface(surface, world_from_camera));
  }
  TraceCentres(view);
  Rendering result{Image<float>(width, height), DepthImage(width, height)};
  for (int y = 0; y < height; ++y) {
    const unsigned* rows[3] = {view.hits.row(std::max(y - 1, 0)),
                               view.hits.row(y),
                               view.hits.row(std::min(y + 1, height - 1))};
    for (int x = 0; x < width; ++x) {
      const unsigned hit = rows[1][x];
      bool inside = hit != kNothing;
      for (const unsigned* row : rows) {
        inside = inside && row[std::max(x - 1, 0)] == hit && row[x] == hit &&
                 row[std::min(x + 1, width - 1)] == hit;
      }
      result.light.at(x, y) = inside ? ShadeInside(view, x, y, hit) : ShadeEdge(view, x, y);
      if (hit == kNothing) continue;
      const Vector2f& ray = rays.at(x, y).ray;
      const Matrix3f& m = view.surfaces[hit].matrix;
      result.depth.at(x, y) = 1 / (m(2, 0) * ray.x() + m(2, 1) * ray.y() + m(2, 2));
    }
  }
  return result;
}

Renderer::Renderer(const Scene& scene, const RendererOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;

Rendering Renderer::Render(const RayTable& rays, const Rigid3& world_from_camera) const {
  return implementation_->Render(rays, world_from_camera);
}

}  // namespace plumbline
