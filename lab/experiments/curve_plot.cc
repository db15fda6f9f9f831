// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/curve_plot.h"

#include "plumbline/eval/figure_panel.h"

#include <algorithm>
#include <array>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr Figure::Color kInk{40, 40, 40};
// Told apart by people who confuse red and green as well (Okabe and Ito).
constexpr std::array<Figure::Color, 6> kColors = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};
constexpr double kLeft = 64, kTop = 64, kWidth = 620, kHeight = 240, kGap = 78, kLetter = 7.2;

Figure::Color ColorOf(std::size_t curve) { return kColors[curve % kColors.size()]; }

Eigen::AlignedBox2d RangeOf(const CurvePanel& panel) {
  Eigen::AlignedBox2d range(Vector2d::Zero());
  for (const Curve& curve : panel.curves) {
    for (const Vector2d& point : curve.points) range.extend(point);
  }
  Vector2d end = range.max() + Vector2d(0, 0.05 * range.sizes().y());
  if (panel.end_x > 0) end.x() = panel.end_x;
  if (panel.end_y > 0) end.y() = panel.end_y;
  return {range.min(), end.cwiseMax(range.min() + Vector2d::Constant(1e-9))};
}

// The points up to the right end of the panel; what is above it is drawn at its edge.
void DrawCurve(
    const Curve& curve, const FigurePanel& panel, bool dots, Figure::Color color, Figure& figure) {
  Figure::Polyline line{{}, color, 2};
  for (const Vector2d& point : curve.points) {
    if (point.x() > panel.range.max().x()) break;
    line.points.push_back(panel.ToPixel(point.cwiseMin(panel.range.max())));
    if (!dots) continue;
    const Vector2d x(2.5, 0);
    figure.lines.push_back({{line.points.back() - x, line.points.back() + x}, color, 5});
  }
  if (line.points.size() > 1) figure.lines.push_back(std::move(line));
}

void DrawLegend(const std::vector<Curve>& curves, Figure& figure) {
  double x = kLeft;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    figure.lines.push_back({{{x, 24}, {x + 22, 24}}, ColorOf(c), 3});
    figure.texts.push_back({{x + 28, 24 + 0.35 * kFigureTextSize},
                            curves[c].name,
                            kFigureTextSize,
                            Figure::Anchor::kStart,
                            kInk});
    x += 52 + kLetter * static_cast<double>(curves[c].name.size());
  }
}

bool IsEmpty(const CurvePanel& panel) {
  return std::all_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.points.empty();
  });
}

}  // namespace

Figure CurvePlot(const std::vector<CurvePanel>& panels) {
  Figure figure;
  figure.width = static_cast<int>(kLeft + kWidth + 30);
  double top = kTop;
  for (const CurvePanel& panel : panels) {
    if (IsEmpty(panel)) continue;
    FigurePanel frame{kLeft,
                      top,
                      kWidth,
                      kHeight,
                      RangeOf(panel),
                      panel.label_x,
                      panel.label_y,
                      panel.title.empty() ? "" : ": " + panel.title};
    DrawPanel(frame, figure);
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      DrawCurve(panel.curves[c], frame, panel.dots, ColorOf(c), figure);
    }
    top += kHeight + kGap;
  }
  if (!panels.empty()) DrawLegend(panels.front().curves, figure);
  figure.height = static_cast<int>(top);
  return figure;
}

}  // namespace plumbline
