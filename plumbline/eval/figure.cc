// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Figure::Color kInk{40, 40, 40}, kGrid{222, 222, 222}, kReferenceColor{110, 110, 110},
    kEstimateColor{200, 60, 30}, kErrorColor{30, 90, 180};
constexpr double kTextSize = 13;

std::string Number(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits) << value;
  return text.str();
}

// A pleasing distance between grid lines: 1, 2 or 5 times a power of ten, about `count` in a span.
double GridStep(double span, int count) {
  const double rough = std::max(span, 1e-12) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

// A rectangle of the figure that shows a range of data.
struct Panel {
  double left, top, width, height;  // pixels
  Eigen::AlignedBox2d range;        // data
  std::string label_x, label_y, title;

  Vector2d ToPixel(const Vector2d& value) const {
    const Vector2d share = (value - range.min()).cwiseQuotient(range.sizes());
    return {left + share.x() * width, top + (1 - share.y()) * height};
  }
};

void DrawFrame(const Panel& panel, Figure& figure) {
  for (int axis = 0; axis < 2; ++axis) {
    const double low = panel.range.min()(axis), high = panel.range.max()(axis);
    const double step = GridStep(high - low, axis == 0 ? 8 : 5);
    const auto first = static_cast<int>(std::ceil(low / step - 1e-9));
    const auto last = static_cast<int>(std::floor(high / step + 1e-9));
    for (int i = first; i <= last; ++i) {
      Vector2d from = panel.range.min(), to = panel.range.max();
      from(axis) = to(axis) = i * step;
      const Vector2d a = panel.ToPixel(from), b = panel.ToPixel(to);
      figure.lines.push_back({{a, b}, kGrid, 1});
      const Vector2d place = axis == 0 ? Vector2d(a.x(), panel.top + panel.height + kTextSize + 3)
                                       : Vector2d(panel.left - 5, a.y() + 0.35 * kTextSize);
      figure.texts.push_back({place,
                              Number(i * step, 6),
                              kTextSize,
                              axis == 0 ? Figure::Anchor::kMiddle : Figure::Anchor::kEnd,
                              kInk});
    }
  }
  const double right = panel.left + panel.width, bottom = panel.top + panel.height;
  const Vector2d a(panel.left, panel.top), b(right, panel.top), c(right, bottom),
      d(panel.left, bottom);
  figure.lines.push_back({{a, b, c, d, a}, kInk, 1});
  figure.texts.push_back({{panel.left + 0.5 * panel.width, bottom + 2.4 * kTextSize + 3},
                          panel.label_x,
                          kTextSize,
                          Figure::Anchor::kMiddle,
                          kInk});
  figure.texts.push_back({{panel.left, panel.top - 6},
                          panel.label_y + panel.title,
                          kTextSize,
                          Figure::Anchor::kStart,
                          kInk});
}

// The two axes in which the reference moves most, in their order x, y, z.
std::pair<int, int> ViewAxes(const std::vector<EvaluatedPose>& poses) {
  Eigen::AlignedBox3d box;
  for (const EvaluatedPose& pose : poses) box.extend(pose.reference.translation);
  int least = 2;  // on equal terms z, which is up in most worlds
  for (const int axis : {1, 0}) {
    if (box.sizes()(axis) < box.sizes()(least)) least = axis;
  }
  return {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
}

// Grows the range to the shape of the panel, so that a metre is as long in x as in y.
Eigen::AlignedBox2d EqualScale(const Eigen::AlignedBox2d& range, double aspect) {
  const Vector2d centre = range.center();
  Vector2d size = 1.08 * range.sizes().cwiseMax(Vector2d::Constant(1e-6));
  size.x() = std::max(size.x(), aspect * size.y());
  size.y() = size.x() / aspect;
  return {centre - 0.5 * size, centre + 0.5 * size};
}

void DrawView(const TrajectoryError& error, Panel panel, Figure& figure) {
  constexpr std::array kNames = {"x", "y", "z"};
  const std::pair<int, int> axes = ViewAxes(error.poses);
  const auto flat = [axes](const Vector3d& p) { return Vector2d(p(axes.first), p(axes.second)); };
  Eigen::AlignedBox2d range;
  for (const EvaluatedPose& pose : error.poses) {
    range.extend(flat(pose.reference.translation));
    range.extend(flat(pose.estimate.translation));
  }
  panel.range = EqualScale(range, panel.width / panel.height);
  panel.label_x = std::string(kNames[static_cast<std::size_t>(axes.first)]) + " [m]";
  panel.label_y = std::string(kNames[static_cast<std::size_t>(axes.second)]) + " [m]";
  DrawFrame(panel, figure);
  Figure::Polyline reference{{}, kReferenceColor, 3}, estimate{{}, kEstimateColor, 1.3};
  for (const EvaluatedPose& pose : error.poses) {
    reference.points.push_back(panel.ToPixel(flat(pose.reference.translation)));
    estimate.points.push_back(panel.ToPixel(flat(pose.estimate.translation)));
  }
  figure.lines.push_back(std::move(reference));
  figure.lines.push_back(std::move(estimate));
  const double right = panel.left + panel.width;
  figure.texts.push_back(
      {{right - 80, panel.top - 6}, "reference", kTextSize, Figure::Anchor::kEnd, kReferenceColor});
  figure.texts.push_back(
      {{right, panel.top - 6}, "estimate", kTextSize, Figure::Anchor::kEnd, kEstimateColor});
}

void DrawErrors(const TrajectoryError& error, Panel panel, Figure& figure) {
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
  panel.title = ", RMSE " + Number(kCentimetres * error.ate.rmse, 4) + " cm";
  DrawFrame(panel, figure);
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
