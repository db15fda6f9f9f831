// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/synth/texture.h"

#include "plumbline/synth/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

// 1 inside [0, width] of a periodic or plain coordinate, 0 outside.
double Inside(double x, double low, double high) { return x >= low && x <= high ? 1.0 : 0.0; }

double Cell(double x, double size) { return std::floor(x / size); }

double CellValue(double i, double j, std::uint64_t seed) {
  return UnitFromHash(HashCell(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), seed));
}

// Dark or bright dots scattered with one candidate per square of the given size; -1 to 1.
double Specks(double u, double v, double size, double share, std::uint64_t seed) {
  const double i = Cell(u, size), j = Cell(v, size);
  if (CellValue(i, j, seed) > share) return 0;
  const double x = (i + 0.25 + 0.5 * CellValue(i, j, seed + 1)) * size;
  const double y = (j + 0.25 + 0.5 * CellValue(i, j, seed + 2)) * size;
  const double radius = size * (0.08 + 0.17 * CellValue(i, j, seed + 3));
  if (std::hypot(u - x, v - y) > radius) return 0;
  return CellValue(i, j, seed + 4) < 0.7 ? -1 : 1;
}

double Plaster(double u, double v, double tone, std::uint64_t seed) {
  const double clouds = FractalNoise(1.3 * u, 1.3 * v, 3, 0.6, seed);
  const double grain = FractalNoise(14 * u, 14 * v, 4, 0.85, seed + 50);
  const double stain = std::max(0.0, FractalNoise(3 * u, 3 * v, 4, 0.7, seed + 90) - 0.2);
  // Scuffs: short dark scratches where two noises of different direction meet.
  const double scratch = FractalNoise(6 * u + 2 * v, 55 * v - 18 * u, 2, 0.7, seed + 110);
  const double worn = FractalNoise(2 * u, 2 * v, 2, 0.5, seed + 120);
  const double scuff = worn > 0.1 && scratch > 0.45 ? 0.35 : 0.0;
  const double holes = Specks(u, v, 0.045, 0.05, seed + 130);
  return tone * (1 + 0.12 * clouds + 0.16 * grain - 1.1 * stain - scuff + 0.5 * holes);
}

double Grain(double along, double across, std::uint64_t seed) {
  const double rings = FractalNoise(0.9 * along, 22 * across, 4, 0.75, seed);
  const double fibres = FractalNoise(9 * along, 160 * across, 2, 0.8, seed + 40);
  const double knots = Specks(along, 1.6 * across, 0.09, 0.06, seed + 60);
  return 0.42 * rings + 0.2 * fibres - 0.45 * std::abs(knots);
}

double Planks(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kBoard = 0.14, kLength = 1.3, kGap = 0.006;
  const double row = Cell(v, kBoard);
  const double shift = kLength * CellValue(row, 0, seed);
  const double column = Cell(u + shift, kLength);
  const double y = v - row * kBoard, x = u + shift - column * kLength;
  if (y < kGap || x < kGap) return 0.12 * tone;
  const bool nail_row = std::abs(y - 0.25 * kBoard) < 0.006 || std::abs(y - 0.75 * kBoard) < 0.006;
  if (nail_row && (std::abs(x - 0.04) < 0.006 || std::abs(x - kLength + 0.04) < 0.006)) {
    return 0.2 * tone;
  }
  const auto board =
      HashCell(static_cast<std::int64_t>(row), static_cast<std::int64_t>(column), seed);
  return tone * (0.75 + 0.5 * UnitFromHash(board) + Grain(u, v, board));
}

