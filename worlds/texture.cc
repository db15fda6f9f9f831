// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/texture.h"

#include "worlds/surface_pattern.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

GrayImage HalfSize(const GrayImage& image) {
  const int width = std::max(1, image.width() / 2), height = std::max(1, image.height() / 2);
  GrayImage half(width, height);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* a = image.row(std::min(2 * y, image.height() - 1));
    const std::uint8_t* b = image.row(std::min(2 * y + 1, image.height() - 1));
    for (int x = 0; x < width; ++x) {
      const int x0 = std::min(2 * x, image.width() - 1);
      const int x1 = std::min(2 * x + 1, image.width() - 1);
      half.at(x, y) = static_cast<std::uint8_t>((a[x0] + a[x1] + b[x0] + b[x1] + 2) / 4);
    }
  }
  return half;
}

}  // namespace

Texture Texture::Bake(const TextureRecipe& recipe, double width, double height, double texel) {
  // Multiples of 16: the first four halvings are then exact and keep the texture in place.
  constexpr int kMultiple = 16;
  const auto cells = [texel](double length) {
    return kMultiple * std::max(1, static_cast<int>(std::ceil(length / (texel * kMultiple))));
  };
  const int columns = cells(width), rows = cells(height);
  const SurfacePattern surface(recipe, width, height, {width / columns, height / rows});
  GrayImage base(columns, rows);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double a = (x + 0.5) / columns, b = (y + 0.5) / rows;
      const double value = surface.At(width * a, height * b);
      base.at(x, y) = static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
    }
  }
  Texture texture;
  texture.levels_.push_back(std::move(base));
  while (texture.levels_.back().width() > 1 || texture.levels_.back().height() > 1) {
    texture.levels_.push_back(HalfSize(texture.levels_.back()));
  }
  return texture;
}

float Texture::Sample(float u, float v, int level) const {
  const GrayImage& image = levels_[static_cast<std::size_t>(level)];
  const int last_x = image.width() - 1, last_y = image.height() - 1;
  const float x =
      std::clamp(u * static_cast<float>(image.width()) - 0.5F, 0.0F, static_cast<float>(last_x));
  const float y =
      std::clamp(v * static_cast<float>(image.height()) - 0.5F, 0.0F, static_cast<float>(last_y));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, last_x), y1 = std::min(y0 + 1, last_y);
  const float ax = x - static_cast<float>(x0), ay = y - static_cast<float>(y0);
  const std::uint8_t* top = image.row(y0);
  const std::uint8_t* bottom = image.row(y1);
  const float a = static_cast<float>(top[x0]) + ax * static_cast<float>(top[x1] - top[x0]);
  const float b = static_cast<float>(bottom[x0]) + ax * static_cast<float>(bottom[x1] - bottom[x0]);
  return a + ay * (b - a);
}

int Texture::LevelFor(float footprint) const {
  int level = 0;
  while (footprint > 1.5F && level + 1 < static_cast<int>(levels_.size())) {
    footprint *= 0.5F;
    ++level;
  }
  return level;
}

}  // namespace plumbline
