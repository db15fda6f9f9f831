// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/true_lines.h"

#include "plumbline/base/parallel.h"
#include "worlds/collinear.h"
#include "worlds/ray_tracer.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kSameGeometry = 0.001, kSameLine = 0.002;  // metres

struct Candidate {
  TrueLine line;
  int circuit = 0;
};

double ClosestView(const Surface& surface, std::span<const TimedView> views) {
  double closest = 1e9;
  for (const TimedView& view : views) {
    closest = std::min(closest, surface.DistanceTo(view.world_from_camera.translation));
  }
  return closest;
}

// Painted edges of a surface, in the world, without those too short to be seen from anywhere.
std::vector<Segment3> PaintedOn(const Surface& surface,
                                std::span<const TimedView> views,
                                double focal_px,
                                const TrueLineLimits& limits) {
  if (surface.body) return {};
  // At the border of a wide image a line is longer than in the middle, but not twice.
  const double least =
      limits.visibility.min_visible_px * ClosestView(surface, views) / focal_px / 2;
  PaintedEdgeLimits painted = limits.painted;
  painted.min_length = std::max(painted.min_length, least);
  const double width = surface.side_u.norm(), height = surface.side_v.norm();
  if (std::max(width, height) < painted.min_length) return {};
  std::vector<Segment3> edges;
  for (const Segment2& edge : PaintedEdges(surface.texture, width, height, painted)) {
    edges.push_back({surface.PointAt(edge.start.x() / width, edge.start.y() / height),
                     surface.PointAt(edge.end.x() / width, edge.end.y() / height)});
  }
  return edges;
}

// Appends segments that do not lie on an existing line.
void AppendNew(const std::vector<Segment3>& segments,
               TrueLineKind kind,
               double min_length,
               std::vector<Segment3>* all,
               std::vector<Candidate>* candidates) {
  const SegmentGrid grid(*all);
  std::vector<Segment3> added;
  for (const Segment3& segment : segments) {
    for (const Segment3& part : Uncovered(segment, *all, grid, kSameLine, min_length)) {
      added.push_back(part);
      candidates->push_back({{part, kind}});
    }
  }
  all->insert(all->end(), added.begin(), added.end());
}

// For each circuit the frames in which it is at least half bright.
std::vector<std::vector<bool>> FramesOf(const Scene& scene, std::span<const TimedView> views) {
  std::vector<std::vector<bool>> frames(1);  // circuit 0 is always on: no flags
  for (std::size_t k = 1; k <= scene.circuits.size(); ++k) {
    std::vector<bool> on;
    for (const TimedView& view : views) {
      on.push_back(scene.Level(static_cast<int>(k), view.time) >= 0.5);
    }
    frames.push_back(std::move(on));
  }
  return frames;
}

std::vector<Candidate> FindCandidates(const Scene& scene,
                                      std::span<const TimedView> views,
                                      double focal_px,
                                      const RayTracer& tracer,
                                      const TrueLineLimits& limits,
                                      int threads) {
  std::vector<Candidate> candidates;
  const std::vector<Segment3> geometry = JoinCollinear(scene.edges, kSameGeometry);
  candidates.reserve(geometry.size());
  for (const Segment3& edge : geometry) candidates.push_back({{edge, TrueLineKind::kGeometry}});

  std::vector<Segment3> all = geometry, painted;
  const auto by_surface = ParallelMap<std::vector<Segment3>>(
      static_cast<int>(scene.surfaces.size()), threads, [&](int i) {
        return PaintedOn(scene.surfaces[static_cast<std::size_t>(i)], views, focal_px, limits);
      });
  for (const auto& edges : by_surface) painted.insert(painted.end(), edges.begin(), edges.end());
  // Edges continue across the cuts of a wall.
  AppendNew(JoinCollinear(painted, kSameGeometry),
            TrueLineKind::kTexture,
            limits.painted.min_length,
            &all,
            &candidates);

  const auto shadows = ShadowEdges(scene, geometry, tracer, limits.shadows, threads);
  for (std::size_t circuit = 0; circuit <= scene.circuits.size(); ++circuit) {
    std::vector<Segment3> borders;
    for (const ShadowEdge& shadow : shadows) {
      if (shadow.circuit == static_cast<int>(circuit)) borders.push_back(shadow.segment);
    }
    const std::size_t begin = candidates.size();
    AppendNew(JoinCollinear(borders, kSameGeometry),
              TrueLineKind::kShadow,
              limits.shadows.min_length,
              &all,
              &candidates);
    for (std::size_t i = begin; i < candidates.size(); ++i) {
      candidates[i].circuit = static_cast<int>(circuit);
    }
  }
  return candidates;
}

}  // namespace

std::vector<TrueLine> TrueLines(const Scene& scene,
                                const Camera& camera,
                                std::span<const TimedView> views,
                                const TrueLineLimits& limits,
                                int threads) {
  const RayTracer tracer(scene);
  const std::vector<Candidate> candidates =
      FindCandidates(scene, views, camera.intrinsics().fx, tracer, limits, threads);
  // Poses of bodies are computed once a frame, not once a ray.
  std::vector<RayTracer::Moment> moments;
  for (const TimedView& view : views) moments.push_back(tracer.At(view.time));
  const SightTest sees = [&](const Vector3d& from, const Vector3d& to, std::size_t frame) {
    const Eigen::Vector3f a = from.cast<float>(), b = to.cast<float>();
    return tracer.StillSees(a, b, 0) && tracer.BodiesLetPass(a, b, 0, moments[frame]);
  };
  const LineVisibility visibility(camera, views, sees, limits.visibility);
  const std::vector<std::vector<bool>> frames = FramesOf(scene, views);
  const auto trimmed = ParallelMap<std::optional<TrueLine>>(
      static_cast<int>(candidates.size()), threads, [&](int i) {
        const Candidate& candidate = candidates[static_cast<std::size_t>(i)];
        return visibility.Trim(candidate.line, frames[static_cast<std::size_t>(candidate.circuit)]);
      });
  std::vector<TrueLine> lines;
  for (const auto& line : trimmed) {
    if (line) lines.push_back(*line);
  }
  return lines;
}

}  // namespace plumbline
