// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/figure.h"

#include <array>
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

}  // namespace

std::string ToSvg(const Figure& figure) {
  std::ostringstream svg;
  svg.imbue(std::locale::classic());
  svg << std::fixed << std::setprecision(1);
  const auto color = [&svg](const Figure::Color& c) -> std::ostream& {
    return svg << "rgb(" << int{c.r} << ',' << int{c.g} << ',' << int{c.b} << ')';
  };
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << figure.width << "\" height=\""
      << figure.height << "\" viewBox=\"0 0 " << figure.width << ' ' << figure.height
      << "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
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

}  // namespace plumbline
