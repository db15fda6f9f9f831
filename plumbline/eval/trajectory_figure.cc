// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/eval/trajectory_figure.h"

#include "plumbline/eval/figure_panel.h"

#include <algorithm>
#include <array>
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

}  // namespace plumbline
