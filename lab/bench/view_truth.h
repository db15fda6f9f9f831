// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/datasets/dataset.h"
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

// True camera poses of a sequence, and the common part of two of its views. A rendered sequence has
// its surfaces beside it: rays determine occlusion. For a recording, the visible area of a keyframe
// is that of its own landmarks, and nothing is occluded.
class ViewTruth {
 public:
  // Throws InputError if the sequence has no ground truth. rectified_from_left: of the camera of
  // the keyframes' poses.
  ViewTruth(const Dataset& dataset,
            const RectifiedCamera& camera,
            const Eigen::Quaterniond& rectified_from_left);

  // cam_from_world of the rectified camera; nullopt if the truth has no pose of that time.
  std::optional<Rigid3> PoseAt(std::int64_t stamp_ns) const;

  // Returns the metres per map unit around a keyframe: the sum of the true distances to the
  // keyframes that share most with it, over that of the map. 1 if unknown.
  double UnitAround(const Map& map, KeyFrameId id) const;

  // Returns the share of a keyframe's view also visible from another pose: of its view on a grid,
  // or of its landmarks. `unit`: UnitAround the keyframe.
  double SharedView(const KeyFrame& keyframe,
                    const Map& map,
                    const Rigid3& other_from_world,
                    double unit) const;

  // Returns the intersection of the ray through a pixel of the rectified camera with the surfaces,
  // at the start of the sequence; nullopt for a recording, and if there is none.
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
