// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/still_features.h"

#include "plumbline/base/random.h"
#include "plumbline/map/edit.h"

#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kWidth = 640, kHeight = 480;

PointFeature RandomFeature(Rng& rng) {
  PointFeature feature;
  feature.px = {rng.Uniform(0, kWidth), rng.Uniform(0, kHeight)};
  for (auto& word : feature.descriptor) {
    word = static_cast<std::remove_reference_t<decltype(word)>>(rng.Index(1U << 31U));
  }
  return feature;
}

// Keyframes of 500 features, of which all but `still` move by `step_px` from one to the next.
Map MapOf(int keyframes, int still, double step_px) {
  Rng rng(7, "still_features");
  Features features;
  for (int i = 0; i < 500; ++i) features.points.push_back(RandomFeature(rng));
  features.point_disparity.resize(features.points.size());
  const RectifiedCamera camera{
      .fx = 500, .fy = 500, .cx = 320, .cy = 240, .width = kWidth, .height = kHeight};
  Map map;
  for (int k = 0; k < keyframes; ++k) {
    Frame frame;
    frame.id = FrameId{k};
    frame.stamp_ns = k;
    frame.indexed = IndexFeatures(camera, features);
    frame.points.resize(features.points.size());
    const KeyFrameId id = map.NextKeyFrameId();
    map.Apply({edit::AddKeyFrame{{id, KeyFrameId{id.value - 1}, std::move(frame)}}});
    for (std::size_t i = static_cast<std::size_t>(still); i < features.points.size(); ++i) {
      Eigen::Vector2d& px = features.points[i].px;
      px.x() += step_px;
      if (px.x() >= kWidth) {
        features.points[i] = RandomFeature(rng);
        features.points[i].px.x() = 0;
      }
    }
  }
  return map;
}

TEST(FindStillFeatures, TellsTextInAllImages) {
  const StillFeatures still = FindStillFeatures(MapOf(20, 30, 4));
  EXPECT_EQ(still.pairs, 15U);
  EXPECT_EQ(still.with_still, 15U);
  EXPECT_NEAR(still.share, 0.06, 0.01);
  EXPECT_THAT(StillFeaturesNote(still),
              ::testing::Optional(::testing::HasSubstr("6 % of the points stand still")));
}

// Descriptors around thin text are those of the scene behind it.
TEST(StillFeatureFinder, TellsTextBeforeAScene) {
  Rng rng(8, "still_features");
  std::vector<PointFeature> text;
  for (int i = 0; i < 30; ++i) text.push_back(RandomFeature(rng));
  StillFeatureFinder finder;
  for (int k = 0; k < 20; ++k) {
    std::vector<PointFeature> points = text;
    for (PointFeature& feature : points) feature.descriptor = RandomFeature(rng).descriptor;
    while (points.size() < 500) points.push_back(RandomFeature(rng));
    finder.Add(points);
  }
  EXPECT_TRUE(finder.Result().Likely());
  EXPECT_NEAR(finder.Result().share, 0.06, 0.01);
}

// Of many features some lie where others were.
TEST(StillFeatureFinder, KnowsWhatIsThereByChance) {
  Rng rng(9, "still_features");
  StillFeatureFinder finder;
  for (int k = 0; k < 20; ++k) {
    std::vector<PointFeature> points(4000);
    for (PointFeature& feature : points) feature = RandomFeature(rng);
    finder.Add(points);
  }
  EXPECT_EQ(finder.Result().pairs, 15U);
  EXPECT_FALSE(finder.Result().Likely());
}

TEST(StillFeatureFinder, TellsOfImagesWithoutAMap) {
  StillFeatureFinder finder;
  const Map map = MapOf(12, 30, 4);
  for (const auto& [id, keyframe] : map.keyframes()) {
    finder.Add(MeasuredFeatures(*keyframe.frame.indexed).points);
  }
  EXPECT_EQ(finder.Result().pairs, 7U);
  EXPECT_TRUE(finder.Result().Likely());
  finder.Restart();
  finder.Add({});
  EXPECT_EQ(finder.Result().pairs, 7U) << "nothing to compare with";
}

TEST(FindStillFeatures, KnowsASceneThatMovesAndACameraAtRest) {
  EXPECT_FALSE(FindStillFeatures(MapOf(20, 0, 4)).Likely());
  EXPECT_EQ(FindStillFeatures(MapOf(20, 0, 4)).with_still, 0U);
  const StillFeatures rest = FindStillFeatures(MapOf(20, 0, 0));
  EXPECT_EQ(rest.pairs, 0U);
  EXPECT_EQ(StillFeaturesNote(rest), std::nullopt);
  EXPECT_FALSE(FindStillFeatures(MapOf(8, 30, 4)).Likely()) << "too few keyframes";
}

}  // namespace
}  // namespace plumbline
