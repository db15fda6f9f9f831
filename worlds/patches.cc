// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/patches.h"

#include "worlds/marks.h"
#include "worlds/noise.h"
#include "worlds/pattern.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace plumbline {
namespace {

using Eigen::Vector2d;

// Place relative to the centre in units of the half sides.
Vector2d InEllipse(const Patch& patch, const Vector2d& at) {
  return (at - patch.box.center()).cwiseQuotient(0.5 * patch.box.sizes());
}

double Cover(const Patch& patch, const Vector2d& at, const Vector2d& cell) {
  if (!patch.ellipse) {
    return Covered(at.x(), patch.box.min().x(), patch.box.max().x(), cell.x()) *
           Covered(at.y(), patch.box.min().y(), patch.box.max().y(), cell.y());
  }
  const double radius = InEllipse(patch, at).norm();
  if (cell.x() <= 0) return radius <= 1 ? 1 : 0;
  // Distance from the outline, exact for a circle.
  const double inside = (1 - radius) * 0.5 * patch.box.sizes().minCoeff();
  return std::clamp(0.5 + inside / cell.mean(), 0.0, 1.0);
}

double ValueAt(const Patch& patch, const Vector2d& at, double below) {
  double value = patch.stain ? patch.value * below : patch.value;
  if (patch.shade > 0) {
    const Vector2d place = (at - patch.box.min()) * (2.5 / patch.box.sizes().maxCoeff());
    value += patch.shade * FractalNoise(place.x(), place.y(), 5, 0.65, patch.seed);
  }
  if (patch.text) {
    const Vector2d place = at - patch.box.min();
    const double margin = 0.5 * patch.text->line;
    const double width = patch.box.sizes().x() - 2 * margin;
    if (std::min(place.minCoeff(), (patch.box.max() - at).minCoeff()) > margin) {
      const double ink =
          TextInk(place.x() - margin, place.y(), patch.text->line, width, patch.seed + 1);
      value += ink * (patch.text->ink - value);
    }
  }
  return value;
}

// Crossings of the outline of a patch with the line {k-th coordinate free, the other one `fixed`}.
void AppendCrossings(const Patch& patch, int k, double fixed, std::vector<double>* crossings) {
  const int other = 1 - k;
  if (fixed < patch.box.min()(other) || fixed > patch.box.max()(other)) return;
  if (!patch.ellipse) {
    crossings->push_back(patch.box.min()(k));
    crossings->push_back(patch.box.max()(k));
    return;
  }
  const double across = (fixed - patch.box.center()(other)) / (0.5 * patch.box.sizes()(other));
  const double half = 0.5 * patch.box.sizes()(k) * std::sqrt(std::max(0.0, 1 - across * across));
  crossings->push_back(patch.box.center()(k) - half);
  crossings->push_back(patch.box.center()(k) + half);
}

}  // namespace

double PaintPatches(const std::vector<Patch>& patches,
                    const Vector2d& at,
                    double ground,
                    const Vector2d& cell) {
  double value = ground;
  for (const Patch& patch : patches) {
    const double cover = Cover(patch, at, cell);
    if (cover > 0) value += cover * (ValueAt(patch, at, value) - value);
  }
  return value;
}

void AppendPatchEdges(const std::vector<Patch>& patches, std::vector<Segment2>* edges) {
  const auto append_side = [&](std::size_t i, int k, double fixed) {
    const Eigen::AlignedBox2d& box = patches[i].box;
    const double low = box.min()(k), high = box.max()(k);
    std::vector<double> stops{low, high};
    for (std::size_t j = 0; j < patches.size(); ++j) {
      if (j != i) AppendCrossings(patches[j], k, fixed, &stops);
    }
    for (double& stop : stops) stop = std::clamp(stop, low, high);
    std::sort(stops.begin(), stops.end());
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      Segment2 piece;
      piece.start(k) = stops[s];
      piece.end(k) = stops[s + 1];
      piece.start(1 - k) = piece.end(1 - k) = fixed;
      if (piece.Length() < 1e-9) continue;
      const auto later = std::span(patches).subspan(i + 1);
      const bool hidden = std::any_of(later.begin(), later.end(), [&piece](const Patch& patch) {
        return !patch.stain && Cover(patch, piece.Midpoint(), Vector2d::Zero()) > 0;
      });
      if (!hidden) edges->push_back(piece);
    }
  };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i].ellipse) continue;
    const Eigen::AlignedBox2d& box = patches[i].box;
    append_side(i, 0, box.min().y());
    append_side(i, 0, box.max().y());
    append_side(i, 1, box.min().x());
    append_side(i, 1, box.max().x());
  }
}

}  // namespace plumbline
