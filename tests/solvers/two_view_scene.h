// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/solvers/relative_pose.h"

#include "tests/support/random_geometry.h"
#include <vector>

#include <Eigen/Core>

namespace plumbline::testing {

// kPlane: moving along it, so that the other solution has points behind the cameras; kTwofoldPlane:
// towards it, so that it has none.
enum class SceneKind { kGeneral, kPlane, kTwofoldPlane, kForward, kLowParallax, kTurnOnly };

// Two views of the same points, 2 to 8 in front of the first.
struct TwoViewScene {
  Rigid3 b_from_a;                // |translation| = 1, but for a mere turn: 0
  std::vector<RayMatch> matches;  // every so many a wrong one
};

struct TwoViewOptions {
  SceneKind kind = SceneKind::kGeneral;
  int points = 300;
  double outliers = 0;       // share of matches with any place in b
  double noise = 1;          // multiplies the errors; the sigmas stay as they are
  double sigma = 1.0 / 500;  // of a coordinate
};

inline Eigen::Vector3d TranslationOf(SceneKind kind) {
  switch (kind) {
    case SceneKind::kTwofoldPlane:
      return {0.15, 0.05, -0.5};
    case SceneKind::kForward:
      return {0.02, 0.01, -0.4};
    case SceneKind::kLowParallax:
      return {0.1, 0.02, 0.01};
    case SceneKind::kTurnOnly:
      return {0, 0, 0};
    default:
      return {0.3, 0.05, 0.02};
  }
}

inline double DepthOf(SceneKind kind, const Eigen::Vector2d& a, Rng& rng) {
  const double depth = rng.Uniform(2, 8);
  if (kind != SceneKind::kPlane && kind != SceneKind::kTwofoldPlane) return depth;
  return 4 / Eigen::Vector3d(0.3, -0.2, 1).dot(a.homogeneous());
}

inline Eigen::Vector2d RandomRay(Rng& rng) {
  const double x = rng.Uniform(-0.6, 0.6);
  return {x, rng.Uniform(-0.45, 0.45)};
}

inline TwoViewScene MakeTwoViewScene(std::uint64_t seed, const TwoViewOptions& options) {
  Rng rng(seed, "two_view_scene");
  TwoViewScene scene;
  scene.b_from_a = {ExpSo3(RandomVector<3>(rng, 0.05)), TranslationOf(options.kind)};
  while (static_cast<int>(scene.matches.size()) < options.points) {
    const Eigen::Vector2d a = RandomRay(rng);
    const Eigen::Vector3d in_b = scene.b_from_a * (DepthOf(options.kind, a, rng) * a.homogeneous());
    RayMatch match{a, in_b.head<2>() / in_b.z(), options.sigma, options.sigma};
    match.a += RandomVector<2>(rng, options.noise * options.sigma);
    match.b += RandomVector<2>(rng, options.noise * options.sigma);
    if (rng.Uniform() < options.outliers) match.b = RandomRay(rng);
    scene.matches.push_back(match);
  }
  if (options.kind != SceneKind::kTurnOnly) scene.b_from_a.translation.normalize();
  return scene;
}

// Angle between two directions, radians.
inline double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace plumbline::testing
