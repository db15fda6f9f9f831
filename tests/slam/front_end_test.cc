// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/front_end.h"

#include "plumbline/features/orb.h"

#include "tests/support/moving_poster.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(FrontEnd, ExtractsPointsAndLinesWithDisparities) {
  const FrontEnd front_end(MovingPoster::MakeCalibration(), {});
  const ExtractedFrame extracted = front_end.Extract(MovingPoster().Frame(2));
  EXPECT_EQ(extracted.stamp_ns, MovingPoster::StampNs(2));
  EXPECT_EQ(extracted.images.left.width(), MovingPoster::kWidth);
  const Features& features = extracted.indexed->features;
  EXPECT_GT(features.lines.size(), 20U);
  int near = 0;
  for (const auto& disparity : features.point_disparity) {
    near += disparity && std::abs(disparity->px - MovingPoster::kDisparityPx) < 0.5;
  }
  EXPECT_GT(near, 100);
}

TEST(FrontEnd, FindsLinesInTheRightImageWhenAsked) {
  const FrontEnd front_end(MovingPoster::MakeCalibration(), {});
  const ExtractedFrame extracted = front_end.Extract(MovingPoster().Frame(2));
  const auto found = [](const FrameFeatures& indexed) {
    const auto& right = indexed.features.line_right;
    return std::count_if(right.begin(), right.end(), [](const auto& r) { return r.has_value(); });
  };
  EXPECT_EQ(found(*extracted.indexed), 0);
  const auto whole = front_end.WithRightLines(extracted.images, extracted.shed, extracted.indexed);
  EXPECT_EQ(found(*extracted.indexed), 0);  // a copy
  ASSERT_EQ(whole->features.line_right.size(), whole->features.lines.size());
  EXPECT_GT(found(*whole), 15);
  EXPECT_EQ(whole->features.points.size(), extracted.indexed->features.points.size());
  EXPECT_EQ(front_end.WithRightLines(extracted.images, extracted.shed, whole), whole);
}

TEST(FrontEnd, KeepsThePyramidOfASingleCamera) {
  Calibration calibration = MovingPoster::MakeCalibration();
  EXPECT_EQ(FrontEnd(calibration, {}).Extract(MovingPoster().Frame(2)).left_pyramid, nullptr);
  calibration.right.reset();
  SensorFrame frame = MovingPoster().Frame(2);
  frame.right.reset();
  FeatureOptions options;
  options.orb.scale_factor = 1.3;
  const ExtractedFrame extracted = FrontEnd(calibration, options).Extract(std::move(frame));
  ASSERT_NE(extracted.left_pyramid, nullptr);
  const ImagePyramid anew = BuildOrbPyramid(extracted.images.left, options.orb);
  ASSERT_EQ(extracted.left_pyramid->size(), anew.size());
  for (std::size_t i = 0; i < anew.size(); ++i) {
    const PyramidLevel& level = (*extracted.left_pyramid)[i];
    EXPECT_EQ(level.scale, anew[i].scale);
    ASSERT_EQ(level.image.width(), anew[i].image.width());
    ASSERT_EQ(level.image.height(), anew[i].image.height());
    for (int y = 0; y < level.image.height(); ++y) {
      const std::uint8_t* row = level.image.row(y);
      EXPECT_TRUE(std::equal(row, row + level.image.width(), anew[i].image.row(y))) << y;
    }
  }
}

// The mask covers the right half; its edge crosses the picture and is none of the scene.
TEST(FrontEnd, FindsNothingUnderAMask) {
  const FrontEnd front_end(MovingPoster::MakeCalibration(), {});
  SensorFrame frame = MovingPoster().Frame(2);
  const Features whole = front_end.Extract(frame).indexed->features;
  constexpr int kEdge = MovingPoster::kWidth / 2;
  GrayImage mask(MovingPoster::kWidth, MovingPoster::kHeight, 255);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = kEdge; x < mask.width(); ++x) {
      mask.at(x, y) = 0;
      frame.left.at(x, y) = 0;
      frame.right->at(x, y) = 0;
    }
  }
  const auto in_half = [](const Features& features, int side) {
    return std::count_if(features.points.begin(), features.points.end(), [&](const auto& point) {
      return (point.px.x() < kEdge ? 0 : 1) == side;
    });
  };
  EXPECT_GT(in_half(whole, 1), 50);
  frame.left_mask = frame.right_mask = std::make_shared<const GrayImage>(mask);
  const ExtractedFrame extracted = front_end.Extract(frame);
  const Features& masked = extracted.indexed->features;
  EXPECT_GT(in_half(masked, 0), 50);
  for (const PointFeature& point : masked.points) EXPECT_LT(point.px.x(), kEdge - 5);
  const auto on_edge = [](const Features& features) {
    return std::count_if(features.lines.begin(), features.lines.end(), [](const auto& line) {
      return std::max(line.segment.start.x(), line.segment.end.x()) > kEdge - 2;
    });
  };
  EXPECT_EQ(on_edge(masked), 0);
  const auto right = front_end.WithRightLines(extracted.images, extracted.shed, extracted.indexed);
  for (const auto& line : right->features.line_right) {
    EXPECT_FALSE(line && line->segment.start.x() > kEdge);
  }
  // Without the mask its edge is a line.
  frame.left_mask = frame.right_mask = nullptr;
  EXPECT_GT(on_edge(front_end.Extract(frame).indexed->features), 0);
}

TEST(FrontEnd, GivesTheSameFeaturesInEveryThread) {
  const FrontEnd front_end(MovingPoster::MakeCalibration(), {});
  const MovingPoster poster;
  const auto measure = [&] { return front_end.Extract(poster.Frame(1)); };
  auto other = std::async(std::launch::async, measure);
  const ExtractedFrame a = measure();
  const ExtractedFrame b = other.get();
  const auto& points_a = a.indexed->features.points;
  const auto& points_b = b.indexed->features.points;
  ASSERT_EQ(points_a.size(), points_b.size());
  for (std::size_t i = 0; i < points_a.size(); ++i) {
    EXPECT_EQ(points_a[i].px, points_b[i].px);
    EXPECT_EQ(points_a[i].descriptor, points_b[i].descriptor);
  }
}

TEST(FrontEnd, ItsClockGoesOn) {
  const FrontEnd front_end(MovingPoster::MakeCalibration(), {});
  StageClock clock;
  clock.Done("wait");
  ExtractedFrame extracted = front_end.Extract(MovingPoster().Frame(0), clock);
  const std::vector<StageTime> times = extracted.clock.Finish();
  ASSERT_EQ(times.size(), 4U);
  EXPECT_EQ(times[0].stage, "wait");
  EXPECT_EQ(times[1].stage, "rectify");
  EXPECT_EQ(times[2].stage, "features");
  EXPECT_EQ(times[3].stage, "total");
  const double sum = times[0].milliseconds + times[1].milliseconds + times[2].milliseconds;
  EXPECT_NEAR(times[3].milliseconds, sum, 1e-6);
}

}  // namespace
}  // namespace plumbline
