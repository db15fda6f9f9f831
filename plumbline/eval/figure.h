// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A drawing of lines and texts, to be written as SVG or painted as an image. Units: pixels, x
// right, y down.
struct Figure {
  struct Color {
    std::uint8_t r = 0, g = 0, b = 0;
  };
  struct Polyline {
    std::vector<Eigen::Vector2d> points;
    Color color;
    double width = 1;
  };
  enum class Anchor { kStart, kMiddle, kEnd };
  struct Text {
    Eigen::Vector2d position;  // place of the anchor, on the base line
    std::string text;
    double size = 12;  // height of the letters' em
    Anchor anchor = Anchor::kStart;
    Color color;
  };

  int width = 0, height = 0;
  std::vector<Polyline> lines;
  std::vector<Text> texts;
};

// Returns the figure as a self-contained SVG document with white background.
std::string ToSvg(const Figure& figure);

}  // namespace plumbline