double Tiles(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kTile = 0.30, kGrout = 0.008;
  const double i = Cell(u, kTile), j = Cell(v, kTile);
  const double x = u - i * kTile, y = v - j * kTile;
  const double dirt = FractalNoise(20 * u, 20 * v, 3, 0.9, seed + 7);
  if (x < kGrout || y < kGrout) return tone * (0.35 + 0.15 * dirt);
  const auto tile = HashCell(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), seed);
  const double vein = 1 - std::abs(FractalNoise(5 * u, 5 * v, 4, 0.6, tile));
  const double chips = Specks(u, v, 0.07, 0.4, seed + 9);
  const double dark = UnitFromHash(tile) < 0.2 ? 0.5 : 1.0;
  return tone * dark *
         (0.8 + 0.3 * UnitFromHash(MixBits(tile)) - 0.8 * std::pow(vein, 12) + 0.2 * dirt +
          0.4 * chips);
}

double Carpet(double u, double v, double width, double height, const TextureRecipe& recipe) {
  const double rim = std::min({u, v, width - u, height - v});
  const double yarn = FractalNoise(110 * u, 110 * v, 2, 1.0, recipe.seed);
  const double wear = FractalNoise(3 * u, 3 * v, 4, 0.7, recipe.seed + 20);
  double pattern = 0.7;
  if (rim < 0.05 || Inside(rim, 0.09, 0.11) > 0) {
    pattern = 1.5;
  } else if (rim > 0.16) {
    constexpr double kFigure = 0.12;
    const double i = Cell(u, kFigure), j = Cell(v, kFigure);
    const double x = std::abs(u / kFigure - i - 0.5), y = std::abs(v / kFigure - j - 0.5);
    const double size = 0.2 + 0.3 * CellValue(i, j, recipe.seed + 30);
    if (x + y < size) pattern = CellValue(i, j, recipe.seed + 31) < 0.5 ? 1.6 : 0.25;
  }
  return recipe.tone * (pattern + 0.3 * yarn + 0.35 * wear);
}

// Rows of "words": marks of random width in lines, ragged at the right.
double TextInk(double u, double v, double line, std::uint64_t seed) {
  const double row = Cell(v, line);
  const double y = v / line - row;
  if (y < 0.25 || y > 0.8) return 0;
  const double letter = 0.45 * line;
  const double column = Cell(u, letter);
  if (CellValue(column, row, seed) < 0.22) return 0;  // space between words
  const double x = u / letter - column;
  const double gap = 0.15 + 0.3 * CellValue(column, row, seed + 1);
  const double bar = CellValue(column, row, seed + 2);
  return x > gap && (y > bar || x < gap + 0.3) ? 1 : 0;
}

double Poster(double u, double v, double width, double height, const TextureRecipe& recipe) {
  const std::uint64_t seed = recipe.seed;
  const double rim = std::min({u, v, width - u, height - v});
  if (rim < 0.012) return 0.15;
  double value = std::min(0.95, recipe.tone);
  for (int i = 0; i < 6; ++i) {  // a picture of overlapping blocks and discs in the upper half
    const auto k = seed + 10 * static_cast<std::uint64_t>(i) + 100;
    const double x = width * (0.1 + 0.8 * UnitFromHash(MixBits(k)));
    const double y = height * (0.5 + 0.42 * UnitFromHash(MixBits(k + 1)));
    const double a = width * (0.08 + 0.2 * UnitFromHash(MixBits(k + 2)));
    const double b = height * (0.05 + 0.13 * UnitFromHash(MixBits(k + 3)));
    const bool disc = i % 3 == 2;
    const bool hit =
        disc ? std::hypot(u - x, v - y) < a : std::abs(u - x) < a && std::abs(v - y) < b;
    if (hit && rim > 0.03) value = 0.08 + 0.85 * UnitFromHash(MixBits(k + 4));
  }
  if (v < 0.40 * height && rim > 0.05) {
    const double line = 0.02 + 0.02 * UnitFromHash(MixBits(seed + 3));
    value -= 0.75 * value * TextInk(u, v, line, seed + 4);
  } else if (v < 0.47 * height && v > 0.41 * height && rim > 0.05) {
    value -= 0.8 * value * TextInk(u, v, 0.06 * height, seed + 5);
  }
  return value * (1 + 0.08 * FractalNoise(30 * u, 30 * v, 3, 0.8, seed + 6));
}

