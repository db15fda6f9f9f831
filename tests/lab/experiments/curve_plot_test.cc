// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/curve_plot.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

bool Says(const Figure& figure, const std::string& text) {
  return std::any_of(figure.texts.begin(), figure.texts.end(), [&](const Figure::Text& t) {
    return t.text.find(text) != std::string::npos;
  });
}

// The lines as wide as curves, but the legend's.
std::vector<Figure::Polyline> CurvesOf(const Figure& figure) {
  std::vector<Figure::Polyline> curves;
  for (const Figure::Polyline& line : figure.lines) {
    if (line.width == 2) curves.push_back(line);
  }
  return curves;
}

CurvePanel Panel() {
  return {"synthetic", "seconds", "right [%]", {{"one", {{0, 0}, {1, 50}, {2, 100}}}, {"two", {}}}};
}

TEST(CurvePlot, DrawsThePointsOfACurveToScale) {
  CurvePanel panel = Panel();
  panel.end_y = 200;
  const Figure figure = CurvePlot({panel});
  const auto curves = CurvesOf(figure);
  ASSERT_EQ(curves.size(), 1U);
  const auto& points = curves[0].points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR((points[0] + points[2] - 2 * points[1]).norm(), 0, 1e-9);
  EXPECT_GT(points[2].x(), points[0].x());
  EXPECT_LT(points[2].y(), points[0].y()) << "upwards";
  const auto frame = std::find_if(figure.lines.begin(), figure.lines.end(), [](const auto& line) {
    return line.points.size() == 5;
  });
  ASSERT_NE(frame, figure.lines.end());
  const Vector2d top_left = frame->points[0], bottom_right = frame->points[2];
  EXPECT_NEAR(points[2].x(), bottom_right.x(), 1e-9);
  EXPECT_NEAR(points[2].y(), 0.5 * (top_left.y() + bottom_right.y()), 1e-9);
  for (const char* text : {"one", "two", "synthetic", "seconds", "right [%]"}) {
    EXPECT_TRUE(Says(figure, text)) << text;
  }
}

TEST(CurvePlot, CutsAtTheEndOfTheAxes) {
  CurvePanel panel = Panel();
  panel.end_x = 1.5;
  panel.end_y = 25;
  const auto curves = CurvesOf(CurvePlot({panel}));
  ASSERT_EQ(curves[0].points.size(), 2U) << "what is to the right is left out";
  const auto higher = CurvesOf(CurvePlot({Panel()}));
  EXPECT_LT(curves[0].points[1].y(), higher[0].points[1].y()) << "at the upper edge";
}

TEST(CurvePlot, PanelsStandBelowEachOtherAndEmptyOnesAreLeftOut) {
  CurvePanel empty = Panel();
  empty.curves[0].points.clear();
  const Figure one = CurvePlot({Panel(), empty}), two = CurvePlot({Panel(), Panel()});
  EXPECT_GT(two.height, one.height);
  EXPECT_EQ(CurvesOf(one).size(), 1U);
  const auto curves = CurvesOf(two);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_GT(curves[1].points[2].y(), curves[0].points[0].y());
  EXPECT_EQ(curves[0].color.b, curves[1].color.b);
}

TEST(CurvePlot, CurvesOfOneNameHaveOneColorInAllPanels) {
  CurvePanel first = Panel(), second = Panel();
  second.curves = {{"three", first.curves[0].points}, {"one", first.curves[0].points}};
  const Figure figure = CurvePlot({first, second});
  const auto curves = CurvesOf(figure);
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_EQ(curves[0].color.b, curves[2].color.b);
  EXPECT_NE(curves[0].color.b, curves[1].color.b);
  EXPECT_TRUE(Says(figure, "three")) << "the legend names the curves of all panels";
}

}  // namespace
}  // namespace plumbline
