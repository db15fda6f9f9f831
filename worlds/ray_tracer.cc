// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/ray_tracer.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

namespace plumbline {
namespace {

using Eigen::Vector3f;

// Embree multiplies by approximate reciprocals, whose rounding depends on the processor: of two
// surfaces hit at the same position, as in a corner, it may report either one first, and it may
// include or miss an object that just touches the end of a segment. Therefore all near hits are
// found, and distances by divisions in double precision decide between them.
constexpr float kNear = 1e-5F;  // relative to a distance; what Embree rounds is a hundredth of it
constexpr float kNearest = 0.01F;  // the least distance for this: a ray may begin on a surface

// With the instruction set common to all processors of the architecture, Embree's tests of a ray
// against the sides of a surface, which need no reciprocals, are the same everywhere.
constexpr const char* kDeviceSettings = "threads=1,isa=sse2";

struct Ray {
  Vector3f from, direction;
};

// The plane of a surface in the frame of its tree.
struct Plane {
  Eigen::Vector3d normal;
  double offset = 0;  // of its points along the normal

  // Distance of the plane along a ray, in lengths of the direction.
  double Distance(const Ray& ray) const {
    return (offset - normal.dot(ray.from.cast<double>())) /
           normal.dot(ray.direction.cast<double>());
  }
};

// The first surface that a ray meets: the nearest one, of equals that of the smallest index.
struct Meeting {
  double distance = std::numeric_limits<double>::infinity();
  unsigned surface = RayTracer::kNothing;

  void Take(double other_distance, unsigned other_surface) {
    if (std::pair(other_distance, other_surface) >= std::pair(distance, surface)) return;
    distance = other_distance;
    surface = other_surface;
  }
};

// The quads of one rigid thing in its own frame.
class Tree {
 public:
  // `surfaces` are indices into the scene's.
  Tree(RTCDevice device, const Scene& scene, std::vector<unsigned> surfaces)
      : tree_(rtcNewScene(device)), surfaces_(std::move(surfaces)) {
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    const std::size_t count = surfaces_.size();
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count));
    PLUMBLINE_CHECK(count == 0 || (vertices != nullptr && indices != nullptr), "geometry buffers");
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < count; ++i) {
      const Surface& surface = scene.surfaces[surfaces_[i]];
      const Eigen::Vector3d corners[4] = {surface.PointAt(0, 0),
                                          surface.PointAt(1, 0),
                                          surface.PointAt(1, 1),
                                          surface.PointAt(0, 1)};
      for (std::size_t k = 0; k < 4; ++k) {
        indices[4 * i + k] = static_cast<unsigned>(4 * i + k);
        Eigen::Map<Vector3f>(vertices + 3 * (4 * i + k)) = corners[k].cast<float>();
        box.extend(Eigen::Map<Vector3f>(vertices + 3 * (4 * i + k)));
      }
      const Eigen::Vector3d normal = surface.side_u.cross(surface.side_v);
      planes_.push_back({normal, normal.dot(corners[0])});
    }
    if (count > 0) {
      centre_ = box.center();
      radius_ = kAround * box.diagonal().norm() / 2;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_);
  }
  Tree(Tree&& other) noexcept
      : tree_(std::exchange(other.tree_, nullptr)),
        surfaces_(std::move(other.surfaces_)),
        planes_(std::move(other.planes_)),
        centre_(std::move(other.centre_)),
        radius_(other.radius_) {}
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  Tree& operator=(Tree&&) = delete;
  ~Tree() {
    if (tree_ != nullptr) rtcReleaseScene(tree_);
  }

  const Vector3f& centre() const { return centre_; }
  float radius() const { return radius_; }

  // Finds the first hits of the rays in use (-1, others 0), if nearer than their known hits.
  void Trace(const Ray* rays, const int* in_use, Meeting* meetings) const;

  // Returns true if an object lies between a ray's start and the end of its direction.
  bool Blocks(const Ray& ray) const;

 private:
  struct Search;
  static void KeepNearest(const RTCFilterFunctionNArguments* found);
  static void RefuseBeyond(const RTCFilterFunctionNArguments* found);
  double Distance(const RTCFilterFunctionNArguments& found, unsigned i) const;

  static constexpr float kAround = 1.001F;  // more than the rounding

  RTCScene tree_ = nullptr;
  std::vector<unsigned> surfaces_;
  std::vector<Plane> planes_;
  Vector3f centre_ = Vector3f::Zero();  // of a ball that has all surfaces inside
  float radius_ = 0;
};