double Cardboard(double u, double v, double width, double height, const TextureRecipe& recipe) {
  const double fibres = FractalNoise(12 * u, 40 * v, 4, 0.85, recipe.seed);
  double value = recipe.tone * (1 + 0.3 * fibres + 0.3 * Specks(u, v, 0.04, 0.3, recipe.seed + 3));
  if (std::abs(u - 0.5 * width) < 0.025) value = std::min(1.0, 1.35 * value);  // tape
  const double x = u - 0.1 * width, y = v - 0.15 * height;
  if (x > 0 && x < 0.32 * width && y > 0 && y < 0.3 * height) {
    value = 0.85 - 0.7 * TextInk(x, y, 0.022, recipe.seed + 8);  // label
  }
  return value;
}

double Brick(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kLength = 0.24, kHeight = 0.08, kJoint = 0.011;
  const double row = Cell(v, kHeight);
  const double shift = std::fmod(row, 2.0) != 0 ? 0.5 * kLength : 0;
  const double column = Cell(u + shift, kLength);
  const double wobble = 0.003 * ValueNoise(30 * u, 30 * v, seed + 70);
  const double x = u + shift - column * kLength + wobble, y = v - row * kHeight + wobble;
  const double grain = FractalNoise(45 * u, 45 * v, 4, 0.9, seed);
  if (x < kJoint || y < kJoint) return tone * (1.45 + 0.3 * grain);
  return tone * (0.55 + 0.6 * CellValue(column, row, seed + 1) + 0.5 * grain +
                 0.5 * Specks(u, v, 0.05, 0.5, seed + 2));
}

double Spine(double u, double v, double width, double height, const TextureRecipe& recipe) {
  const double along = v / height;
  double value = recipe.tone * (1 + 0.12 * FractalNoise(40 * u, 40 * v, 3, 0.8, recipe.seed));
  const double band = 0.1 + 0.1 * UnitFromHash(MixBits(recipe.seed + 1));
  const double ink = recipe.tone > 0.45 ? 0.1 : 0.9;
  if (std::abs(along - band) < 0.015 || std::abs(along - 1 + band) < 0.015) return ink;
  // The title runs along the spine.
  if (std::abs(u - 0.5 * width) < 0.32 * width && along > 0.25 && along < 0.75) {
    value += (ink - value) * TextInk(v, u, 0.6 * width, recipe.seed + 5);
  }
  return value;
}

double Metal(double u, double v, double tone, std::uint64_t seed) {
  const double brushed = FractalNoise(3 * u, 90 * v, 3, 0.8, seed);
  const double rust = std::max(0.0, FractalNoise(7 * u, 7 * v, 4, 0.75, seed + 20) - 0.2);
  const double x = u - 0.1 * std::round(u / 0.1), y = v - 0.1 * std::round(v / 0.1);
  const double rivet = std::hypot(x, y) < 0.008 ? 0.5 : 0.0;
  return tone * (1 + 0.2 * brushed - 1.1 * rust + rivet);
}

double Concrete(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kBoard = 1.2, kTie = 0.6;
  const double clouds = FractalNoise(1.1 * u, 1.1 * v, 4, 0.7, seed);
  const double grain = FractalNoise(50 * u, 50 * v, 3, 0.9, seed + 10);
  const double pores = Specks(u, v, 0.03, 0.18, seed + 20);
  const double y = v - kBoard * Cell(v, kBoard);
  const double tie_x = u - kTie * std::round(u / kTie), tie_y = y - 0.5 * kBoard;
  double value = tone * (1 + 0.22 * clouds + 0.12 * grain + 0.35 * std::min(0.0, pores));
  if (y < 0.006) value *= 0.72;                         // joint of the form boards
  if (std::hypot(tie_x, tie_y) < 0.012) value *= 0.45;  // hole of a form tie
  return value;
}

