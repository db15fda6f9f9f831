// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/curve_plot.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr Figure::Color kInk{40, 40, 40};
// Told apart by people who confuse red and green as well (Okabe and Ito).
constexpr std::array<Figure::Color, 6> kColors = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};
constexpr double kLeft = 64, kTop = 64, kWidth = 620, kHeight = 240, kGap = 78, kLetter = 7.2;

// The names of the curves of all panels, each once; a name has the same color in all of them.
std::vector<std::string> NamesOfCurves(const std::vector<CurvePanel>& panels) {
  std::vector<std::string> names;
  for (const CurvePanel& panel : panels) {
    for (const Curve& curve : panel.curves) {
      if (std::find(names.begin(), names.end(), curve.name) == names.end()) {
        names.push_back(curve.name);
      }
    }
  }
  return names;
}

Figure::Color ColorOf(const std::string& curve, const std::vector<std::string>& names) {
  const auto at = std::find(names.begin(), names.end(), curve) - names.begin();
  return kColors[static_cast<std::size_t>(at) % kColors.size()];
}

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

// The points up to the right end of the panel; values above its top are drawn at its edge.
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

void DrawLegend(const std::vector<std::string>& names, Figure& figure) {
  double x = kLeft;
  for (const std::string& name : names) {
    figure.lines.push_back({{{x, 24}, {x + 22, 24}}, ColorOf(name, names), 3});
    figure.texts.push_back({{x + 28, 24 + 0.35 * kFigureTextSize},
                            name,
                            kFigureTextSize,
                            Figure::Anchor::kStart,
                            kInk});
    x += 52 + kLetter * static_cast<double>(name.size());
  }
}

bool IsEmpty(const CurvePanel& panel) {
  return std::all_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.points.empty();
  });
}

}  // namespace

Figure CurvePlot(const std::vector<CurvePanel>& panels) {
  const std::vector<std::string> names = NamesOfCurves(panels);
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
    for (const Curve& curve : panel.curves) {
      DrawCurve(curve, frame, panel.dots, ColorOf(curve.name, names), figure);
    }
    top += kHeight + kGap;
  }
  if (!panels.empty()) DrawLegend(names, figure);
  figure.height = static_cast<int>(top);
  return figure;
}

}  // namespace plumbline
