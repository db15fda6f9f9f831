// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/tracks.h"

#include "tests/support/moving_poster.h"
#include "tests/support/synthetic_world.h"
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct Sequence {
  SyntheticWorld world = MakeSyntheticWorld(500, 60);
  Rng rng{3, "frame_window"};
  std::vector<SyntheticFrame> sensed;

  InitializationFrame Next() {
    const int index = static_cast<int>(sensed.size());
    sensed.push_back(Sense(world, PoseOnPath(index), {.depth = false, .noise = 0.2}, rng));
    return {FrameId{index}, index * 50'000'000, sensed.back().indexed, nullptr};
  }
};

TEST(InitializationWindow, SpreadsFramesSinceTheReference) {
  Sequence sequence;
  InitializationWindow window(sequence.world.Imaging(), InitialMatching::kDescriptors);
  EXPECT_TRUE(window.empty());
  for (int i = 0; i < 11; ++i) window.Add(sequence.Next());
  EXPECT_EQ(window.size(), 10);
  EXPECT_EQ(window.reference().id.value, 0);
  EXPECT_EQ(window.SelectFrames(3), (std::vector<int>{2, 6, 9}));
  EXPECT_EQ(window.SelectFrames(10).size(), 10U);
  EXPECT_EQ(window.SelectFrames(20).size(), 10U);
  EXPECT_EQ(window.frame(window.SelectFrames(3).back()).id.value, 10);
}

TEST(InitializationWindow, TracksShowTheSamePoints) {
  Sequence sequence;
  InitializationWindow window(sequence.world.Imaging(), InitialMatching::kDescriptors);
  int matches = 0;
  for (int i = 0; i < 7; ++i) matches = window.Add(sequence.Next());
  EXPECT_GT(matches, 100);
  const std::vector<int> frames = window.SelectFrames(3);
  const FeatureTracks tracks = window.CollectTracks(frames, 80);
  ASSERT_EQ(tracks.size(), 80U);
  const RectifiedCamera& camera = sequence.world.camera;
  double worst = 0;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const auto feature = static_cast<std::size_t>(tracks.features[k]);
    const std::size_t landmark = sequence.sensed[0].point_truth[feature];
    const Eigen::Vector3d& position = sequence.world.points[landmark].position;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!tracks.views[i].Has(k)) continue;
      const Rigid3 pose = PoseOnPath(frames[i] + 1);
      worst = std::max(
          worst, (tracks.views[i].points[k] - (pose * position).hnormalized()).norm() * camera.fx);
    }
  }
  EXPECT_LT(worst, 3) << "px";
  EXPECT_GE(window.PointObservations(frames).size(), 80U);
  for (const FeatureTrack& track : window.LineObservations(frames)) EXPECT_GE(track.size(), 2U);
}

// Returns points all over the image, each found in two octaves.
Features PointsInTwoOctaves() {
  Features features;
  for (int y = 40; y < 270; y += 15) {
    for (int x = 60; x < 380; x += 15) {
      features.points.push_back({});
      features.points.back().px = Eigen::Vector2d(x, y);
      features.points.push_back(features.points.back());
      features.points.back().octave = 1;
      features.points.back().sigma_px = 1.2;
    }
  }
  return features;
}

InitializationFrame PosterFrame(const MovingPoster& poster, int i, Features features) {
  return {FrameId{i},
          i,
          IndexFeatures(TestCamera(), std::move(features)),
          std::make_shared<const GrayImage>(poster.Frame(i).left)};
}