// Argument of the functions that Embree calls for each surface hit by a ray.
struct Tree::Search {
  RTCIntersectContext context;
  const Tree* tree = nullptr;
  Meeting* meetings = nullptr;

  Search(const Tree& of, RTCFilterFunctionN filter, Meeting* of_rays)
      : tree(&of), meetings(of_rays) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
  }
  static const Search& Of(const RTCFilterFunctionNArguments& found) {
    return *reinterpret_cast<const Search*>(found.context);
  }
};

double Tree::Distance(const RTCFilterFunctionNArguments& found, unsigned i) const {
  const unsigned n = found.N;
  const Ray ray{{RTCRayN_org_x(found.ray, n, i),
                 RTCRayN_org_y(found.ray, n, i),
                 RTCRayN_org_z(found.ray, n, i)},
                {RTCRayN_dir_x(found.ray, n, i),
                 RTCRayN_dir_y(found.ray, n, i),
                 RTCRayN_dir_z(found.ray, n, i)}};
  return planes_[RTCHitN_primID(found.hit, n, i)].Distance(ray);
}

// Refuses all, so that Embree goes on to the others that are as near.
void Tree::KeepNearest(const RTCFilterFunctionNArguments* found) {
  const Search& search = Search::Of(*found);
  for (unsigned i = 0; i < found->N; ++i) {
    if (found->valid[i] != -1) continue;
    found->valid[i] = 0;
    const unsigned primitive = RTCHitN_primID(found->hit, found->N, i);
    search.meetings[RTCRayN_id(found->ray, found->N, i)].Take(search.tree->Distance(*found, i),
                                                              search.tree->surfaces_[primitive]);
  }
}

void Tree::RefuseBeyond(const RTCFilterFunctionNArguments* found) {
  for (unsigned i = 0; i < found->N; ++i) {
    if (found->valid[i] == -1 && Search::Of(*found).tree->Distance(*found, i) > 1) {
      found->valid[i] = 0;
    }
  }
}

void Tree::Trace(const Ray* rays, const int* in_use, Meeting* meetings) const {
  alignas(32) int valid[RayTracer::kPacket];
  RTCRayHit8 packet;
  for (unsigned i = 0; i < RayTracer::kPacket; ++i) {
    valid[i] = in_use[i];
    packet.ray.org_x[i] = rays[i].from.x();
    packet.ray.org_y[i] = rays[i].from.y();
    packet.ray.org_z[i] = rays[i].from.z();
    packet.ray.dir_x[i] = rays[i].direction.x();
    packet.ray.dir_y[i] = rays[i].direction.y();
    packet.ray.dir_z[i] = rays[i].direction.z();
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = (1 + kNear) * static_cast<float>(meetings[i].distance);
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = i;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RayTracer::kNothing;
    packet.hit.primID[i] = RayTracer::kNothing;
    packet.hit.instID[0][i] = RayTracer::kNothing;
  }
  Search first(*this, nullptr, nullptr);
  first.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, tree_, &first.context, &packet);
  for (unsigned i = 0; i < RayTracer::kPacket; ++i) {
    if (packet.hit.geomID[i] == RayTracer::kNothing) {
      valid[i] = 0;
      continue;
    }
    const unsigned primitive = packet.hit.primID[i];
    meetings[i].Take(planes_[primitive].Distance(rays[i]), surfaces_[primitive]);
    const float around = kNear * (packet.ray.tfar[i] + kNearest);
    packet.ray.tnear[i] = std::max(0.0F, packet.ray.tfar[i] - around);
    packet.ray.tfar[i] += around;
    packet.hit.geomID[i] = RayTracer::kNothing;
  }
  Search second(*this, &Tree::KeepNearest, meetings);
  second.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, tree_, &second.context, &packet);
}

bool Tree::Blocks(const Ray& way) const {
  RTCRay ray{};
  ray.org_x = way.from.x();
  ray.org_y = way.from.y();
  ray.org_z = way.from.z();
  ray.dir_x = way.direction.x();
  ray.dir_y = way.direction.y();
  ray.dir_z = way.direction.z();
  ray.tfar = 1 + kNear;
  ray.mask = ~0U;
  Search search(*this, &Tree::RefuseBeyond, nullptr);
  rtcOccluded1(tree_, &search.context, &ray);
  return ray.tfar < 0;  // minus infinity when something is in the way
}

