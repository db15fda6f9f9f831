// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/scene.h"

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Finds what rays meet in a scene (Embree). Calls may come from several threads; results depend on
// nothing but the arguments.
class RayTracer {
 public:
  static constexpr int kPacket = 8;
  static constexpr unsigned kNothing = ~0U;

  // Four balls, compared with a ray at once.
  struct FourBalls {
    Eigen::Array4f x = Eigen::Array4f::Zero(), y = x, z = x;           // centres; world, metres
    Eigen::Array4f squared_radius = Eigen::Array4f::Constant(-1e30F);  // as it is: met by nothing
  };

  // Where the bodies of the scene are at some time.
  struct Moment {
    struct Pose {
      Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // body_from_world
      Eigen::Vector3f translation = Eigen::Vector3f::Zero();
    };
    std::vector<Pose> bodies;
    // A ball around each body: that of body i is number i % 4 of balls[i / 4].
    std::vector<FourBalls> balls;
  };

  // Some rays from one point.
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

  // The first surface (index in Scene::surfaces) that each ray meets; kNothing for none.
  void Trace(const Rays& rays, const Moment& moment, unsigned* hits) const;

  // Whether nothing that stands still is between two points, both taken a little inwards
  // (`margin`, metres).
  bool StillSees(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float margin) const;
  // Whether no body is between two points.
  bool BodiesLetPass(const Eigen::Vector3f& from,
                     const Eigen::Vector3f& to,
                     float margin,
                     const Moment& moment) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumbline
