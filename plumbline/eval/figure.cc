// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/figure.h"

#include <array>
#include <iomanip>
#include <locale>
#include <sstream>

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

}  // namespace

std::string ToSvg(const Figure& figure) {
  std::ostringstream svg;
  svg.imbue(std::locale::classic());
  svg << std::fixed << std::setprecision(2);
  const auto color = [&svg](const Figure::Color& c) -> std::ostream& {
    return svg << "rgb(" << int{c.r} << ',' << int{c.g} << ',' << int{c.b} << ')';
  };
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << figure.width << "\" height=\""
      << figure.height << "\" viewBox=\"0 0 " << figure.width << ' ' << figure.height
      << "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (const Figure::Polyline& line : figure.lines) {
    svg << "<polyline fill=\"none\" stroke=\"";
    color(line.color) << "\" stroke-width=\"" << line.width << "\" points=\"";
    for (const Vector2d& p : line.points) svg << p.x() << ',' << p.y() << ' ';
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
