// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/surface_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr int kShades = 12;
constexpr double kLeft = 64, kTop = 40, kSide = 400;
constexpr Figure::Color kMark{213, 30, 0};

// From dark blue to light yellow.
Figure::Color ShadeOf(int shade) {
  const double s = static_cast<double>(shade) / (kShades - 1);
  const auto mix = [&](double from, double to) {
    return static_cast<std::uint8_t>(std::lround(from + s * (to - from)));
  };
  return {mix(20, 255), mix(40, 245), mix(110, 190)};
}

double LowQuantile(const Eigen::MatrixXd& values) {
  std::vector<double> all(values.data(), values.data() + values.size());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 20);
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

// A row of cells, runs of the same shade as one line.
void DrawRow(const Eigen::VectorXi& shades, double y, double cell, Figure& figure) {
  for (Eigen::Index begin = 0; begin < shades.size();) {
    Eigen::Index end = begin;
    while (end < shades.size() && shades(end) == shades(begin)) ++end;
    const double left = kLeft + cell * static_cast<double>(begin);
    const double right = kLeft + cell * static_cast<double>(end);
    figure.lines.push_back({{{left, y}, {right, y}}, ShadeOf(shades(begin)), cell + 0.5});
    begin = end;
  }
}

}  // namespace

Figure SurfacePlot(const Eigen::MatrixXd& values,
                   const Vector2d& marked,
                   const std::string& title,
                   const std::string& label_x,
                   const std::string& label_y) {
  Figure figure;
  figure.width = static_cast<int>(kLeft + kSide + 40);
  figure.height = static_cast<int>(kTop + kSide + 60);
  const double low = LowQuantile(values);
  const double span = std::max(1e-12, values.maxCoeff() - low);
  const double cell = kSide / static_cast<double>(values.rows());
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    const Eigen::VectorXi shades = values.row(row).unaryExpr([&](double value) {
      return std::clamp(static_cast<int>((value - low) / span * kShades), 0, kShades - 1);
    });
    const double y = kTop + kSide - cell * (static_cast<double>(row) + 0.5);
    DrawRow(shades, y, cell, figure);
  }
  FigurePanel panel{kLeft, kTop, kSide, kSide, {}, label_x, label_y, ": " + title};
  panel.range = Eigen::AlignedBox2d(Vector2d(0, 0), Vector2d(1, 1));
  DrawPanel(panel, figure);
  const Vector2d at = panel.ToPixel(marked);
  for (const Vector2d& arm : {Vector2d(7, 7), Vector2d(7, -7)}) {
    figure.lines.push_back({{at - arm, at + arm}, kMark, 3});
  }
  return figure;
}

}  // namespace plumbline
