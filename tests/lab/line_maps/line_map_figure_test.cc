// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_figure.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kLeft = 70, kRight = 870;  // of the panels

EvaluatedPose PoseAt(const Eigen::Vector3d& position) {
  EvaluatedPose pose;
  pose.reference.translation = position;
  return pose;
}

std::size_t CountOfColor(const Figure& figure, bool (*is)(const Figure::Color&)) {
  return static_cast<std::size_t>(
      std::count_if(figure.lines.begin(), figure.lines.end(), [is](const Figure::Polyline& line) {
        return is(line.color);
      }));
}

bool IsGreen(const Figure::Color& c) { return c.g > 100 && c.r < 100; }
bool IsRed(const Figure::Color& c) { return c.r > 200 && c.g < 100; }

TEST(LineMapFigure, ColorsWhatHasACounterpartAndCutsOffWhatIsOutside) {
  std::vector<TrueLine> truth(2);
  truth[0].segment = {{0, 0, 0}, {4, 0, 0}};
  truth[1].segment = {{0, 0, 0}, {0, 3, 2}};
  truth[1].visible.emplace();
  const std::vector<Segment3> estimate = {
      {{0, 0, 0}, {4, 0, 0}}, {{1, 1, 1}, {500, 80, 1}}, {{50, 50, 50}, {51, 52, 53}}};
  const LineMapError error = CompareLineMaps(truth, estimate, {}, {});
  const std::vector<EvaluatedPose> poses = {PoseAt({0, 0, 0}), PoseAt({2, 2, 0.1})};
  const Figure figure = LineMapFigure(truth, estimate, error, poses);
  EXPECT_EQ(CountOfColor(figure, IsGreen), 2U);  // from above and from the side
  EXPECT_EQ(CountOfColor(figure, IsRed), 2U);    // the one far away is not there
  for (const Figure::Polyline& line : figure.lines) {
    for (const Eigen::Vector2d& p : line.points) {
      EXPECT_GE(p.x(), kLeft - 1e-9);
      EXPECT_LE(p.x(), kRight + 1e-9);
      EXPECT_GE(p.y(), 40 - 1e-9);
      EXPECT_LE(p.y(), 1090 + 1e-9);
    }
  }
  const auto cut = std::find_if(figure.lines.begin(),
                                figure.lines.end(),
                                [](const Figure::Polyline& line) { return IsRed(line.color); });
  ASSERT_NE(cut, figure.lines.end());
  EXPECT_NEAR(cut->points[1].x(), kRight, 1e-9);
}

TEST(LineMapFigure, LooksAlongTheAxisOfLeastMotion) {
  std::vector<TrueLine> truth(1);
  truth[0].segment = {{0, 1, 0}, {4, 1, 3}};
  const LineMapError error = CompareLineMaps(truth, {}, {}, {});
  const std::vector<EvaluatedPose> poses = {PoseAt({0, 0, 0}), PoseAt({2, 0.1, 2})};
  const Figure figure = LineMapFigure(truth, {}, error, poses);
  std::vector<std::string> labels;
  for (const Figure::Text& text : figure.texts) labels.push_back(text.text);
  EXPECT_THAT(labels, testing::Contains("z [m], from above"));
  EXPECT_THAT(labels, testing::Contains("y [m], from the side"));
}

TEST(LineMapFigure, OfNothingIsEmpty) {
  const LineMapError error = CompareLineMaps({}, {}, {}, {});
  EXPECT_TRUE(LineMapFigure({}, {}, error, {}).lines.empty());
}

}  // namespace
}  // namespace plumbline
