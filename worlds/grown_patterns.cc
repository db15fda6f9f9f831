// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Materials without straight edges.
#include "plumbline/base/elementary.h"
#include "worlds/marks.h"
#include "worlds/noise.h"
#include "worlds/pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

double Paint(double u, double v, double tone, std::uint64_t seed) {
  return tone * (1 + 0.12 * FractalNoise(8 * u, 8 * v, 4, 0.8, seed) +
                 0.3 * Specks(u, v, 0.05, 0.04, seed + 3));
}

double Plaster(double u, double v, double tone, std::uint64_t seed) {
  const double clouds = FractalNoise(1.3 * u, 1.3 * v, 3, 0.6, seed);
  const double grain = FractalNoise(14 * u, 14 * v, 4, 0.85, seed + 50);
  const double stain = std::max(0.0, FractalNoise(3 * u, 3 * v, 4, 0.7, seed + 90) - 0.2);
  // Scuffs: short dark scratches at the crossings of two noises of different direction.
  const double scratch = FractalNoise(6 * u + 2 * v, 55 * v - 18 * u, 2, 0.7, seed + 110);
  const double worn = FractalNoise(2 * u, 2 * v, 2, 0.5, seed + 120);
  const double scuff =
      2.5 * std::clamp(worn - 0.05, 0.0, 0.3) * std::clamp(4 * (scratch - 0.4), 0.0, 1.0);
  const double holes = Specks(u, v, 0.045, 0.05, seed + 130);
  return tone * (1 + 0.12 * clouds + 0.16 * grain - 1.1 * stain - 0.5 * scuff + 0.5 * holes);
}

double Wood(double u, double v, double tone, std::uint64_t seed) {
  return tone * (1 + WoodGrain(u, v, seed));
}

double Metal(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kRivet = 0.1, kRows = 0.6, kInset = 0.03;  // rows of rivets along both rims
  const double brushed = FractalNoise(5 * u, 70 * v + 4 * u, 3, 0.7, seed);
  const double rust = std::max(0.0, FractalNoise(7 * u, 7 * v, 4, 0.75, seed + 20) - 0.2);
  const double dents = Weathering(u, v, 0.25, seed + 30);
  const double x = u - kRivet * (std::floor(u / kRivet) + 0.5);
  const double y = v - kInset - kRows * std::round((v - kInset) / kRows);
  const double rivet = x * x + y * y < 0.007 * 0.007 ? 0.35 : 0.0;
  return tone * (1 + 0.1 * brushed + dents - 1.1 * rust + rivet);
}

double Fabric(double u, double v, double tone, std::uint64_t seed) {
  constexpr double kThread = 0.004;
  const double weave =
      math::Sin(2 * std::numbers::pi * u / kThread) * math::Sin(2 * std::numbers::pi * v / kThread);
  const double yarn = FractalNoise(90 * u, 220 * v, 2, 0.9, seed);
  const double folds = FractalNoise(3 * u, 1.2 * v, 3, 0.6, seed + 9);
  const double worn = Weathering(u, v, 0.3, seed + 12);
  return tone * (1 + 0.05 * weave + 0.1 * yarn + 0.18 * folds + worn);
}

double Acoustic(double u, double v, double tone, std::uint64_t seed) {
  const double fissure = FractalNoise(35 * u, 90 * v, 3, 0.7, seed);
  const double dots = Specks(u, v, 0.02, 0.25, seed + 4);
  const double shade = Weathering(u, v, 0.25, seed + 8);
  const double crack = std::clamp(5 * (fissure - 0.34), 0.0, 1.0);
  return tone * (1 + shade - 0.3 * crack + 0.2 * std::min(0.0, dots));
}

// Blobs, strokes and grain at every scale from metres to millimetres.
double Mural(double u, double v, double tone, std::uint64_t seed) {
  double value = tone;
  double size = 1.4;
  for (int octave = 0; octave < 8; ++octave, size *= 0.52) {
    const auto k = seed + 100 * static_cast<std::uint64_t>(octave);
    // The finest are too small for their bends to be seen.
    const double bend =
        octave < 6 ? FractalNoise(1.7 * u / size, 1.7 * v / size, octave < 4 ? 2 : 1, 0.6, k) : 0;
    const double wobble = 0.35 * size * bend;
    const double i = CellIndex(u + wobble, size), j = CellIndex(v - wobble, size);
    const double x = (u + wobble) / size - i - 0.5, y = (v - wobble) / size - j - 0.5;
    const double shape = CellValue(i, j, k + 2);
    bool inside = false;
    if (shape < 0.35) {
      inside = x * x + y * y < 0.35 * 0.35;
    } else if (shape < 0.75) {
      const double angle = 2 * std::numbers::pi * CellValue(i, j, k + 1);
      const double c = math::Cos(angle), s = math::Sin(angle);
      inside = std::abs(c * x + s * y) < 0.45 && std::abs(c * y - s * x) < 0.16;
    }
    if (inside) value += (octave < 4 ? 0.4 : 0.26) * (2 * CellValue(i, j, k + 3) - 1);
  }
  return value + 0.08 * FractalNoise(150 * u, 150 * v, 2, 0.9, seed + 7);
}

double Blank(double u, double v, double tone, std::uint64_t seed) {
  return tone * (1 + 0.025 * FractalNoise(0.8 * u, 0.8 * v, 3, 0.6, seed) +
                 0.012 * FractalNoise(60 * u, 60 * v, 2, 0.9, seed + 5));
}

using Reflectance = double (*)(double u, double v, double tone, std::uint64_t seed);

class GrownPattern : public Pattern {
 public:
  GrownPattern(const PatternFrame& frame, Reflectance reflectance)
      : Pattern(frame), reflectance_(reflectance) {}

  double At(double u, double v) const override {
    return reflectance_(u, v, frame_.tone, frame_.seed);
  }

 private:
  Reflectance reflectance_;
};

Reflectance ReflectanceOf(Material material) {
  switch (material) {
    case Material::kPaint:
      return Paint;
    case Material::kPlaster:
      return Plaster;
    case Material::kWood:
      return Wood;
    case Material::kMetal:
      return Metal;
    case Material::kFabric:
      return Fabric;
    case Material::kAcoustic:
      return Acoustic;
    case Material::kMural:
      return Mural;
    case Material::kBlank:
      return Blank;
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<const Pattern> MakeGrownPattern(Material material, const PatternFrame& frame) {
  const Reflectance reflectance = ReflectanceOf(material);
  if (reflectance == nullptr) return nullptr;
  return std::make_unique<GrownPattern>(frame, reflectance);
}

}  // namespace plumbline
