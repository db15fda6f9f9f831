// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_figure.h"

#include "plumbline/base/error.h"
#include "plumbline/report/trajectory_figure.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Figure::Color kTrueColor{130, 130, 130}, kRareColor{215, 215, 215},
    kMatchedColor{20, 140, 50}, kUnmatchedColor{215, 30, 30};

struct ColoredSegment {
  Segment3 segment;
  Figure::Color color;
  double width = 1;
};

// Returns the segments in drawing order: true lines at the back, segments without counterpart in
// front.
std::vector<ColoredSegment> Layers(std::span<const TrueLine> truth,
                                   std::span<const Segment3> estimate,
                                   const LineMapError& error) {
  std::vector<ColoredSegment> layers;
  for (const bool asked : {false, true}) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (error.asked[i] != asked) continue;
      layers.push_back({truth[i].segment, asked ? kTrueColor : kRareColor, 1.0});
    }
  }
  for (const bool matched : {true, false}) {
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      if (error.counterparts[i].has_value() != matched) continue;
      layers.push_back({estimate[i], matched ? kMatchedColor : kUnmatchedColor, 1.2});
    }
  }
  return layers;
}

void DrawView(const std::vector<ColoredSegment>& layers,
              const Eigen::AlignedBox3d& world,
              std::pair<int, int> axes,
              FigurePanel panel,
              Figure& figure) {
  constexpr std::array kNames = {"x", "y", "z"};
  const auto flat = [axes](const Vector3d& p) { return Vector2d(p(axes.first), p(axes.second)); };
  panel.range = EqualScale({flat(world.min()), flat(world.max())}, panel.width / panel.height);
  panel.label_x = std::string(kNames[static_cast<std::size_t>(axes.first)]) + " [m]";
  panel.label_y = std::string(kNames[static_cast<std::size_t>(axes.second)]) + " [m]";
  DrawPanel(panel, figure);
  for (const ColoredSegment& layer : layers) {
    const auto part = Clipped({flat(layer.segment.start), flat(layer.segment.end)}, panel.range);
    if (!part) continue;
    figure.lines.push_back(
        {{panel.ToPixel(part->start), panel.ToPixel(part->end)}, layer.color, layer.width});
  }
}

void DrawLegend(const Vector2d& right, Figure& figure) {
  const std::pair<const char*, Figure::Color> entries[] = {
      {"without", kUnmatchedColor}, {"with counterpart", kMatchedColor}, {"true", kTrueColor}};
  const double widths[] = {72, 140, 0};  // widths of the words, with a gap
  Vector2d place = right;
  for (std::size_t i = 0; i < std::size(entries); ++i) {
    figure.texts.push_back(
        {place, entries[i].first, kFigureTextSize, Figure::Anchor::kEnd, entries[i].second});
    place.x() -= widths[i];
  }
}

}  // namespace

Figure LineMapFigure(std::span<const TrueLine> truth,
                     std::span<const Segment3> estimate,
                     const LineMapError& error,
                     std::span<const EvaluatedPose> poses) {
  constexpr double kLeft = 70, kWidth = 800, kTop = 40;
  PLUMBLINE_CHECK(
      error.asked.size() == truth.size() && error.counterparts.size() == estimate.size(),
      "the result of other lines");
  Figure figure;
  figure.width = 900;
  figure.height = 1140;
  Eigen::AlignedBox3d world;
  for (const TrueLine& line : truth) {
    world.extend(line.segment.start);
    world.extend(line.segment.end);
  }
  if (world.isEmpty()) return figure;
  const std::vector<ColoredSegment> layers = Layers(truth, estimate, error);
  const std::pair<int, int> plan = AxesOfMostMotion(poses);
  const int up = 3 - plan.first - plan.second;
  DrawView(layers, world, plan, {kLeft, kTop, kWidth, 620, {}, {}, {}, ", from above"}, figure);
  DrawView(layers,
           world,
           {plan.first, up},
           {kLeft, 730, kWidth, 360, {}, {}, {}, ", from the side"},
           figure);
  DrawLegend({kLeft + kWidth, kTop - 6}, figure);
  return figure;
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

}  // namespace plumbline
