// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"
#include "worlds/texture.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// A flat rectangle: origin + a * side_u + b * side_v, a and b in [0, 1], side_u normal to side_v.
// Metres, world frame (z up), or the frame of its body if it moves. Visible from both sides, lit on
// the side of its normal.
struct Surface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d side_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d side_v = Eigen::Vector3d::UnitY();
  TextureRecipe texture;
  double glow = 0;                         // light of its own, 1 for a white lamp
  int circuit = 0;                         // circuit of its glow, see Scene::circuits
  std::optional<int> body = std::nullopt;  // index in Scene::bodies; none for static surfaces

  Eigen::Vector3d PointAt(double a, double b) const { return origin + a * side_u + b * side_v; }
  Eigen::Vector3d Normal() const { return side_u.cross(side_v).normalized(); }

  // Returns the distance of a point from the rectangle, metres.
  double DistanceTo(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d offset = point - origin;
    const double a = std::clamp(offset.dot(side_u) / side_u.squaredNorm(), 0.0, 1.0);
    const double b = std::clamp(offset.dot(side_v) / side_v.squaredNorm(), 0.0, 1.0);
    return (point - PointAt(a, b)).norm();
  }
};

// A flat rectangular lamp (a tube, a panel, a window): each part of it shines into the half space
// of side_u x side_v by the cosine law. With both sides zero, a point that shines equally in all
// directions and casts hard shadows.
struct Lamp {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world, metres
  Eigen::Vector3d side_u = Eigen::Vector3d::Zero();  // whole side, metres
  Eigen::Vector3d side_v = Eigen::Vector3d::Zero();
  // brightness of a white surface facing it, straight ahead, at 1 m (as if it were small); 1 is
  // white in the image at exposure 1
  double power = 1;
  int circuit = 0;
};

// Brightness of the lamps of a circuit at a time in seconds, 1 by default, 0 off. Circuit 0 of a
// scene is always on and is not listed.
struct Circuit {
  std::function<double(double time)> level;
};

// A rigid moving object: its surfaces are given in its own frame.
struct Body {
  std::function<Rigid3(double time)> world_from_body;
};

// A world of textured rectangles under lamps, and the straight edges of its static bodies.
struct Scene {
  std::vector<Surface> surfaces;
  // between or at the ends of faces, static bodies only; world, metres
  std::vector<Segment3> edges;
  std::vector<Lamp> lamps;
  std::vector<Circuit> circuits;  // circuit k > 0 is circuits[k - 1]
  std::vector<Body> bodies;
  double ambient = 0.3;  // light from the sky: from directions without surfaces

  // Brightness of a circuit at a time.
  double Level(int circuit, double time) const {
    return circuit == 0 ? 1.0 : circuits[static_cast<std::size_t>(circuit) - 1].level(time);
  }
};

}  // namespace plumbline