double Fabric(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kThread = 0.004;
  const double weave =
      std::sin(2 * std::numbers::pi * u / kThread) * std::sin(2 * std::numbers::pi * v / kThread);
  const double yarn = FractalNoise(90 * u, 220 * v, 2, 0.9, seed);
  const double folds = FractalNoise(2 * u, 1.2 * v, 3, 0.6, seed + 9);
  return tone * (1 + 0.12 * weave + 0.2 * yarn + 0.18 * folds);
}

double Acoustic(double u, double v, double tone, std::uint64_t seed) {
  const double fissure = FractalNoise(35 * u, 90 * v, 3, 0.7, seed);
  const double dots = Specks(u, v, 0.02, 0.25, seed + 4);
  const double shade = FractalNoise(1.5 * u, 1.5 * v, 2, 0.6, seed + 8);
  return tone * (1 + 0.05 * shade - (fissure > 0.42 ? 0.35 : 0.0) + 0.25 * std::min(0.0, dots));
}

double Screen(double u, double v, double width, double height, const TextureRecipe& recipe) {
  const std::uint64_t seed = recipe.seed;
  const double rim = std::min({u, v, width - u, height - v});
  if (rim < 0.012) return 0.06;
  double value = 0.15 + 0.2 * recipe.tone;
  for (int i = 0; i < 4; ++i) {  // overlapping windows, the last on top
    const auto k = seed + 20 * static_cast<std::uint64_t>(i);
    const double left = width * (0.05 + 0.5 * UnitFromHash(MixBits(k)));
    const double bottom = height * (0.08 + 0.4 * UnitFromHash(MixBits(k + 1)));
    const double right = std::min(width - 0.02, left + width * (0.3 + 0.3 * UnitFromHash(k)));
    const double top = std::min(height - 0.02, bottom + height * 0.5);
    if (u < left || u > right || v < bottom || v > top) continue;
    if (v > top - 0.015) {
      value = 0.45;
    } else {
      const bool dark = UnitFromHash(MixBits(k + 4)) < 0.4;
      const double ink = TextInk(u - left - 0.01, v - bottom, 0.009, k + 5);
      value = dark ? 0.1 + 0.6 * ink : 0.92 - 0.75 * ink;
    }
  }
  return value;
}

// Blobs, strokes and grain at every scale from metres to millimetres.
double Mural(double u, double v, double tone, std::uint64_t seed) {
  double value = tone;
  double size = 1.4;
  for (int octave = 0; octave < 8; ++octave, size *= 0.52) {
    const auto k = seed + 100 * static_cast<std::uint64_t>(octave);
    const double wobble = 0.35 * size * FractalNoise(1.7 * u / size, 1.7 * v / size, 2, 0.6, k);
    const double i = Cell(u + wobble, size), j = Cell(v - wobble, size);
    const double x = (u + wobble) / size - i - 0.5, y = (v - wobble) / size - j - 0.5;
    const double angle = 2 * std::numbers::pi * CellValue(i, j, k + 1);
    const double along = std::cos(angle) * x + std::sin(angle) * y;
    const double across = -std::sin(angle) * x + std::cos(angle) * y;
    const double shape = CellValue(i, j, k + 2);
    const bool inside = shape < 0.35   ? std::hypot(x, y) < 0.35
                        : shape < 0.75 ? std::abs(along) < 0.45 && std::abs(across) < 0.16
                                       : false;
    if (inside) value += (octave < 4 ? 0.4 : 0.26) * (2 * CellValue(i, j, k + 3) - 1);
  }
  return value + 0.08 * FractalNoise(150 * u, 150 * v, 2, 0.9, seed + 7);
}

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

