// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/trajectory_figure.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCentimetres = 100;
constexpr Figure::Color kReferenceColor{110, 110, 110}, kErrorColor{30, 90, 180};
// Of the estimates, over and over.
constexpr std::array<Figure::Color, 8> kEstimateColors = {{{200, 60, 30},
                                                           {30, 90, 180},
                                                           {40, 140, 60},
                                                           {150, 70, 170},
                                                           {210, 140, 0},
                                                           {0, 150, 160},
                                                           {200, 70, 130},
                                                           {110, 90, 50}}};
constexpr double kReferenceWidth = 3, kEstimateWidth = 1.3;

// Content of the drawing, in this order, and the origin of time.
struct Drawn {
  std::vector<NamedError> errors;
  std::int64_t begin_ns = 0;

  double Seconds(std::int64_t stamp_ns) const {
    return static_cast<double>(stamp_ns - begin_ns) * 1e-9;
  }
  double End() const {
    double end = 1e-3;
    for (const NamedError& each : errors) {
      end = std::max(end, Seconds(each.error->poses.back().stamp_ns));
    }
    return end;
  }
};

Figure::Color ColorOf(std::size_t estimate) {
  return kEstimateColors[estimate % kEstimateColors.size()];
}

void DrawView(const Drawn& drawn, FigurePanel panel, Figure& figure) {
  constexpr std::array kNames = {"x", "y", "z"};
  const std::pair<int, int> axes = AxesOfMostMotion(drawn.errors.front().error->poses);
  const auto flat = [axes](const Vector3d& p) { return Vector2d(p(axes.first), p(axes.second)); };
  Eigen::AlignedBox2d range;
  for (const NamedError& each : drawn.errors) {
    for (const EvaluatedPose& pose : each.error->poses) {
      range.extend(flat(pose.reference.translation));
      range.extend(flat(pose.estimate.translation));
    }
  }
  panel.range = EqualScale(range, panel.width / panel.height);
  panel.label_x = std::string(kNames[static_cast<std::size_t>(axes.first)]) + " [m]";
  panel.label_y = std::string(kNames[static_cast<std::size_t>(axes.second)]) + " [m]";
  DrawPanel(panel, figure);
  std::vector<Figure::Polyline> estimates;
  for (const NamedError& each : drawn.errors) {
    Figure::Polyline reference{{}, kReferenceColor, kReferenceWidth};
    Figure::Polyline estimate{{}, ColorOf(estimates.size()), kEstimateWidth};
    for (const EvaluatedPose& pose : each.error->poses) {
      reference.points.push_back(panel.ToPixel(flat(pose.reference.translation)));
      estimate.points.push_back(panel.ToPixel(flat(pose.estimate.translation)));
    }
    figure.lines.push_back(std::move(reference));
    estimates.push_back(std::move(estimate));
  }
  for (Figure::Polyline& estimate : estimates) figure.lines.push_back(std::move(estimate));
}

// The names on one line each, above the right end of the view.
void DrawLegend(const Drawn& drawn, double right, double bottom, Figure& figure) {
  double y = bottom - kFigureTextSize * 1.3 * static_cast<double>(drawn.errors.size());
  const auto add = [&](const std::string& name, const Figure::Color& color) {
    figure.texts.push_back({{right, y}, name, kFigureTextSize, Figure::Anchor::kEnd, color});
    y += kFigureTextSize * 1.3;
  };
  add("reference", kReferenceColor);
  for (std::size_t i = 0; i < drawn.errors.size(); ++i) add(drawn.errors[i].name, ColorOf(i));
}

void DrawErrors(const Drawn& drawn, FigurePanel panel, Figure& figure) {
  const bool one = drawn.errors.size() == 1;
  double largest = 1e-6;
  for (const NamedError& each : drawn.errors) {
    largest = std::max(largest, 1.08 * kCentimetres * each.error->ate.max);
  }
  panel.range = {Vector2d(0, 0), Vector2d(drawn.End(), largest)};
  panel.label_x = "time [s]";
  panel.label_y = "position error [cm]";
  if (one) {
    const double rmse = drawn.errors.front().error->ate.rmse;
    panel.title = ", RMSE " + FigureNumber(kCentimetres * rmse, 4) + " cm";
  }
  DrawPanel(panel, figure);
  for (std::size_t i = 0; i < drawn.errors.size(); ++i) {
    Figure::Polyline line{{}, one ? kErrorColor : ColorOf(i), kEstimateWidth};
    for (const EvaluatedPose& pose : drawn.errors[i].error->poses) {
      line.points.push_back(
          panel.ToPixel({drawn.Seconds(pose.stamp_ns), kCentimetres * pose.position_error}));
    }
    figure.lines.push_back(std::move(line));
  }
}

using Coordinate = std::function<double(const Rigid3& world_from_camera)>;
using Series = std::vector<Vector2d>;  // of time and value

