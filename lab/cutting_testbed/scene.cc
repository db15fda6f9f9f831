// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/scene.h"

#include "plumbline/base/elementary.h"
#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kImageSigma = 1;  // px, of each end of a measured line across itself
constexpr double kMinDepth = 0.3;  // m, of true and estimated ends
const Vector3d kHalfCuboid(1.5, 1.0, 0.75);

RectifiedCamera CuboidCamera() {
  return {.fx = 500, .fy = 500, .cx = 320, .cy = 240, .baseline = 0, .width = 640, .height = 480};
}
RectifiedCamera StereoCamera() {
  return {
      .fx = 450, .fy = 450, .cx = 376, .cy = 240, .baseline = 0.11, .width = 752, .height = 480};
}

Vector3d RandomNormal(Rng& rng) { return {rng.Normal(), rng.Normal(), rng.Normal()}; }

// The camera at `centre` that looks at `target`, turned about its axis by `roll`.
Rigid3 LookAt(const Vector3d& centre, const Vector3d& target, double roll) {
  const Vector3d z = (target - centre).normalized();
  const Vector3d side = z.unitOrthogonal();
  const Vector3d x = math::Cos(roll) * side + math::Sin(roll) * z.cross(side);
  Eigen::Matrix3d cam_from_world;
  cam_from_world << x.transpose(), z.cross(x).transpose(), z.transpose();
  const Eigen::Quaterniond rotation(cam_from_world);
  return {rotation, -(rotation * centre)};
}

// The twelve edges, in random order and direction.
std::vector<Segment3> Edges(Rng& rng) {
  std::vector<Segment3> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Vector3d start = -kHalfCuboid;
      if ((corner & 1) != 0) start((axis + 1) % 3) *= -1;
      if ((corner & 2) != 0) start((axis + 2) % 3) *= -1;
      Vector3d end = start;
      end(axis) = -end(axis);
      edges.push_back({start, end});
      if (rng.Index(2) == 0) edges.back() = edges.back().Reversed();
    }
  }
  rng.Shuffle(edges);
  return edges;
}

// Between two random points of a face.
Segment3 Chord(Rng& rng) {
  const auto axis = static_cast<int>(rng.Index(3));
  const double side = rng.Index(2) == 0 ? -1 : 1;
  const auto point = [&] {
    Vector3d p;
    for (int i = 0; i < 3; ++i) p(i) = rng.Uniform(-kHalfCuboid(i), kHalfCuboid(i));
    p(axis) = side * kHalfCuboid(axis);
    return p;
  };
  Segment3 chord{point(), point()};
  while (chord.Length() < 0.5) chord = {point(), point()};
  return chord;
}

std::vector<Segment3> CuboidLines(int count, Rng& rng) {
  std::vector<Segment3> lines = Edges(rng);
  const auto size = static_cast<std::size_t>(count);
  while (lines.size() < size) lines.push_back(Chord(rng));
  lines.resize(size);
  return lines;
}

Segment3 Move(const Rigid3& b_from_a, const Segment3& segment) {
  return {b_from_a * segment.start, b_from_a * segment.end};
}

// Noise of an end in the camera that saw it first.
struct EndNoise {
  Rigid3 cam_from_anchor;
  double sigma_px = 0;
  double sigma_inverse_depth = 0;
  double sigma_relative = 0;  // of the inverse depth, in place of the former
};

struct MeasuredEnd {
  Vector3d point;
  Eigen::Matrix3d covariance;
};

// Covariances are those at the measured point: the true one is not known.
MeasuredEnd Measure(const RectifiedCamera& camera,
                    const EndNoise& noise,
                    const Vector3d& point_in_cam,
                    Rng& rng) {
  const Vector3d truth = Inverse(noise.cam_from_anchor) * point_in_cam;
  const auto sigma = [&](double z) {
    return noise.sigma_relative > 0 ? noise.sigma_relative / z : noise.sigma_inverse_depth;
  };
  for (;;) {
    const Eigen::Vector2d px = camera.Project(truth) + Eigen::Vector2d(rng.Normal(noise.sigma_px),
                                                                       rng.Normal(noise.sigma_px));
    const double inverse_depth = 1 / truth.z() + rng.Normal(sigma(truth.z()));
    if (inverse_depth <= 0) continue;
    const Vector3d measured = camera.Unproject(px) / inverse_depth;
    const Vector3d in_cam = noise.cam_from_anchor * measured;
    if (in_cam.z() < kMinDepth) continue;
    const Eigen::Matrix3d rotation = noise.cam_from_anchor.rotation.toRotationMatrix();
    const Eigen::Matrix3d covariance =
        CovarianceFromInverseDepth(camera, measured, noise.sigma_px, sigma(measured.z()));
    return {in_cam, rotation * covariance * rotation.transpose()};
  }
}

