// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/pairwise_initializer.h"

#include "tests/initialization/track_scene.h"
#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CurvedMotion;
using testing::DirectionErrorDeg;
using testing::MakeTrackScene;
using testing::RotationErrorDeg;
using testing::TrackScene;

std::vector<Rigid3> OfUnitLength(std::vector<Rigid3> poses) {
  for (Rigid3& pose : poses) pose.translation.normalize();
  return poses;
}

long Known(const Reconstruction& found) {
  return std::count(found.is_known.begin(), found.is_known.end(), true);
}

// All poses up to one scale, which poses of length one do not have.
void ExpectTrueRatios(const TrackScene& scene, const Reconstruction& found, double tolerance) {
  const auto& truth = scene.truth.cam_from_reference;
  const double scale =
      found.cam_from_reference.back().translation.norm() / truth.back().translation.norm();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((found.cam_from_reference[i].translation / scale - truth[i].translation).norm(),
              tolerance);
  }
}

TEST(FactorizePairwise, FindsTheLengthsOfTranslations) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const auto poses = OfUnitLength(scene.truth.cam_from_reference);
  for (const MissingPlaces missing :
       {MissingPlaces::kInterpolate, MissingPlaces::kLeaveOut, MissingPlaces::kTriangulate}) {
    const auto found = FactorizePairwise(scene.tracks, poses, missing, {});
    ASSERT_TRUE(found) << NameOf(missing);
    ExpectTrueRatios(scene, found->reconstruction, 1e-4);
    // Incomplete points are neither thrown away nor taken for wrong.
    EXPECT_GT(Known(found->reconstruction), 280) << NameOf(missing);
    EXPECT_EQ(found->interpolated > 100, missing == MissingPlaces::kInterpolate);
  }
}

// Missing entries weigh nothing without the loss, too. In the singular vectors alone they would
// count as zero, which shortens the way to a view that misses points.
TEST(FactorizePairwise, MissingEntriesWeighNothingWithoutReweighting) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const auto poses = OfUnitLength(scene.truth.cam_from_reference);
  const auto found =
      FactorizePairwise(scene.tracks, poses, MissingPlaces::kLeaveOut, {.reweighting = 0});
  ASSERT_TRUE(found);
  ExpectTrueRatios(scene, found->reconstruction, 1e-3);
}

TEST(FactorizePairwise, ChainsLengthsWithoutFactorization) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const auto found = FactorizePairwise(scene.tracks,
                                       OfUnitLength(scene.truth.cam_from_reference),
                                       MissingPlaces::kInterpolate,
                                       {.factorize = false});
  ASSERT_TRUE(found);
  ExpectTrueRatios(scene, found->reconstruction, 1e-4);
  EXPECT_EQ(Known(found->reconstruction), 300);
}

// A wrong match lies on both of its interpolated epipolar lines by construction: only the distance
// from the epipolar line tells it, and only before completion.
TEST(FactorizePairwise, AnglesDecideWhatIsInterpolated) {
  const TrackScene scene = MakeTrackScene(2, CurvedMotion(3), {.points = 300, .missed = 0.5});
  const auto poses = OfUnitLength(scene.truth.cam_from_reference);
  const auto all = FactorizePairwise(scene.tracks, poses, MissingPlaces::kInterpolate, {});
  const auto some =
      FactorizePairwise(scene.tracks, poses, MissingPlaces::kInterpolate, {.min_line_angle = 1.2});
  ASSERT_TRUE(all && some);
  EXPECT_LT(some->interpolated, all->interpolated);
}

struct PairwiseRun {
  SyntheticWorld world = MakeSyntheticWorld(600, 80);
  std::vector<InitializationStatus> waits;
  std::optional<InitialMap> map;
  InitializationCounts counts;
};

