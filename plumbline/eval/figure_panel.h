// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/eval/figure.h"
#include "plumbline/eval/trajectory_error.h"

#include <span>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

inline constexpr double kFigureTextSize = 13;

// A rectangle of the figure that shows a range of data.
struct FigurePanel {
  double left, top, width, height;  // pixels
  Eigen::AlignedBox2d range;        // data
  std::string label_x, label_y, title;

  Eigen::Vector2d ToPixel(const Eigen::Vector2d& value) const {
    const Eigen::Vector2d share = (value - range.min()).cwiseQuotient(range.sizes());
    return {left + share.x() * width, top + (1 - share.y()) * height};
  }
};

// Adds the panel's border, its grid lines with numbers, its labels and its title.
void DrawPanel(const FigurePanel& panel, Figure& figure);

// The range grown to the shape of a panel, width by height, so that a metre is as long in x as in
// y.
Eigen::AlignedBox2d EqualScale(const Eigen::AlignedBox2d& range, double aspect);

// The two axes in which the reference moves most, in their order x, y, z; the third one is up in
// most worlds.
std::pair<int, int> AxesOfMostMotion(std::span<const EvaluatedPose> poses);

// A pleasing distance between grid lines: 1, 2 or 5 times a power of ten, about `count` in a span.
double GridStep(double span, int count);

// So many significant digits at most.
std::string FigureNumber(double value, int digits);

}  // namespace plumbline
