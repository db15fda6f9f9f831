// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/ray_tracer.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

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
        box_.extend(corners[k].cast<float>());
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_);
  }
  Tree(Tree&& other) noexcept
      : tree_(std::exchange(other.tree_, nullptr)),
        surfaces_(std::move(other.surfaces_)),
        box_(other.box_) {}
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  Tree& operator=(Tree&&) = delete;
  ~Tree() {
    if (tree_ != nullptr) rtcReleaseScene(tree_);
  }

  unsigned SurfaceOf(unsigned primitive) const { return surfaces_[primitive]; }
  Vector3f Centre() const { return box_.isEmpty() ? Vector3f::Zero().eval() : box_.center(); }
  float Radius() const { return box_.isEmpty() ? 0 : 0.5F * box_.diagonal().norm(); }

  void Intersect(const int* valid, RTCRayHit8& packet) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, tree_, &context, &packet);
  }

  // Whether something is on from + t * step, t in [0, 1].
  bool Blocks(const Vector3f& from, const Vector3f& step) const {
    RTCRay ray{};
    ray.org_x = from.x();
    ray.org_y = from.y();
    ray.org_z = from.z();
    ray.dir_x = step.x();
    ray.dir_y = step.y();
    ray.dir_z = step.z();
    ray.tfar = 1;
    ray.mask = ~0U;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree_, &context, &ray);
    return ray.tfar < 0;  // minus infinity when something is in the way
  }

 private:
  RTCScene tree_ = nullptr;
  std::vector<unsigned> surfaces_;
  Eigen::AlignedBox3f box_;
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

float DistanceToPiece(const Vector3f& point, const Step& piece) {
  const float along = piece.step.squaredNorm();
  const float t =
      along > 0 ? std::clamp((point - piece.from).dot(piece.step) / along, 0.0F, 1.0F) : 0;
  return (piece.from + t * piece.step - point).norm();
}

}  // namespace

class RayTracer::Implementation {
 public:
  explicit Implementation(const Scene& scene)
      : device_(rtcNewDevice("threads=1")), bodies_(scene.bodies) {
    PLUMBLINE_CHECK(device_ != nullptr, "ray tracing device");
    std::vector<std::vector<unsigned>> parts(1 + scene.bodies.size());
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
      const std::optional<int>& body = scene.surfaces[i].body;
      parts[body ? static_cast<std::size_t>(*body) + 1 : 0].push_back(static_cast<unsigned>(i));
    }
    for (auto& part : parts) trees_.emplace_back(device_, scene, std::move(part));
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    trees_.clear();
    rtcReleaseDevice(device_);
  }

  Moment At(double time) const {
    Moment moment;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Rigid3 world_from_body = bodies_[i].world_from_body(time);
      const Rigid3 body_from_world = Inverse(world_from_body);
      moment.bodies.push_back(
          {body_from_world.rotation.toRotationMatrix().cast<float>(),
           body_from_world.translation.cast<float>(),
           (world_from_body * trees_[i + 1].Centre().cast<double>()).cast<float>()});
    }
    return moment;
  }

  void Trace(const Rays& rays, const Moment& moment, unsigned* hits) const {
    alignas(32) int valid[kPacket];
    RTCRayHit8 packet;
    for (int i = 0; i < kPacket; ++i) {
      valid[i] = i < rays.count ? -1 : 0;
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      hits[i] = kNothing;
    }
    IntersectPart(0, rays.origin, rays, valid, packet, hits);
    for (std::size_t k = 0; k < moment.bodies.size(); ++k) {
      const Moment::Pose& pose = moment.bodies[k];
      Rays local;
      local.count = rays.count;
      for (int i = 0; i < rays.count; ++i) {
        const auto lane = static_cast<std::size_t>(i);
        local.directions[lane] = pose.rotation * rays.directions[lane];
      }
      local.origin = pose.rotation * rays.origin + pose.translation;
      IntersectPart(k + 1, local.origin, local, valid, packet, hits);
    }
  }

  bool StillSees(const Vector3f& from, const Vector3f& to, float margin) const {
    const Step piece = Shortened(from, to, margin);
    return !trees_[0].Blocks(piece.from, piece.step);
  }

  bool BodiesLetPass(const Vector3f& from,
                     const Vector3f& to,
                     float margin,
                     const Moment& moment) const {
    const Step piece = Shortened(from, to, margin);
    for (std::size_t k = 0; k < moment.bodies.size(); ++k) {
      const Moment::Pose& pose = moment.bodies[k];
      if (DistanceToPiece(pose.centre, piece) > trees_[k + 1].Radius()) continue;
      if (trees_[k + 1].Blocks(pose.rotation * piece.from + pose.translation,
                               pose.rotation * piece.step)) {
        return false;
      }
    }
    return true;
  }

 private:
  // Continues a packet, whose tfar holds the nearest hits so far, with the tree of one part.
  void IntersectPart(std::size_t part,
                     const Vector3f& origin,
                     const Rays& rays,
                     const int* valid,
                     RTCRayHit8& packet,
                     unsigned* hits) const {
    for (int i = 0; i < kPacket; ++i) {
      const Vector3f& direction =
          rays.directions[static_cast<std::size_t>(std::min(i, rays.count - 1))];
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = direction.x();
      packet.ray.dir_y[i] = direction.y();
      packet.ray.dir_z[i] = direction.z();
      packet.ray.tnear[i] = 0;
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = ~0U;
      packet.ray.id[i] = 0;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = kNothing;
      packet.hit.primID[i] = kNothing;
    }
    trees_[part].Intersect(valid, packet);
    for (int i = 0; i < rays.count; ++i) {
      if (packet.hit.geomID[i] != kNothing) hits[i] = trees_[part].SurfaceOf(packet.hit.primID[i]);
    }
  }

  RTCDevice device_;
  std::vector<Body> bodies_;
  std::vector<Tree> trees_;  // what stands still, then the bodies
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
  return implementation_->BodiesLetPass(from, to, margin, moment);
}

}  // namespace plumbline
