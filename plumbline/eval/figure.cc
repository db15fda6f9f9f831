// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/figure.h"

#include "plumbline/eval/figure_panel.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <locale>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Figure::Color kReferenceColor{110, 110, 110}, kEstimateColor{200, 60, 30},
    kErrorColor{30, 90, 180};

void DrawView(const TrajectoryError& error, FigurePanel panel, Figure& figure) {
  constexpr std::array kNames = {"x", "y", "z"};
  const std::pair<int, int> axes = AxesOfMostMotion(error.poses);
  const auto flat = [axes](const Vector3d& p) { return Vector2d(p(axes.first), p(axes.second)); };
  Eigen::AlignedBox2d range;
  for (const EvaluatedPose& pose : error.poses) {
    range.extend(flat(pose.reference.translation));
    range.extend(flat(pose.estimate.translation));
  }
  panel.range = EqualScale(range, panel.width / panel.height);
  panel.label_x = std::string(kNames[static_cast<std::size_t>(axes.first)]) + " [m]";
  panel.label_y = std::string(kNames[static_cast<std::size_t>(axes.second)]) + " [m]";
  DrawPanel(panel, figure);
  Figure::Polyline reference{{}, kReferenceColor, 3}, estimate{{}, kEstimateColor, 1.3};
  for (const EvaluatedPose& pose : error.poses) {
    reference.points.push_back(panel.ToPixel(flat(pose.reference.translation)));
    estimate.points.push_back(panel.ToPixel(flat(pose.estimate.translation)));
  }
  figure.lines.push_back(std::move(reference));
  figure.lines.push_back(std::move(estimate));
  const double right = panel.left + panel.width;
  figure.texts.push_back({{right - 80, panel.top - 6},
                          "reference",
                          kFigureTextSize,
                          Figure::Anchor::kEnd,
                          kReferenceColor});
  figure.texts.push_back(
      {{right, panel.top - 6}, "estimate", kFigureTextSize, Figure::Anchor::kEnd, kEstimateColor});
}

void DrawErrors(const TrajectoryError& error, FigurePanel panel, Figure& figure) {
  constexpr double kCentimetres = 100;
  const std::int64_t begin = error.poses.front().stamp_ns;
  const auto seconds = [begin](std::int64_t stamp) {
    return static_cast<double>(stamp - begin) * 1e-9;
  };
  panel.range = {Vector2d(0, 0),
                 Vector2d(std::max(1e-3, seconds(error.poses.back().stamp_ns)),
                          std::max(1e-6, 1.08 * kCentimetres * error.ate.max))};
  panel.label_x = "time [s]";
  panel.label_y = "position error [cm]";
  panel.title = ", RMSE " + FigureNumber(kCentimetres * error.ate.rmse, 4) + " cm";
  DrawPanel(panel, figure);
  Figure::Polyline line{{}, kErrorColor, 1.3};
  for (const EvaluatedPose& pose : error.poses) {
    line.points.push_back(
        panel.ToPixel({seconds(pose.stamp_ns), kCentimetres * pose.position_error}));
  }
  figure.lines.push_back(std::move(line));
}

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

Figure TrajectoryFigure(const TrajectoryError& error) {
  constexpr double kLeft = 70, kWidth = 800;
  Figure figure;
  figure.width = 900;
  figure.height = 860;
  if (error.poses.empty()) return figure;
  DrawView(error, {kLeft, 40, kWidth, 500, {}, {}, {}, {}}, figure);
  DrawErrors(error, {kLeft, 620, kWidth, 180, {}, {}, {}, {}}, figure);
  return figure;
}

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
