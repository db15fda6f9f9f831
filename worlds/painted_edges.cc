// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/painted_edges.h"

#include "worlds/surface_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Core>

namespace plumbline {
namespace {

using Eigen::Vector2d;

bool HasStep(const SurfacePattern& pattern,
             const Segment2& piece,
             const PaintedEdgeLimits& limits) {
  constexpr std::array kOffsets{0.0007, 0.0022};  // metres, within the narrowest joint
  const int places = std::clamp(static_cast<int>(piece.Length() / 0.02), 3, 12);
  const Vector2d along = piece.end - piece.start;
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  double left = 0, right = 0;
  for (int i = 0; i < places; ++i) {
    const Vector2d at = piece.start + (i + 0.5) / places * along;
    for (const double offset : kOffsets) {
      const Vector2d a = at + offset * across, b = at - offset * across;
      left += pattern.At(a.x(), a.y());
      right += pattern.At(b.x(), b.y());
    }
  }
  const double count = static_cast<double>(places) * kOffsets.size();
  const double step = std::abs(left - right) / count, mean = 0.5 * (left + right) / count;
  return step >= limits.min_step && step >= limits.min_share * mean;
}

bool NearRim(const Segment2& edge, const Vector2d& size) {
  constexpr double kRim = 0.003;
  for (int k = 0; k < 2; ++k) {
    if (std::max(edge.start(k), edge.end(k)) < kRim) return true;
    if (std::min(edge.start(k), edge.end(k)) > size(k) - kRim) return true;
  }
  return false;
}

// Returns both as one if the second continues the first.
std::optional<Segment2> Joined(const Segment2& first, const Segment2& second, double max_gap) {
  constexpr double kAcross = 1e-6;  // metres
  const Vector2d along = first.Direction();
  if ((second.start - first.end).norm() > max_gap) return std::nullopt;
  for (const Vector2d& end : {second.start, second.end}) {
    const Vector2d offset = end - first.end;
    if (std::abs(along.x() * offset.y() - along.y() * offset.x()) > kAcross) return std::nullopt;
  }
  if (along.dot(second.end - first.end) <= 0) return std::nullopt;
  return Segment2{first.start, second.end};
}

}  // namespace

std::vector<Segment2> PaintedEdges(const TextureRecipe& recipe,
                                   double width,
                                   double height,
                                   const PaintedEdgeLimits& limits) {
  const SurfacePattern pattern(recipe, width, height);
  std::vector<Segment2> edges;
  for (const Segment2& piece : pattern.DrawnEdges()) {
    if (NearRim(piece, {width, height}) || !HasStep(pattern, piece, limits)) continue;
    const auto joined = edges.empty() ? std::nullopt : Joined(edges.back(), piece, limits.max_gap);
    if (joined) {
      edges.back() = *joined;
    } else {
      edges.push_back(piece);
    }
  }
  std::erase_if(edges, [&limits](const Segment2& e) { return e.Length() < limits.min_length; });
  return edges;
}

}  // namespace plumbline
