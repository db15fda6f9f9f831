// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/dataset.h"
#include "plumbline/map/map.h"
#include "worlds/ray_tracer.h"
#include "worlds/scene.h"

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

namespace plumbline::bench {

// Metres between two cameras, cam_from_world.
double DistanceOfCentres(const Rigid3& a, const Rigid3& b);

// Where the camera of a sequence truly was, and what two of its views have in common. Beside a
// rendered sequence lie its surfaces: rays tell what is hidden. For a recording a keyframe's own
// landmarks stand for what it sees, and nothing is hidden.
class ViewTruth {
 public:
  // InputError where the sequence has no ground truth. rectified_from_left: of the camera that
  // keyframes are poses of.
  ViewTruth(const Dataset& dataset,
            const RectifiedCamera& camera,
            const Eigen::Quaterniond& rectified_from_left);

  // cam_from_world of the rectified camera; nullopt where the truth has no pose of that time.
  std::optional<Rigid3> PoseAt(std::int64_t stamp_ns) const;

  // Metres per unit of the map around a keyframe: of the distances to the keyframes that share
  // most with it, the true sum over that of the map. 1 where that is not known.
  double UnitAround(const Map& map, KeyFrameId id) const;

  // The share of what a keyframe shows that another pose sees too: of its view on a grid, or of
  // its landmarks. `unit`: UnitAround the keyframe.
  double SharedView(const KeyFrame& keyframe,
                    const Map& map,
                    const Rigid3& other_from_world,
                    double unit) const;

  // Where the ray through a pixel of the rectified camera meets a surface, at the start of the
  // sequence; nullopt for a recording, and where it meets none.
  std::optional<Eigen::Vector3d> SurfaceAt(std::int64_t stamp_ns, const Eigen::Vector2d& px) const;

 private:
  std::optional<Eigen::Vector3d> SurfaceAt(const Rigid3& world_from,
                                           const Eigen::Vector2d& px) const;
  double SharedByRays(const Rigid3& from_world, const Rigid3& other_from_world) const;

  Trajectory poses_;  // of the left camera
  RectifiedCamera camera_;
  Eigen::Quaterniond rectified_from_left_;
  Scene scene_;
  std::unique_ptr<RayTracer> tracer_;  // null for a recording
};

}  // namespace plumbline::bench
