// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"
#include "plumbline/eval/trajectory_error.h"
#include "plumbline/geometry/segment.h"

#include <optional>
#include <span>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

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

// Returns the two axes with the largest motion of the reference, in their order x, y, z. The third
// one is up in most worlds.
std::pair<int, int> AxesOfMostMotion(std::span<const EvaluatedPose> poses);

// Returns a round distance between grid lines: 1, 2 or 5 times a power of ten, with about `count`
// lines in a span.
double GridStep(double span, int count);

// Returns the part of a segment inside a box (Liang and Barsky, A new concept and method for line
// clipping, 1984).
std::optional<Segment2> Clipped(const Segment2& segment, const Eigen::AlignedBox2d& box);

// Returns a number with at most so many significant digits.
std::string FigureNumber(double value, int digits);

}  // namespace plumbline
