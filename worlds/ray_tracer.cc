// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/ray_tracer.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <embree3/rtcore.h>

namespace plumbline {
namespace {

using Eigen::Vector3f;

// The quads of one rigid thing in its own frame.
class Tree {
 public:
  // `surfaces` are indices into the scene's.
  Tree(RTCDevice device, const Scene& scene, std::vector<unsigned> surfaces)
      : tree_(rtcNewScene(device)), surfaces_(std::move(surfaces)) {
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    const std::size_t count = surfaces_.size();
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count));
    PLUMBLINE_CHECK(count == 0 || (vertices != nullptr && indices != nullptr), "geometry buffers");
    for (std::size_t i = 0; i < count; ++i) {
      const Surface& surface = scene.surfaces[surfaces_[i]];
      const Eigen::Vector3d corners[4] = {surface.PointAt(0, 0),
                                          surface.PointAt(1, 0),
                                          surface.PointAt(1, 1),
                                          surface.PointAt(0, 1)};
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
  Tree(Tree&& other) noexcept
      : tree_(std::exchange(other.tree_, nullptr)), surfaces_(std::move(other.surfaces_)) {}
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  Tree& operator=(Tree&&) = delete;
  ~Tree() {
    if (tree_ != nullptr) rtcReleaseScene(tree_);
  }

  unsigned SurfaceOf(unsigned primitive) const { return surfaces_[primitive]; }
  RTCScene scene() const { return tree_; }

 private:
  RTCScene tree_ = nullptr;
  std::vector<unsigned> surfaces_;
};

struct Step {
  Vector3f from, step;
};

// From one point to another, shortened by a margin at both ends.
Step Shortened(const Vector3f& from, const Vector3f& to, float margin) {
  const Vector3f whole = to - from;
  const float length = whole.norm();
  const float cut = length > 2 * margin ? margin / length : 0;
  return {from + cut * whole, (1 - 2 * cut) * whole};
}

void Intersect(RTCScene tree, const int* valid, RTCRayHit8& packet) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, tree, &context, &packet);
}

// Whether something is on the way.
bool Blocks(RTCScene tree, const Step& way) {
  RTCRay ray{};
  ray.org_x = way.from.x();
  ray.org_y = way.from.y();
  ray.org_z = way.from.z();
  ray.dir_x = way.step.x();
  ray.dir_y = way.step.y();
  ray.dir_z = way.step.z();
  ray.tfar = 1;
  ray.mask = ~0U;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree, &context, &ray);
  return ray.tfar < 0;  // minus infinity when something is in the way
}

}  // namespace

// All bodies where they are at one time: instances of their trees, numbered as the bodies are.
class BodyTree {
 public:
  BodyTree(RTCDevice device,
           const std::vector<Tree>& trees,
           const std::vector<Rigid3>& world_from_body)
      : tree_(rtcNewScene(device)) {
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(tree_, RTC_BUILD_QUALITY_LOW);
    for (std::size_t i = 0; i < world_from_body.size(); ++i) {
      RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, trees[i].scene());
      const Eigen::Matrix4f matrix = world_from_body[i].Matrix().cast<float>();
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, matrix.data());
      rtcCommitGeometry(instance);
      rtcAttachGeometryByID(tree_, instance, static_cast<unsigned>(i));
      rtcReleaseGeometry(instance);
    }
    rtcCommitScene(tree_);
  }
  BodyTree(const BodyTree&) = delete;
  BodyTree& operator=(const BodyTree&) = delete;
  ~BodyTree() { rtcReleaseScene(tree_); }

  RTCScene scene() const { return tree_; }

 private:
  RTCScene tree_;
};

// Embree rounds in another way with each of its instruction sets. With the one that every processor
// of the architecture has, a world has the same images everywhere.
constexpr const char* kDeviceSettings = "threads=1,isa=sse2";

