// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/marks.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

double Specks(double u, double v, double size, double share, std::uint64_t seed) {
  const double i = CellIndex(u, size), j = CellIndex(v, size);
  if (CellValue(i, j, seed) > share) return 0;
  const double x = (i + 0.25 + 0.5 * CellValue(i, j, seed + 1)) * size;
  const double y = (j + 0.25 + 0.5 * CellValue(i, j, seed + 2)) * size;
  const double radius = size * (0.08 + 0.17 * CellValue(i, j, seed + 3));
  const double distance = math::Hypot(u - x, v - y) / radius;
  if (distance > 1) return 0;
  const double kind = CellValue(i, j, seed + 4);
  const double strength = 0.3 + 0.7 * CellValue(i, j, seed + 5);
  return (kind < 0.7 ? -strength : strength) * std::min(1.0, 5 * (1 - distance));
}

double TextInk(double u, double v, double line, double width, std::uint64_t seed) {
  const double row = CellIndex(v, line);
  const double y = v / line - row;
  if (y < 0.25 || y > 0.8) return 0;
  const double ragged = CellValue(row, 0, seed + 3);  // most rows are nearly full
  const double end = ragged < 0.12 ? 0 : ragged < 0.35 ? 1.5 * ragged + 0.1 : 0.88 + 0.12 * ragged;
  if (u > end * width) return 0;
  const double letter = 0.45 * line;
  const double column = CellIndex(u, letter);
  if (CellValue(column, row, seed) < 0.22) return 0;  // space between words
  const double x = u / letter - column;
  const double gap = 0.15 + 0.3 * CellValue(column, row, seed + 1);
  const double bar = CellValue(column, row, seed + 2);
  if (x < gap || (y < bar && x > gap + 0.3)) return 0;
  return 0.7 + 0.3 * bar;
}

double WoodGrain(double along, double across, std::uint64_t seed) {
  // The rings of a trunk are not parallel to the saw.
  const double bent =
      across + 0.04 * FractalNoise(1.6 * along, 2.5 * across, 3, 0.6, seed + 20) + 0.02 * along;
  const double rings = FractalNoise(1.8 * along, 14 * bent, 4, 0.55, seed);
  const double fibres = FractalNoise(22 * along, 130 * bent, 2, 0.8, seed + 40);
  const double knots = Specks(along, 1.6 * across, 0.09, 0.06, seed + 60);
  return 0.3 * rings + 0.12 * fibres - 0.45 * std::abs(knots);
}

double Weathering(double u, double v, double strength, std::uint64_t seed) {
  return strength * FractalNoise(0.8 * u, 0.8 * v, 8, 0.62, seed);
}

}  // namespace plumbline
