// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/klt_tracks.h"

#include "tests/support/moving_poster.h"
#include "tests/support/synthetic_world.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace klt_tracks_test {

std::shared_ptr<const GrayImage> ImageOf(const MovingPoster& poster, int index) {
  return std::make_shared<const GrayImage>(poster.Frame(index).left);
}

std::vector<Eigen::Vector2d> Places() {
  std::vector<Eigen::Vector2d> places;
  for (int y = 40; y < 270; y += 15) {
    for (int x = 20; x < 380; x += 15) places.emplace_back(x, y);
  }
  return places;
}

TEST(KltTracks, FollowThePicture) {
  const MovingPoster poster;
  const std::vector<Eigen::Vector2d> start = Places();
  KltTracks tracks(ImageOf(poster, 0), {start.begin(), start.end()});
  EXPECT_EQ(tracks.alive(), static_cast<int>(start.size()));
  for (int i = 1; i <= 4; ++i) tracks.Follow(ImageOf(poster, i));
  int right = 0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    if (!tracks.places()[k]) continue;
    const Eigen::Vector2d moved = start[k] - Eigen::Vector2d(4 * MovingPoster::kStepPx, 0);
    right += (*tracks.places()[k] - moved).norm() < 0.5 ? 1 : 0;
  }
  EXPECT_GT(tracks.alive(), static_cast<int>(0.5 * static_cast<double>(start.size())));
  EXPECT_GT(right, 0.9 * tracks.alive());
}

TEST(KltTracks, AHelperChangesNothing) {
  const MovingPoster poster;
  HelperThread helper;
  const std::vector<Eigen::Vector2d> start = Places();
  KltTracks alone(ImageOf(poster, 0), {start.begin(), start.end()});
  KltTracks helped = alone;
  for (int i = 1; i <= 3; ++i) {
    alone.Follow(ImageOf(poster, i));
    helped.Follow(ImageOf(poster, i), &helper);
    EXPECT_EQ(helped.places(), alone.places());
  }
  EXPECT_GT(alone.alive(), 0);
}

TEST(KltTracks, GoOnFromWhereTheyArePut) {
  const MovingPoster poster;
  const Eigen::Vector2d start(150, 150), other(180, 120);
  KltTracks tracks(ImageOf(poster, 0), {start, std::nullopt});
  EXPECT_EQ(tracks.alive(), 1);
  tracks.Correct(1, other);
  tracks.Follow(ImageOf(poster, 1));
  ASSERT_TRUE(tracks.places()[1]);
  EXPECT_LT((*tracks.places()[1] - other + Eigen::Vector2d(MovingPoster::kStepPx, 0)).norm(), 0.5);
}

TEST(KltTracks, AreLostWhereThePictureLeaves) {
  const MovingPoster poster;
  KltTracks tracks(ImageOf(poster, 0), {Eigen::Vector2d(4, 150), Eigen::Vector2d(6, 100)});
  for (int i = 1; i <= 6; ++i) tracks.Follow(ImageOf(poster, i));
  EXPECT_EQ(tracks.alive(), 0);
}

TEST(NearestFeatures, GivesEachFeatureToTheNearest) {
  Features features;
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(50, 50), Eigen::Vector2d(100, 50)}) {
    features.points.push_back({});
    features.points.back().px = px;
  }
  const auto indexed = IndexFeatures(TestCamera(), std::move(features));
  const auto nearest = NearestFeatures(
      *indexed,
      {Eigen::Vector2d(51, 50), Eigen::Vector2d(50.5, 50), std::nullopt, Eigen::Vector2d(102, 50)},
      1.5);
  EXPECT_EQ(nearest, (std::vector<int>{-1, 0, -1, -1}));
}

}  // namespace klt_tracks_test
}  // namespace plumbline
