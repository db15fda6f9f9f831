// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/box_plot.h"

#include <algorithm>
#include <iterator>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr Figure::Color kInk{40, 40, 40}, kBox{0, 114, 178}, kMedian{230, 159, 0};
constexpr double kLeft = 130, kTop = 40, kWidth = 560, kRow = 34;

double At(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

void DrawBox(const FigurePanel& panel, const Box& box, double y, Figure& figure) {
  std::vector<double> sorted = box.values;
  std::sort(sorted.begin(), sorted.end());
  const auto x = [&](double share) { return panel.ToPixel({At(sorted, share), 0}).x(); };
  figure.lines.push_back({{{x(0), y}, {x(1), y}}, kInk, 1.5});
  for (const double end : {0.0, 1.0}) {
    figure.lines.push_back({{{x(end), y - 5}, {x(end), y + 5}}, kInk, 1.5});
  }
  figure.lines.push_back({{{x(0.25), y}, {x(0.75), y}}, kBox, 16});
  figure.lines.push_back({{{x(0.5), y - 8}, {x(0.5), y + 8}}, kMedian, 3});
  figure.texts.push_back({{kLeft - 10, y + 0.35 * kFigureTextSize},
                          box.name,
                          kFigureTextSize,
                          Figure::Anchor::kEnd,
                          kInk});
}

}  // namespace

Figure BoxPlot(const std::string& label, const std::vector<Box>& boxes) {
  Eigen::AlignedBox2d range;
  std::vector<const Box*> shown;
  for (const Box& box : boxes) {
    if (box.values.empty()) continue;
    shown.push_back(&box);
    for (const double value : box.values) range.extend(Vector2d(value, 0));
  }
  Figure figure;
  figure.width = static_cast<int>(kLeft + kWidth + 30);
  const double height = kRow * static_cast<double>(shown.size());
  figure.height = static_cast<int>(kTop + height + 60);
  if (shown.empty()) return figure;
  const double margin = std::max(1e-9, 0.03 * range.sizes().x());
  range.min() -= Vector2d(margin, 0);
  range.max() += Vector2d(margin, 1);
  const FigurePanel panel{kLeft, kTop, kWidth, height, range, label, "", ""};
  // The rows have names in place of numbers.
  Figure frame;
  DrawPanel(panel, frame);
  std::copy_if(
      frame.lines.begin(), frame.lines.end(), std::back_inserter(figure.lines), [](auto& l) {
        return l.points.size() > 2 || l.points.front().x() == l.points.back().x();
      });
  std::copy_if(
      frame.texts.begin(), frame.texts.end(), std::back_inserter(figure.texts), [](auto& t) {
        return t.position.x() >= kLeft - 4;
      });
  for (std::size_t i = 0; i < shown.size(); ++i) {
    DrawBox(panel, *shown[i], kTop + kRow * (static_cast<double>(i) + 0.5), figure);
  }
  return figure;
}

}  // namespace plumbline