CuttingScene MeasureLines(const RectifiedCamera& camera,
                          const EndNoise& noise,
                          std::vector<Segment3> true_lines,
                          Rng& rng) {
  CuttingScene scene;
  scene.problem.camera = camera;
  for (const Segment3& line : true_lines) {
    const MeasuredEnd start = Measure(camera, noise, line.start, rng);
    const MeasuredEnd end = Measure(camera, noise, line.end, rng);
    Segment2 image{camera.Project(line.start), camera.Project(line.end)};
    for (auto* px : {&image.start, &image.end}) {
      *px += Eigen::Vector2d(rng.Normal(kImageSigma), rng.Normal(kImageSigma));
    }
    scene.problem.lines.push_back({{start.point, end.point},
                                   start.covariance,
                                   end.covariance,
                                   LineThrough(image),
                                   kImageSigma});
  }
  scene.true_lines = std::move(true_lines);
  return scene;
}

EndNoise CuboidNoise(const SceneOptions& options, const Rigid3& cam_from_anchor) {
  const double sigma_px = options.noise * CuboidCamera().fx;
  return {cam_from_anchor, sigma_px, options.noise, 0};
}

// The camera at `centre` in the cuboid's frame, the lines in that frame.
CuttingScene SeeCuboid(const SceneOptions& options,
                       const Vector3d& centre,
                       const Vector3d& target,
                       const std::vector<Segment3>& lines,
                       Rng& rng) {
  const auto roll = [&] { return rng.Uniform(0, 2 * std::numbers::pi); };
  const Rigid3 cam_from_cuboid = LookAt(centre, target, roll());
  Rigid3 cam_from_anchor;
  if (options.kind == SceneKind::kInverseDepthPoints) {
    const Vector3d anchor = centre + 0.5 * RandomNormal(rng).normalized();
    cam_from_anchor = cam_from_cuboid * Inverse(LookAt(anchor, target, roll()));
  }
  std::vector<Segment3> in_cam;
  in_cam.reserve(lines.size());
  for (const Segment3& line : lines) in_cam.push_back(Move(cam_from_cuboid, line));
  return MeasureLines(CuboidCamera(), CuboidNoise(options, cam_from_anchor), in_cam, rng);
}

CuttingScene MakeStereoScene(const SceneOptions& options, Rng& rng) {
  const Rigid3 cam_from_earlier{ExpSo3(0.05 * RandomNormal(rng)),
                                0.3 * RandomNormal(rng).normalized()};
  std::vector<Segment3> lines;
  while (lines.size() < static_cast<std::size_t>(options.lines)) {
    const Vector3d start(rng.Uniform(-2, 2), rng.Uniform(-1.5, 1.5), rng.Uniform(2, 7));
    const Vector3d end = start + rng.Uniform(0.5, 2) * RandomNormal(rng).normalized();
    const Segment3 line = Move(cam_from_earlier, {start, end});
    if (std::min({end.z(), line.start.z(), line.end.z()}) > 0.8) lines.push_back(line);
  }
  CuttingScene scene =
      MeasureLines(StereoCamera(), {cam_from_earlier, 1, 0, options.noise}, lines, rng);
  scene.motion = cam_from_earlier.translation.normalized();
  return scene;
}

}  // namespace

CuttingScene MakeCuttingScene(const SceneOptions& options, std::uint64_t index) {
  Rng rng(static_cast<std::uint64_t>(options.lines), NameOf(options.kind), index);
  if (options.kind == SceneKind::kStereo) return MakeStereoScene(options, rng);
  const Vector3d centre = rng.Uniform(3.5, 6) * RandomNormal(rng).normalized();
  const Vector3d target = 0.2 * RandomNormal(rng);
  return SeeCuboid(options, centre, target, CuboidLines(options.lines, rng), rng);
}

CuttingScene MakeEdgeScene(const SceneOptions& options, double angle, std::uint64_t index) {
  Rng rng(static_cast<std::uint64_t>(options.lines), "edge", index);
  std::vector<Segment3> lines = CuboidLines(options.lines, rng);
  lines[0] = {-kHalfCuboid, {kHalfCuboid.x(), -kHalfCuboid.y(), -kHalfCuboid.z()}};
  // Around the middle of the edge, in a plane through it that leaves the cuboid to one side.
  const Vector3d middle = lines[0].Midpoint();
  const Vector3d outwards = Vector3d(0, -1, -1).normalized();
  const Vector3d away = math::Cos(angle) * Vector3d::UnitX() + math::Sin(angle) * outwards;
  // Beside the edge: from exactly ahead it would have no image.
  const Vector3d centre = middle + 4 * away + 0.3 * outwards;
  return SeeCuboid(options, centre, centre - away, lines, rng);
}

}  // namespace plumbline
