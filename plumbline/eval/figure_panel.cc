// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/figure_panel.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr Figure::Color kInk{40, 40, 40}, kGrid{222, 222, 222};

}  // namespace

double GridStep(double span, int count) {
  const double rough = std::max(span, 1e-12) / count;
  const double power = math::Pow(10.0, std::floor(math::Log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

void DrawPanel(const FigurePanel& panel, Figure& figure) {
  for (int axis = 0; axis < 2; ++axis) {
    const double low = panel.range.min()(axis), high = panel.range.max()(axis);
    const double step = GridStep(high - low, axis == 0 ? 8 : 5);
    // Few lines, of numbers that are large if a small range is far from 0.
    const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
    for (int k = 0; k <= last - first; ++k) {
      const double i = first + k;
      Vector2d from = panel.range.min(), to = panel.range.max();
      from(axis) = to(axis) = i * step;
      const Vector2d a = panel.ToPixel(from), b = panel.ToPixel(to);
      figure.lines.push_back({{a, b}, kGrid, 1});
      const Vector2d place = axis == 0
                                 ? Vector2d(a.x(), panel.top + panel.height + kFigureTextSize + 3)
                                 : Vector2d(panel.left - 5, a.y() + 0.35 * kFigureTextSize);
      figure.texts.push_back({place,
                              FigureNumber(i * step, 6),
                              kFigureTextSize,
                              axis == 0 ? Figure::Anchor::kMiddle : Figure::Anchor::kEnd,
                              kInk});
    }
  }
  const double right = panel.left + panel.width, bottom = panel.top + panel.height;
  const Vector2d a(panel.left, panel.top), b(right, panel.top), c(right, bottom),
      d(panel.left, bottom);
  figure.lines.push_back({{a, b, c, d, a}, kInk, 1});
  figure.texts.push_back({{panel.left + 0.5 * panel.width, bottom + 2.4 * kFigureTextSize + 3},
                          panel.label_x,
                          kFigureTextSize,
                          Figure::Anchor::kMiddle,
                          kInk});
  figure.texts.push_back({{panel.left, panel.top - 6},
                          panel.label_y + panel.title,
                          kFigureTextSize,
                          Figure::Anchor::kStart,
                          kInk});
}

Eigen::AlignedBox2d EqualScale(const Eigen::AlignedBox2d& range, double aspect) {
  const Vector2d centre = range.center();
  Vector2d size = 1.08 * range.sizes().cwiseMax(Vector2d::Constant(1e-6));
  size.x() = std::max(size.x(), aspect * size.y());
  size.y() = size.x() / aspect;
  return {centre - 0.5 * size, centre + 0.5 * size};
}

std::pair<int, int> AxesOfMostMotion(std::span<const EvaluatedPose> poses) {
  Eigen::AlignedBox3d box;
  for (const EvaluatedPose& pose : poses) box.extend(pose.reference.translation);
  int least = 2;  // if sizes are equal it is z, which is up in most worlds
  for (const int axis : {1, 0}) {
    if (box.sizes()(axis) < box.sizes()(least)) least = axis;
  }
  return {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
}

std::optional<Segment2> Clipped(const Segment2& segment, const Eigen::AlignedBox2d& box) {
  const Vector2d d = segment.end - segment.start;
  double from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = box.min()(axis) - segment.start(axis);
    const double high = box.max()(axis) - segment.start(axis);
    if (d(axis) == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    from = std::max(from, std::min(low / d(axis), high / d(axis)));
    to = std::min(to, std::max(low / d(axis), high / d(axis)));
  }
  if (from > to) return std::nullopt;
  return Segment2{segment.start + from * d, segment.start + to * d};
}

std::string FigureNumber(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

}  // namespace plumbline
