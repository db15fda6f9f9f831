// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

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

// Beginning of what ToSvg writes, and the end of the first two lines; sizes stand in between. They
// tell our drawings from those of other programs.
inline constexpr std::string_view kSvgHead = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"";
inline constexpr std::string_view kSvgGround =
    "font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
// Returns the figure as a self-contained SVG document with white background.
std::string ToSvg(const Figure& figure);

inline constexpr double kFigureTextSize = 13;

// A rectangle of the figure that shows a range of data.
struct FigurePanel {
  double left, top, width, height;  // in pixels
  Eigen::AlignedBox2d range;        // in units of the data
  std::string label_x, label_y, title;

  Eigen::Vector2d ToPixel(const Eigen::Vector2d& value) const {
    const Eigen::Vector2d share = (value - range.min()).cwiseQuotient(range.sizes());
    return {left + share.x() * width, top + (1 - share.y()) * height};
  }
};

// Adds the panel's border, its grid lines with numbers, its labels and its title.
void DrawPanel(const FigurePanel& panel, Figure& figure);

// Returns the range enlarged to the aspect ratio of a panel, width by height, so that x and y have
// equal scales.
Eigen::AlignedBox2d EqualScale(const Eigen::AlignedBox2d& range, double aspect);

// Returns a round distance between grid lines: 1, 2 or 5 times a power of ten, with about `count`
// lines in a span.
double GridStep(double span, int count);

// Returns a number with at most so many significant digits.
std::string FigureNumber(double value, int digits);

}  // namespace plumbline