// The way from one point to another, shortened by a margin at both ends.
Ray Shortened(const Vector3f& from, const Vector3f& to, float margin) {
  const Vector3f whole = to - from;
  const float length = whole.norm();
  const float cut = length > 2 * margin ? margin / length : 0;
  return {from + cut * whole, (1 - 2 * cut) * whole};
}

Ray InFrameOf(const RayTracer::Moment::Pose& body, const Ray& ray) {
  return {body.rotation * ray.from + body.translation, body.rotation * ray.direction};
}

// Below or at zero for each ball that a ray meets.
Eigen::Array4f Beside(const Ray& ray, const RayTracer::FourBalls& balls) {
  const Eigen::Array4f x = balls.x - ray.from.x();
  const Eigen::Array4f y = balls.y - ray.from.y();
  const Eigen::Array4f z = balls.z - ray.from.z();
  const Eigen::Array4f outside = x * x + y * y + z * z - balls.squared_radius;
  const Eigen::Array4f along =
      x * ray.direction.x() + y * ray.direction.y() + z * ray.direction.z();
  return outside.min(outside * ray.direction.squaredNorm() - along * along.abs());
}

// Calls a function with the index of each body whose ball a ray meets, or nearly so, until it
// returns false.
template <class Function>
void ForBodiesNear(const Ray& ray, const RayTracer::Moment& moment, const Function& function) {
  for (std::size_t group = 0; group < moment.balls.size(); ++group) {
    const Eigen::Array4f beside = Beside(ray, moment.balls[group]);
    if (beside.minCoeff() > 0) continue;
    for (int i = 0; i < 4; ++i) {
      if (beside[i] <= 0 && !function(4 * group + static_cast<std::size_t>(i))) return;
    }
  }
}

}  // namespace

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
    moment.balls.resize((bodies_.size() + 3) / 4);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const Rigid3 world_from_body = bodies_[k].world_from_body(time);
      const Tree& tree = body_trees_[k];
      const Vector3f centre = (world_from_body * tree.centre().cast<double>()).cast<float>();
      FourBalls& balls = moment.balls[k / 4];
      const auto i = static_cast<Eigen::Index>(k % 4);
      balls.x[i] = centre.x();
      balls.y[i] = centre.y();
      balls.z[i] = centre.z();
      balls.squared_radius[i] = tree.radius() * tree.radius();
      const Rigid3 body_from_world = Inverse(world_from_body);
      moment.bodies.push_back({body_from_world.rotation.toRotationMatrix().cast<float>(),
                               body_from_world.translation.cast<float>()});
    }
    return moment;
  }

  void Trace(const Rays& rays, const Moment& moment, unsigned* hits) const {
    Ray in_world[kPacket], in_body[kPacket];
    int in_use[kPacket] = {};
    Meeting meetings[kPacket];
    std::set<std::size_t> near;  // bodies
    for (int i = 0; i < kPacket; ++i) {
      const int some = std::min(i, rays.count - 1);
      in_world[i] = {rays.origin, rays.directions[static_cast<std::size_t>(some)]};
      in_use[i] = i < rays.count ? -1 : 0;
      ForBodiesNear(in_world[i], moment, [&](std::size_t k) { return near.insert(k), true; });
    }
    still_->Trace(in_world, in_use, meetings);
    for (const std::size_t k : near) {
      for (int i = 0; i < kPacket; ++i) in_body[i] = InFrameOf(moment.bodies[k], in_world[i]);
      body_trees_[k].Trace(in_body, in_use, meetings);
    }
    for (int i = 0; i < rays.count; ++i) hits[i] = meetings[i].surface;
  }

  bool StillSees(const Vector3f& from, const Vector3f& to, float margin) const {
    return !still_->Blocks(Shortened(from, to, margin));
  }

  bool BodiesLetPass(const Vector3f& from,
                     const Vector3f& to,
                     float margin,
                     const Moment& moment) const {
    const Ray way = Shortened(from, to, margin);
    bool pass = true;
    ForBodiesNear(way, moment, [&](std::size_t k) {
      return pass = !body_trees_[k].Blocks(InFrameOf(moment.bodies[k], way));
    });
    return pass;
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
  return implementation_->BodiesLetPass(from, to, margin, moment);
}

}  // namespace plumbline
