// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/figure.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <utility>

namespace plumbline {
namespace {

using Eigen::Vector2d;

std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

bool HaveOneLook(const Figure::Polyline& a, const Figure::Polyline& b) {
  return a.width == b.width && a.color.r == b.color.r && a.color.g == b.color.g &&
         a.color.b == b.color.b;
}

constexpr Figure::Color kInk{40, 40, 40}, kGrid{222, 222, 222};

}  // namespace

std::string ToSvg(const Figure& figure) {
  std::ostringstream svg;
  svg.imbue(std::locale::classic());
  svg << std::fixed << std::setprecision(1);
  const auto color = [&svg](const Figure::Color& c) -> std::ostream& {
    return svg << "rgb(" << int{c.r} << ',' << int{c.g} << ',' << int{c.b} << ')';
  };
  svg << kSvgHead << figure.width << "\" height=\"" << figure.height << "\" viewBox=\"0 0 "
      << figure.width << ' ' << figure.height << "\" " << kSvgGround;
  // Lines of one look that follow each other are one path, which keeps files of thousands small.
  for (std::size_t i = 0; i < figure.lines.size();) {
    const Figure::Polyline& first = figure.lines[i];
    svg << "<path fill=\"none\" stroke=\"";
    color(first.color) << "\" stroke-width=\"" << first.width << "\" d=\"";
    for (; i < figure.lines.size() && HaveOneLook(figure.lines[i], first); ++i) {
      char command = 'M';
      for (const Vector2d& p : figure.lines[i].points) {
        svg << std::exchange(command, 'L') << p.x() << ',' << p.y();
      }
    }
    svg << "\"/>\n";
  }
  constexpr std::array kAnchors = {"start", "middle", "end"};
  for (const Figure::Text& text : figure.texts) {
    svg << "<text x=\"" << text.position.x() << "\" y=\"" << text.position.y() << "\" font-size=\""
        << text.size << "\" text-anchor=\"" << kAnchors[static_cast<std::size_t>(text.anchor)]
        << "\" fill=\"";
    color(text.color) << "\">" << Escape(text.text) << "</text>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

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

std::string FigureNumber(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

}  // namespace plumbline