// Bilinear value at (a, b) in [0, 1]^2 of a grid whose outermost values lie on the border.
double LightAt(const Image<float>& light, double a, double b) {
  const double x = a * (light.width() - 1), y = b * (light.height() - 1);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, light.width() - 1), y1 = std::min(y0 + 1, light.height() - 1);
  const double ax = x - x0, ay = y - y0;
  const double top = (1 - ax) * light.at(x0, y0) + ax * light.at(x1, y0);
  const double bottom = (1 - ax) * light.at(x0, y1) + ax * light.at(x1, y1);
  return (1 - ay) * top + ay * bottom;
}

}  // namespace

double EvaluateTexture(
    const TextureRecipe& recipe, double u, double v, double width, double height) {
  if (recipe.sheet_width > 0) {
    u += recipe.sheet_u;
    v += recipe.sheet_v;
    width = recipe.sheet_width;
    height = recipe.sheet_height;
  }
  const double tone = recipe.tone;
  const std::uint64_t seed = MixBits(recipe.seed);
  TextureRecipe mixed = recipe;
  mixed.seed = seed;
  double value = tone;
  switch (recipe.material) {
    case Material::kPaint:
      value = tone * (1 + 0.12 * FractalNoise(8 * u, 8 * v, 4, 0.8, seed) +
                      0.3 * Specks(u, v, 0.05, 0.04, seed + 3));
      break;
    case Material::kPlaster:
      value = Plaster(u, v, tone, seed);
      break;
    case Material::kPlanks:
      value = Planks(u, v, tone, seed);
      break;
    case Material::kWood:
      value = tone * (1 + Grain(u, v, seed));
      break;
    case Material::kTiles:
      value = Tiles(u, v, tone, seed);
      break;
    case Material::kCarpet:
      value = Carpet(u, v, width, height, mixed);
      break;
    case Material::kPoster:
      value = Poster(u, v, width, height, mixed);
      break;
    case Material::kCardboard:
      value = Cardboard(u, v, width, height, mixed);
      break;
    case Material::kBrick:
      value = Brick(u, v, tone, seed);
      break;
    case Material::kSpine:
      value = Spine(u, v, width, height, mixed);
      break;
    case Material::kMetal:
      value = Metal(u, v, tone, seed);
      break;
    case Material::kConcrete:
      value = Concrete(u, v, tone, seed);
      break;
    case Material::kFabric:
      value = Fabric(u, v, tone, seed);
      break;
    case Material::kAcoustic:
      value = Acoustic(u, v, tone, seed);
      break;
    case Material::kScreen:
      value = Screen(u, v, width, height, mixed);
      break;
    case Material::kMural:
      value = Mural(u, v, tone, seed);
      break;
    case Material::kBlank:
      value = tone * (1 + 0.025 * FractalNoise(0.8 * u, 0.8 * v, 3, 0.6, seed) +
                      0.012 * FractalNoise(60 * u, 60 * v, 2, 0.9, seed + 5));
      break;
  }
  const double rim = std::min({u, v, width - u, height - v});
  value *= 1 - recipe.corner_shade * std::exp(-std::max(0.0, rim) / 0.25);
  return std::clamp(value, 0.0, 1.0);
}

Texture Texture::Bake(const TextureRecipe& recipe,
                      double width,
                      double height,
                      double texel,
                      const Image<float>& light) {
  // Multiples of 16: the first four halvings are then exact and keep the texture in place.
  constexpr int kMultiple = 16;
  const auto cells = [texel](double length) {
    return kMultiple * std::max(1, static_cast<int>(std::ceil(length / (texel * kMultiple))));
  };
  const int columns = cells(width), rows = cells(height);
  GrayImage base(columns, rows);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double a = (x + 0.5) / columns, b = (y + 0.5) / rows;
      const double value = EvaluateTexture(recipe, width * a, height * b, width, height);
      base.at(x, y) = static_cast<std::uint8_t>(
          std::lround(255 * std::clamp(value * LightAt(light, a, b), 0.0, 1.0)));
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
