// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/overlay.h"

#include "plumbline/base/elementary.h"
#include "worlds/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace plumbline {
namespace {

constexpr int kLetters = 18, kRows = 7, kColumns = 5;  // dots of a letter
constexpr std::uint64_t kLetterSeed = 0x1E77E5, kShirtSeed = 0x5417;
constexpr std::uint8_t kWhite = 255;

// The line of letters in an image: dots of whole pixels.
struct TextLine {
  int dot = 1, left = 0, top = 0;

  TextLine(int width, int height)
      : dot(std::max(1, width / 300)),
        left(3 * dot),
        top(std::max(0, height - (kRows + 4) * dot)) {}
  int right() const { return left + kLetters * (kColumns + 1) * dot; }
  int bottom() const { return top + kRows * dot; }
};

// Calls visit(x, y) for the pixels of the line and of a rim of one dot around it.
template <class Visit>
void ForText(const TextLine& line, int width, int height, const Visit& visit) {
  for (int y = std::max(0, line.top - line.dot); y < std::min(height, line.bottom() + line.dot);
       ++y) {
    for (int x = std::max(0, line.left - line.dot); x < std::min(width, line.right() + line.dot);
         ++x) {
      visit(x, y);
    }
  }
}

bool IsInk(const TextLine& line, int x, int y) {
  if (x < line.left || y < line.top || x >= line.right() || y >= line.bottom()) return false;
  const int column = (x - line.left) / line.dot, row = (y - line.top) / line.dot;
  if (column % (kColumns + 1) == kColumns) return false;
  return HashCell(column, row, kLetterSeed) % 2 == 0;
}

// Level of the person at a place relative to its centre, in metres; nullopt beside it.
std::optional<std::uint8_t> PersonAt(double x, double y) {
  constexpr double kPatternCell = 0.05;  // metres, of the pattern of the clothes
  const bool head = math::Hypot(x, (y + 0.72) / 1.25) < 0.11;
  const bool trunk = std::abs(x) < 0.23 && y >= -0.58 && y < 0.05;
  const bool legs = std::abs(x) < 0.2 && std::abs(x) > 0.03 && y >= 0.05 && y < 0.85;
  if (!head && !trunk && !legs) return std::nullopt;
  const auto cell = [](double at) {
    return static_cast<std::int64_t>(std::floor(at / kPatternCell));
  };
  return static_cast<std::uint8_t>(40 + HashCell(cell(x), cell(y), kShirtSeed) % 180);
}

// Calls visit(x, y, level) for the pixels of the person.
template <class Visit>
void ForPerson(const Camera& camera, const Person& person, const Visit& visit) {
  constexpr double kDistance = 2.5, kWalk = 4;  // metres, seconds
  const double phase = std::fmod(person.time, 2 * kWalk);
  if (phase >= kWalk) return;
  const double scale = camera.CentreFocal() / kDistance;  // pixels per metre
  const double centre_x = (phase / kWalk) * camera.width() - person.shift_px;
  const double centre_y = camera.intrinsics().cy + 0.35 * scale;
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      const auto level = PersonAt((x - centre_x) / scale, (y - centre_y) / scale);
      if (level) visit(x, y, *level);
    }
  }
}

}  // namespace

void DrawText(GrayImage& image) {
  const TextLine line(image.width(), image.height());
  ForText(line, image.width(), image.height(), [&](int x, int y) {
    image.at(x, y) = IsInk(line, x, y) ? kWhite : std::uint8_t{0};
  });
}

GrayImage TextMask(int width, int height) {
  GrayImage mask(width, height, kWhite);
  ForText(TextLine(width, height), width, height, [&](int x, int y) { mask.at(x, y) = 0; });
  return mask;
}

void DrawPerson(const Camera& camera, const Person& person, GrayImage& image) {
  ForPerson(camera, person, [&](int x, int y, std::uint8_t level) { image.at(x, y) = level; });
}

GrayImage PersonMask(const Camera& camera, const Person& person) {
  GrayImage mask(camera.width(), camera.height(), kWhite);
  ForPerson(camera, person, [&](int x, int y, std::uint8_t) { mask.at(x, y) = 0; });
  return mask;
}

}  // namespace plumbline
