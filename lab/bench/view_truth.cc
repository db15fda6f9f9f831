// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "view_truth.h"

#include "plumbline/base/error.h"
#include "plumbline/map/covisibility.h"
#include "worlds/true_world.h"

#include <algorithm>
#include <filesystem>

namespace plumbline::bench {
namespace {

constexpr int kColumns = 24, kRows = 16;

Scene ReadScene(const std::filesystem::path& file) {
  Scene scene;
  for (const Parallelogram& part : ReadSurfaces(file)) {
    scene.surfaces.push_back({part.origin, part.side_u, part.side_v, {}});
  }
  return scene;
}

}  // namespace

double DistanceOfCentres(const Rigid3& a, const Rigid3& b) {
  return (Inverse(a).translation - Inverse(b).translation).norm();
}

ViewTruth::ViewTruth(const Dataset& dataset,
                     const RectifiedCamera& camera,
                     const Eigen::Quaterniond& rectified_from_left)
    : camera_(camera), rectified_from_left_(rectified_from_left) {
  const DatasetInfo& info = dataset.info();
  if (!info.ground_truth) throw InputError(info.path.string() + ": expected ground truth");
  poses_ = info.ground_truth->OfCamera(dataset.calibration());
  const std::filesystem::path surfaces = info.path / "surfaces.csv";
  if (!std::filesystem::exists(surfaces)) return;
  scene_ = ReadScene(surfaces);
  tracer_ = std::make_unique<RayTracer>(scene_);
}

std::optional<Rigid3> ViewTruth::PoseAt(std::int64_t stamp_ns) const {
  constexpr std::int64_t kMaxGapNs = 200'000'000;
  const auto pose = InterpolateAt(poses_, stamp_ns, kMaxGapNs);
  if (!pose) return std::nullopt;
  return Rigid3{rectified_from_left_, Eigen::Vector3d::Zero()} * Inverse(*pose);
}

double ViewTruth::UnitAround(const Map& map, KeyFrameId id) const {
  const KeyFrame* keyframe = map.Find(id);
  const auto here = PoseAt(keyframe->frame.stamp_ns);
  if (!here) return 1;
  double in_map = 0;
  double in_truth = 0;
  for (const auto& near : ClosestCovisible(map, id, 8)) {
    const KeyFrame& other = *map.Find(near.id);
    const auto there = PoseAt(other.frame.stamp_ns);
    if (!there) continue;
    in_map += DistanceOfCentres(keyframe->frame.cam_from_world, other.frame.cam_from_world);
    in_truth += DistanceOfCentres(*here, *there);
  }
  return in_map > 0 && in_truth > 0 ? in_truth / in_map : 1;
}

double ViewTruth::SharedView(const KeyFrame& keyframe,
                             const Map& map,
                             const Rigid3& other_from_world,
                             double unit) const {
  const auto here = PoseAt(keyframe.frame.stamp_ns);
  if (!here) return 0;
  if (tracer_) return SharedByRays(*here, other_from_world);
  const Rigid3 other_from_here = other_from_world * Inverse(*here);
  int all = 0;
  int shared = 0;
  for (const PointId id : keyframe.frame.points) {
    if (!id.valid()) continue;
    const Eigen::Vector3d place = keyframe.frame.cam_from_world * map.Find(id)->position;
    const Eigen::Vector3d seen = other_from_here * (unit * place);
    ++all;
    shared += seen.z() > 0 && camera_.Contains(camera_.Project(seen));
  }
  return static_cast<double>(shared) / std::max(1, all);
}

std::optional<Eigen::Vector3d> ViewTruth::SurfaceAt(std::int64_t stamp_ns,
                                                    const Eigen::Vector2d& px) const {
  const auto from_world = PoseAt(stamp_ns);
  if (!tracer_ || !from_world) return std::nullopt;
  return SurfaceAt(Inverse(*from_world), px);
}

std::optional<Eigen::Vector3d> ViewTruth::SurfaceAt(const Rigid3& world_from,
                                                    const Eigen::Vector2d& px) const {
  const Eigen::Vector3d way = world_from.rotation * camera_.Unproject(px);
  RayTracer::Rays rays;
  rays.origin = world_from.translation.cast<float>();
  rays.directions.fill(way.cast<float>());
  rays.count = 1;
  unsigned hits[RayTracer::kPacket] = {};
  tracer_->Trace(rays, tracer_->At(0), hits);
  if (hits[0] == RayTracer::kNothing) return std::nullopt;
  const Surface& surface = scene_.surfaces[hits[0]];
  const Eigen::Vector3d normal = surface.Normal();
  const double along = normal.dot(surface.origin - world_from.translation) / normal.dot(way);
  return world_from.translation + along * way;
}

double ViewTruth::SharedByRays(const Rigid3& from_world, const Rigid3& other_from_world) const {
  constexpr float kMargin = 0.02F;
  const Rigid3 world_from = Inverse(from_world);
  const Eigen::Vector3f other = Inverse(other_from_world).translation.cast<float>();
  int all = 0;
  int shared = 0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const Eigen::Vector2d px((i % kColumns + 0.5) * camera_.width / kColumns,
                             (static_cast<double>(i / kColumns) + 0.5) * camera_.height / kRows);
    const auto hit = SurfaceAt(world_from, px);
    if (!hit) continue;
    ++all;
    const Eigen::Vector3d& place = *hit;
    const Eigen::Vector3d seen = other_from_world * place;
    if (seen.z() <= 0 || !camera_.Contains(camera_.Project(seen))) continue;
    shared += tracer_->StillSees(place.cast<float>(), other, kMargin);
  }
  return static_cast<double>(shared) / std::max(1, all);
}

}  // namespace plumbline::bench
