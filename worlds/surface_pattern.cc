// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/surface_pattern.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

using Eigen::Vector2d;

SurfacePattern::SurfacePattern(const TextureRecipe& recipe,
                               double width,
                               double height,
                               const Vector2d& cell)
    : corner_(Vector2d::Zero()),
      size_(width, height),
      sheet_(size_),
      corner_shade_(recipe.corner_shade) {
  if (recipe.sheet_width > 0) {
    corner_ = {recipe.sheet_u, recipe.sheet_v};
    sheet_ = {recipe.sheet_width, recipe.sheet_height};
  }
  pattern_ = MakePattern(recipe.material, {recipe.tone, recipe.seed, sheet_.x(), sheet_.y(), cell});
}

double SurfacePattern::At(double u, double v) const {
  const Vector2d place = corner_ + Vector2d(u, v);
  const double value = pattern_->At(place.x(), place.y());
  if (corner_shade_ == 0) return std::clamp(value, 0.0, 1.0);
  const double rim = std::min(place.minCoeff(), (sheet_ - place).minCoeff());
  return std::clamp(value * (1 - corner_shade_ * math::Exp(-std::max(0.0, rim) / 0.25)), 0.0, 1.0);
}

std::vector<Segment2> SurfacePattern::DrawnEdges() const {
  std::vector<Segment2> edges;
  pattern_->AppendEdges({corner_, corner_ + size_}, &edges);
  for (Segment2& edge : edges) edge = {edge.start - corner_, edge.end - corner_};
  return edges;
}

double EvaluateTexture(
    const TextureRecipe& recipe, double u, double v, double width, double height) {
  return SurfacePattern(recipe, width, height).At(u, v);
}

}  // namespace plumbline