template <class Pose>
PairwiseRun StartPairwise(const Pose& pose_of, int frames, InitializationOptions options = {}) {
  PairwiseRun run;
  Rng rng(11, "pairwise_initializer");
  options.method = "rank1_pairwise";
  PairwiseInitializer initializer(run.world.Imaging(), options, 1);
  for (int i = 0; i < frames && !run.map; ++i) {
    const SyntheticFrame frame = Sense(run.world, pose_of(i), {.depth = false, .noise = 0.5}, rng);
    auto result = initializer.Add({FrameId{i}, i * 50'000'000, frame.indexed, nullptr});
    EXPECT_EQ(result.map.has_value(), result.wait == InitializationStatus::kNone);
    run.waits.push_back(result.wait);
    run.map = std::move(result.map);
  }
  run.counts = initializer.counts();
  return run;
}

TEST(PairwiseInitializer, StartsFromSuccessiveFrames) {
  const PairwiseRun run = StartPairwise(PoseOnPath, 40);
  ASSERT_TRUE(run.map);
  ASSERT_EQ(run.map->views.size(), 4U);
  for (std::size_t i = 2; i < 4; ++i) {
    EXPECT_EQ(run.map->views[i].frame.id.value, run.map->views[i - 1].frame.id.value + 1);
  }
  const InitialView& newest = run.map->views.back();
  const Rigid3 truth = PoseOnPath(static_cast<int>(newest.frame.id.value)) *
                       Inverse(PoseOnPath(static_cast<int>(run.map->views.front().frame.id.value)));
  EXPECT_LT(RotationErrorDeg(newest.cam_from_world, truth), 1);
  EXPECT_NEAR(MedianDepth(*run.map), 1, 1e-9);
}

// Nothing of the default start takes part.
TEST(PairwiseInitializer, CountsWhatThePaperDoesAndNothingElse) {
  const PairwiseRun run = StartPairwise(PoseOnPath, 40);
  ASSERT_TRUE(run.map);
  const int attempts = run.counts.pairwise_factorizations;
  EXPECT_GE(attempts, 1);
  EXPECT_GE(run.counts.pairwise_poses, 3 * attempts);
  EXPECT_EQ(run.counts.aligned_images, 0);
  EXPECT_EQ(run.counts.model_selections, 0);
  EXPECT_EQ(run.counts.two_view_solutions, 0);
}

TEST(PairwiseInitializer, RepeatsItself) {
  const PairwiseRun a = StartPairwise(PoseOnPath, 40), b = StartPairwise(PoseOnPath, 40);
  ASSERT_TRUE(a.map && b.map);
  ASSERT_EQ(a.map->points.size(), b.map->points.size());
  for (std::size_t i = 0; i < a.map->points.size(); ++i) {
    EXPECT_EQ(a.map->points[i].position, b.map->points[i].position);
  }
}

// Without the adjustment the poses are those of the factorization, and less accurate.
TEST(PairwiseInitializer, LeavesTheAdjustmentOutWhereAskedTo) {
  const PairwiseRun adjusted = StartPairwise(PoseOnPath, 40);
  const PairwiseRun as_found = StartPairwise(PoseOnPath, 40, {.pairwise = {.adjust = false}});
  ASSERT_TRUE(adjusted.map && as_found.map);
  ASSERT_EQ(adjusted.map->views.back().frame.id, as_found.map->views.back().frame.id);
  EXPECT_NEAR(MedianDepth(*as_found.map), 1, 1e-9);
  const auto direction_error = [](const InitialMap& map) {
    const Rigid3 truth = PoseOnPath(static_cast<int>(map.views.back().frame.id.value)) *
                         Inverse(PoseOnPath(static_cast<int>(map.views.front().frame.id.value)));
    return DirectionErrorDeg(map.views.back().cam_from_world, truth);
  };
  EXPECT_LT(direction_error(*adjusted.map), direction_error(*as_found.map));
}

TEST(PairwiseInitializer, WaitsForTheWindow) {
  const PairwiseRun run = StartPairwise(PoseOnPath, 3);
  EXPECT_FALSE(run.map);
  for (const InitializationStatus wait : run.waits)
    EXPECT_EQ(wait, InitializationStatus::kTooFewFrames);
}

}  // namespace
}  // namespace plumbline