// The poster moves before the camera; the frames have no features of their own.
TEST(InitializationWindow, FollowsPointsOnTheImages) {
  const MovingPoster poster;
  const RectifiedCamera camera = TestCamera();
  Features features = PointsInTwoOctaves();
  InitializationWindow window({camera}, InitialMatching::kImages);
  const auto number = static_cast<int>(features.points.size()) / 2;
  window.Add(PosterFrame(poster, 0, std::move(features)));
  int seen = 0;
  for (int i = 1; i <= 3; ++i) seen = window.Add(PosterFrame(poster, i, {}));
  EXPECT_GT(seen, number / 4);
  EXPECT_LE(seen, number) << "of two octaves one is followed";
  const FeatureTracks tracks = window.CollectTracks({2}, 1000);
  ASSERT_GT(tracks.size(), 0U);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const Eigen::Vector2d moved = tracks.views[0].points[k] - tracks.reference.points[k];
    EXPECT_NEAR(moved.x() * camera.fx, -3 * MovingPoster::kStepPx, 0.2);
    EXPECT_NEAR(moved.y() * camera.fy, 0, 0.2);
  }
}

TEST(InitializationWindow, AHelperChangesNothing) {
  const MovingPoster poster;
  HelperThread helper;
  const auto tracks_with = [&](HelperThread* who) {
    InitializationWindow window({TestCamera()}, InitialMatching::kImages, who);
    window.Add(PosterFrame(poster, 0, PointsInTwoOctaves()));
    for (int i = 1; i <= 3; ++i) window.Add(PosterFrame(poster, i, {}));
    return window.CollectTracks({0, 1, 2}, 1000);
  };
  const FeatureTracks alone = tracks_with(nullptr);
  const FeatureTracks helped = tracks_with(&helper);
  EXPECT_GT(alone.size(), 0U);
  EXPECT_EQ(helped.features, alone.features);
  for (std::size_t i = 0; i < alone.views.size(); ++i) {
    EXPECT_EQ(helped.views[i].points, alone.views[i].points);
    EXPECT_EQ(helped.views[i].sigmas, alone.views[i].sigmas);
  }
}

TEST(InitializationWindow, TakesPointsFromAllOverTheImage) {
  Sequence sequence;
  InitializationWindow window(sequence.world.Imaging(), InitialMatching::kDescriptors);
  for (int i = 0; i < 4; ++i) window.Add(sequence.Next());
  // Cells of a quarter of the image's focal length: 40 points are in more of them than the
  // first 40.
  const auto cells_of = [](std::span<const Eigen::Vector2d> points) {
    std::set<std::pair<int, int>> cells;
    for (const Eigen::Vector2d& p : points) {
      cells.insert(
          {static_cast<int>(std::floor(4 * p.x())), static_cast<int>(std::floor(4 * p.y()))});
    }
    return cells.size();
  };
  const auto spread = window.CollectTracks(window.SelectFrames(3), 40).reference.points;
  const auto all = window.CollectTracks(window.SelectFrames(3), 100000).reference.points;
  ASSERT_EQ(spread.size(), 40U);
  EXPECT_GT(cells_of(spread), cells_of(std::span(all).first(40)) + 2);
}

TEST(InitializationWindow, MovesTheReferenceForward) {
  Sequence sequence;
  InitializationWindow window(sequence.world.Imaging(), InitialMatching::kDescriptors);
  for (int i = 0; i < 9; ++i) window.Add(sequence.Next());
  window.MoveReference();
  EXPECT_EQ(window.reference().id.value, 4);
  EXPECT_EQ(window.size(), 4);
  EXPECT_EQ(window.frame(3).id.value, 8);
  EXPECT_GT(window.PointObservations(window.SelectFrames(3)).size(), 50U);
  window.Reset();
  EXPECT_TRUE(window.empty());
  EXPECT_EQ(window.size(), 0);
}

TEST(InitializationWindow, KeepsEverySecondOfTooMany) {
  Sequence sequence;
  InitializationWindow window(sequence.world.Imaging(), InitialMatching::kDescriptors);
  const InitializationFrame first = sequence.Next();
  window.Add(first);
  for (int i = 0; i < 41; ++i) {
    InitializationFrame frame = first;
    frame.id = FrameId{i + 1};
    window.Add(frame);
  }
  EXPECT_EQ(window.size(), 21);
  EXPECT_EQ(window.frame(20).id.value, 41);
  EXPECT_EQ(window.frame(19).id.value - window.frame(18).id.value, 2);
}

}  // namespace
}  // namespace plumbline