class RayTracer::Implementation {
 public:
  explicit Implementation(const Scene& scene)
      : device_(rtcNewDevice(kDeviceSettings)), bodies_(scene.bodies) {
    PLUMBLINE_CHECK(device_ != nullptr, "ray tracing device");
    std::vector<std::vector<unsigned>> parts(1 + scene.bodies.size());
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
      const std::optional<int>& body = scene.surfaces[i].body;
      parts[body ? static_cast<std::size_t>(*body) + 1 : 0].push_back(static_cast<unsigned>(i));
    }
    still_.emplace(device_, scene, std::move(parts[0]));
    for (std::size_t i = 1; i < parts.size(); ++i) {
      body_trees_.emplace_back(device_, scene, std::move(parts[i]));
    }
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    body_trees_.clear();
    still_.reset();
    rtcReleaseDevice(device_);
  }

  Moment At(double time) const {
    Moment moment;
    if (bodies_.empty()) return moment;
    std::vector<Rigid3> world_from_body;
    for (const Body& body : bodies_) {
      world_from_body.push_back(body.world_from_body(time));
      const Rigid3 body_from_world = Inverse(world_from_body.back());
      moment.bodies.push_back({body_from_world.rotation.toRotationMatrix().cast<float>(),
                               body_from_world.translation.cast<float>()});
    }
    moment.tree = std::make_shared<const BodyTree>(device_, body_trees_, world_from_body);
    return moment;
  }

  void Trace(const Rays& rays, const Moment& moment, unsigned* hits) const {
    alignas(32) int valid[kPacket];
    RTCRayHit8 packet;
    for (int i = 0; i < kPacket; ++i) {
      const Vector3f& direction =
          rays.directions[static_cast<std::size_t>(std::min(i, rays.count - 1))];
      valid[i] = i < rays.count ? -1 : 0;
      packet.ray.org_x[i] = rays.origin.x();
      packet.ray.org_y[i] = rays.origin.y();
      packet.ray.org_z[i] = rays.origin.z();
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
      packet.hit.instID[0][i] = kNothing;
    }
    Intersect(still_->scene(), valid, packet);
    if (moment.tree) Intersect(moment.tree->scene(), valid, packet);
    for (int i = 0; i < rays.count; ++i) {
      const unsigned body = packet.hit.instID[0][i], primitive = packet.hit.primID[i];
      if (packet.hit.geomID[i] == kNothing) {
        hits[i] = kNothing;
      } else {
        hits[i] = (body == kNothing ? *still_ : body_trees_[body]).SurfaceOf(primitive);
      }
    }
  }

  bool StillSees(const Vector3f& from, const Vector3f& to, float margin) const {
    return !Blocks(still_->scene(), Shortened(from, to, margin));
  }

  static bool BodiesLetPass(const Vector3f& from,
                            const Vector3f& to,
                            float margin,
                            const Moment& moment) {
    return !moment.tree || !Blocks(moment.tree->scene(), Shortened(from, to, margin));
  }

 private:
  RTCDevice device_;
  std::vector<Body> bodies_;
  std::optional<Tree> still_;
  std::vector<Tree> body_trees_;
};

RayTracer::RayTracer(const Scene& scene)
    : implementation_(std::make_unique<Implementation>(scene)) {}
RayTracer::~RayTracer() = default;

RayTracer::Moment RayTracer::At(double time) const { return implementation_->At(time); }

void RayTracer::Trace(const Rays& rays, const Moment& moment, unsigned* hits) const {
  implementation_->Trace(rays, moment, hits);
}

bool RayTracer::StillSees(const Vector3f& from, const Vector3f& to, float margin) const {
  return implementation_->StillSees(from, to, margin);
}

bool RayTracer::BodiesLetPass(const Vector3f& from,
                              const Vector3f& to,
                              float margin,
                              const Moment& moment) const {
  return Implementation::BodiesLetPass(from, to, margin, moment);
}

}  // namespace plumbline
