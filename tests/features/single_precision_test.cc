// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/single_precision.h"

#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SinglePrecision, RoundsAllThatWasMeasured) {
  const double third = 1.0 / 3;
  const Eigen::Vector2d place(100 + third, 200 - third);
  Features f;
  PointFeature point;
  point.px = place;
  point.sigma_px = third;
  f.points = {point, point};
  f.point_disparity = {Disparity{20 + third, third}, std::nullopt};
  LineFeature line;
  line.segment = {place, 2 * place};
  line.sigma_px = line.response = third;
  f.lines = {line, line};
  f.line_right = {std::nullopt, MeasuredSegment{{place, 2 * place}, third}};
  RoundToSinglePrecision(f);
  const double rounded = static_cast<double>(static_cast<float>(third));
  const Eigen::Vector2d at = place.cast<float>().cast<double>();
  EXPECT_NE(rounded, third);
  EXPECT_NE(at, place);
  EXPECT_LT((at - place).norm(), 1e-4);
  EXPECT_EQ(f.points[1].px, at);
  EXPECT_EQ(f.points[1].sigma_px, rounded);
  EXPECT_EQ(f.point_disparity[0]->px, static_cast<double>(static_cast<float>(20 + third)));
  EXPECT_EQ(f.point_disparity[0]->sigma_px, rounded);
  EXPECT_FALSE(f.point_disparity[1]);
  EXPECT_EQ(f.lines[0].segment.start, at);
  EXPECT_EQ(f.lines[0].segment.end, 2 * at);
  EXPECT_EQ(f.lines[0].sigma_px, rounded);
  EXPECT_EQ(f.lines[0].response, rounded);
  EXPECT_EQ(f.line_right[1]->segment.end, 2 * at);
  EXPECT_EQ(f.line_right[1]->sigma_px, rounded);
}

}  // namespace
}  // namespace plumbline
