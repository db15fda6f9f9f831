// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/scene.h"

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Intersects rays with a scene (Embree). Thread-safe; results depend only on the arguments.
class RayTracer {
 public:
  static constexpr int kPacket = 8;
  static constexpr unsigned kNothing = ~0U;

  // Four balls, tested against a ray at once.
  struct FourBalls {
    Eigen::Array4f x = Eigen::Array4f::Zero(), y = x, z = x;           // centres; world, metres
    Eigen::Array4f squared_radius = Eigen::Array4f::Constant(-1e30F);  // default: hit by no ray
  };

  // Poses of the bodies of the scene at a time.
  struct Moment {
    struct Pose {
      Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // body_from_world
      Eigen::Vector3f translation = Eigen::Vector3f::Zero();
    };
    std::vector<Pose> bodies;
    // A ball around each body: that of body i is number i % 4 of balls[i / 4].
    std::vector<FourBalls> balls;
  };

  // Several rays from one point.
  struct Rays {
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();  // world, metres
    std::array<Eigen::Vector3f, kPacket> directions;   // world, any length
    int count = 0;
  };

  explicit RayTracer(const Scene& scene);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  Moment At(double time) const;

  // Sets the first surface (index in Scene::surfaces) hit by each ray; kNothing for none.
  void Trace(const Rays& rays, const Moment& moment, unsigned* hits) const;

  // Returns true if no static surface is between two points, both moved slightly inwards (`margin`,
  // metres).
  bool StillSees(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float margin) const;
  // Returns true if no body is between two points.
  bool BodiesLetPass(const Eigen::Vector3f& from,
                     const Eigen::Vector3f& to,
                     float margin,
                     const Moment& moment) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumbline
