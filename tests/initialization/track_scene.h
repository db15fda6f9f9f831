// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/reconstruction.h"
#include "plumbline/initialization/tracks.h"

#include "tests/support/random_geometry.h"
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace plumbline::testing {

struct TrackSceneOptions {
  int points = 200;
  bool plane = false;     // all points on one plane, else a cloud 2 to 6 m away
  double sigma = 0;       // of the places; 0.5 px at f = 520 is 0.001
  double missed = 0;      // share of the places in frames between that are not matched
  double outliers = 0;    // share of the places that are wrong
  int lines = 0;          // between points of the same kind; all views show them
  double line_noise = 1;  // of their ends, in sigma
  int wrong_lines = 0;    // the first of them: other lines in the newest view
};

struct TrackScene {
  FeatureTracks tracks;
  Reconstruction truth;
};

// A handheld curve: centres on an arc of some decimetres, with some turning.
inline std::vector<Rigid3> CurvedMotion(int views, double length = 0.4) {
  std::vector<Rigid3> poses;
  for (int i = 1; i <= views; ++i) {
    const double s = static_cast<double>(i) / views;
    const Eigen::Vector3d centre(length * s, -0.5 * length * s * s, 0.3 * length * s);
    poses.push_back(Inverse(Rigid3{ExpSo3({0.02 * s, -0.05 * s * s, 0.01 * s}), centre}));
  }
  return poses;
}

inline Eigen::Vector3d ScenePoint(Rng& rng, bool plane) {
  const double x = rng.Uniform(-0.5, 0.5);
  const double y = rng.Uniform(-0.4, 0.4);
  // The plane (0.3, -0.2, 1) X = 3.
  const double z = plane ? 3 / (1 + 0.3 * x - 0.2 * y) : rng.Uniform(2, 6);
  return {x * z, y * z, z};
}

inline Segment2 Seen(const Rigid3& pose, const Segment3& line, Rng& rng, double sigma) {
  return {(pose * line.start).hnormalized() + Eigen::Vector2d(RandomVector<2>(rng, sigma)),
          (pose * line.end).hnormalized() + Eigen::Vector2d(RandomVector<2>(rng, sigma))};
}

// The lines of the options, each view's ends elsewhere on them.
inline void AddLines(std::uint64_t seed, const TrackSceneOptions& o, TrackScene& scene) {
  Rng rng(seed, "window_scene_lines");
  const double sigma = o.sigma > 0 ? o.sigma : 1e-3;
  LineTracks& lines = scene.tracks.lines;
  lines.views.resize(scene.truth.cam_from_reference.size());
  const auto see = [&](const Rigid3& pose, const Segment3& line, ViewLines& view) {
    const Eigen::Vector3d along = rng.Uniform(-0.2, 0.2) * (line.end - line.start);
    view.segments.push_back(
        Seen(pose, {line.start + along, line.end + along}, rng, o.line_noise * o.sigma));
    view.sigmas.push_back(sigma);
  };
  for (int k = 0; k < o.lines; ++k) {
    const Segment3 line{ScenePoint(rng, o.plane), ScenePoint(rng, o.plane)};
    scene.truth.lines.emplace_back(LineThroughPoints(line.start, line.end));
    see({}, line, lines.reference);
    for (std::size_t i = 0; i < lines.views.size(); ++i) {
      see(scene.truth.cam_from_reference[i], line, lines.views[i]);
    }
    if (k >= o.wrong_lines) continue;
    Segment2& wrong = lines.views.back().segments.back();
    const Eigen::Vector2d along = wrong.Direction();
    wrong.start += 0.03 * Eigen::Vector2d(-along.y(), along.x());
  }
}

inline TrackScene MakeTrackScene(std::uint64_t seed,
                                 const std::vector<Rigid3>& poses,
                                 const TrackSceneOptions& o = {}) {
  Rng rng(seed, "window_scene");
  TrackScene scene;
  scene.truth.cam_from_reference = poses;
  scene.tracks.views.resize(poses.size());
  const double sigma = o.sigma > 0 ? o.sigma : 1e-3;
  const auto see = [&](const Eigen::Vector3d& in_cam, ViewPoints& view, bool matched) {
    const bool wrong = rng.Uniform() < o.outliers;
    const Eigen::Vector2d noise = wrong ? Eigen::Vector2d(RandomVector<2>(rng, 0.05))
                                        : Eigen::Vector2d(RandomVector<2>(rng, o.sigma));
    view.points.emplace_back(in_cam.hnormalized() + noise);
    view.sigmas.push_back(matched ? sigma : 0);
  };
  for (int k = 0; k < o.points; ++k) {
    const Eigen::Vector3d point = ScenePoint(rng, o.plane);
    scene.truth.points.push_back(point);
    scene.truth.is_known.push_back(true);
    scene.tracks.features.push_back(k);
    scene.tracks.reference.points.emplace_back(point.hnormalized() +
                                               Eigen::Vector2d(RandomVector<2>(rng, o.sigma)));
    scene.tracks.reference.sigmas.push_back(sigma);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const bool newest = i + 1 == poses.size();
      see(poses[i] * point, scene.tracks.views[i], newest || rng.Uniform() >= o.missed);
    }
  }
  AddLines(seed, o, scene);
  return scene;
}

inline double RotationErrorDeg(const Rigid3& a, const Rigid3& b) {
  return AngularDistance(a.rotation, b.rotation) * 180 / std::numbers::pi;
}

// Between the directions of the two cameras' centres.
inline double DirectionErrorDeg(const Rigid3& a, const Rigid3& b) {
  const Eigen::Vector3d p = Inverse(a).translation;
  const Eigen::Vector3d q = Inverse(b).translation;
  return std::atan2(p.cross(q).norm(), p.dot(q)) * 180 / std::numbers::pi;
}

}  // namespace plumbline::testing