// Adds the line of a series. If an angle wraps around its range, the line is broken.
void DrawSeries(const FigurePanel& panel,
                const Series& series,
                double range_of_values,
                Figure::Polyline line,
                Figure& figure) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (i > 0 && std::abs(series[i].y() - series[i - 1].y()) > 0.5 * range_of_values) {
      figure.lines.push_back(line);
      line.points.clear();
    }
    line.points.push_back(panel.ToPixel(series[i]));
  }
  figure.lines.push_back(std::move(line));
}

// Draws one coordinate of the poses over time. `turn`: its period; infinite for a length.
void DrawCoordinate(
    const Drawn& drawn, const Coordinate& of, double turn, FigurePanel panel, Figure& figure) {
  std::vector<Series> references, estimates;
  Eigen::AlignedBox1d range;
  for (const NamedError& each : drawn.errors) {
    Series reference, estimate;
    for (const EvaluatedPose& pose : each.error->poses) {
      const double seconds = drawn.Seconds(pose.stamp_ns);
      reference.emplace_back(seconds, of(pose.reference));
      estimate.emplace_back(seconds, of(pose.estimate));
      for (const Series* series : {&reference, &estimate}) {
        range.extend(Eigen::Matrix<double, 1, 1>(series->back().y()));
      }
    }
    references.push_back(std::move(reference));
    estimates.push_back(std::move(estimate));
  }
  const double middle = range.center()(0);
  const double half = 0.54 * std::max(range.sizes()(0), 1e-6 * std::max(1.0, std::abs(middle)));
  panel.range = {Vector2d(0, middle - half), Vector2d(drawn.End(), middle + half)};
  DrawPanel(panel, figure);
  for (const Series& series : references) {
    DrawSeries(panel, series, turn, {{}, kReferenceColor, kReferenceWidth}, figure);
  }
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    DrawSeries(panel, estimates[i], turn, {{}, ColorOf(i), kEstimateWidth}, figure);
  }
}

// Draws x, y, z on the left and roll, pitch, yaw on the right.
void DrawCoordinates(const Drawn& drawn, const FigurePanel& area, Figure& figure) {
  constexpr std::array kNames = {"x [m]", "y [m]", "z [m]"};
  constexpr std::array kAngles = {"roll [deg]", "pitch [deg]", "yaw [deg]"};
  constexpr double kBetween = 80, kApart = 40, kFullTurn = 360;
  FigurePanel panel = area;
  panel.width = (area.width - kBetween) / 2;
  panel.height = (area.height - 2 * kApart) / 3;
  for (int axis = 0; axis < 3; ++axis) {
    panel.top = area.top + axis * (panel.height + kApart);
    panel.label_x = axis == 2 ? "time [s]" : "";
    panel.left = area.left;
    panel.label_y = kNames[static_cast<std::size_t>(axis)];
    const auto place = [axis](const Rigid3& pose) { return pose.translation(axis); };
    DrawCoordinate(drawn, place, std::numeric_limits<double>::infinity(), panel, figure);
    panel.left = area.left + panel.width + kBetween;
    panel.label_y = kAngles[static_cast<std::size_t>(axis)];
    const auto angle = [axis](const Rigid3& pose) { return RollPitchYawDeg(pose.rotation)(axis); };
    DrawCoordinate(drawn, angle, kFullTurn, panel, figure);
  }
}

}  // namespace

Vector3d RollPitchYawDeg(const Eigen::Quaterniond& rotation) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  return kDegrees * Vector3d(math::Atan2(R(2, 1), R(2, 2)),
                             math::Asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                             math::Atan2(R(1, 0), R(0, 0)));
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

Figure TrajectoryFigure(std::span<const NamedError> errors) {
  constexpr double kLeft = 70, kWidth = 800;
  constexpr double kView = 500, kErrors = 180, kCoordinates = 440, kBetween = 80;
  Drawn drawn;
  for (const NamedError& each : errors) {
    if (!each.error->poses.empty()) drawn.errors.push_back(each);
  }
  Figure figure;
  figure.width = 900;
  double top = 40 + kFigureTextSize * 1.3 * static_cast<double>(drawn.errors.size());
  figure.height = static_cast<int>(top + kView + kErrors + kCoordinates + 2 * kBetween + 60);
  if (drawn.errors.empty()) return figure;
  drawn.begin_ns = drawn.errors.front().error->poses.front().stamp_ns;
  for (const NamedError& each : drawn.errors) {
    drawn.begin_ns = std::min(drawn.begin_ns, each.error->poses.front().stamp_ns);
  }
  DrawLegend(drawn, kLeft + kWidth, top - 6, figure);
  DrawView(drawn, {kLeft, top, kWidth, kView, {}, {}, {}, {}}, figure);
  top += kView + kBetween;
  DrawErrors(drawn, {kLeft, top, kWidth, kErrors, {}, {}, {}, {}}, figure);
  top += kErrors + kBetween;
  DrawCoordinates(drawn, {kLeft, top, kWidth, kCoordinates, {}, {}, {}, {}}, figure);
  return figure;
}

Figure TrajectoryFigure(const TrajectoryError& error) {
  const NamedError one{"estimate", &error};
  return TrajectoryFigure({&one, 1});
}

}  // namespace plumbline
