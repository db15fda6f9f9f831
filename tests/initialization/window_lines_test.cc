// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_lines.h"

#include "tests/initialization/window_scene.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace window_lines_test {

using testing::CurvedMotion;
using testing::MakeWindowScene;
using testing::WindowScene;

constexpr double kMaxChi2 = 9.21;

TEST(TriangulateLines, FindsTheLinesOfTheScene) {
  const WindowScene scene = MakeWindowScene(1, CurvedMotion(3), {.points = 10, .lines = 30});
  const auto lines = TriangulateLines(scene.tracks, scene.truth);
  ASSERT_EQ(lines.size(), 30U);
  int found = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (!lines[k]) continue;  // in an epipolar plane
    ++found;
    EXPECT_LT((lines[k]->moment - scene.truth.lines[k]->moment).norm(), 1e-6) << k;
    EXPECT_LT((lines[k]->direction - scene.truth.lines[k]->direction).norm(), 1e-6) << k;
  }
  EXPECT_GE(found, 28);
}

TEST(EvaluateLines, CountsWhatFits) {
  WindowScene scene =
      MakeWindowScene(2, CurvedMotion(3), {.points = 10, .lines = 10, .wrong_lines = 1});
  scene.tracks.lines.views[0].sigmas[4] = 0;
  scene.truth.lines[7] = std::nullopt;
  const auto fits = EvaluateLines(scene.tracks, scene.truth, kMaxChi2);
  ASSERT_EQ(fits.size(), 10U);
  EXPECT_FALSE(fits[0].fits);
  EXPECT_NEAR(fits[0].cost, kMaxChi2, 1e-9) << "one view of four is wrong";
  EXPECT_EQ(fits[3].freedom, 4);
  EXPECT_EQ(fits[4].freedom, 2) << "one view less";
  EXPECT_LT(fits[3].cost, 1e-12);
  EXPECT_NEAR(fits[7].cost, 4 * kMaxChi2, 1e-9) << "a line without place costs in full";
  EXPECT_EQ(LinesThatFit(scene.tracks, scene.truth),
            (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 8, 9}));
}

TEST(EvaluateLines, MeasuresInStandardDeviations) {
  WindowScene scene = MakeWindowScene(3, CurvedMotion(2), {.points = 10, .lines = 1});
  Segment2& seen = scene.tracks.lines.views[1].segments[0];
  const Eigen::Vector2d along = (seen.end - seen.start).normalized();
  seen.end += 2e-3 * Eigen::Vector2d(-along.y(), along.x());  // two deviations
  EXPECT_NEAR(EvaluateLines(scene.tracks, scene.truth, kMaxChi2)[0].chi2, 4, 1e-6);
  EXPECT_NEAR(MeasurementOf(scene.tracks.lines.views[1], 0, 3).covariance(0, 0), 9e-6, 1e-15);
}

TEST(EvaluateLines, IsEmptyWhereLinesDoNotTakePart) {
  WindowScene scene = MakeWindowScene(4, CurvedMotion(2), {.points = 10, .lines = 3});
  scene.truth.lines.clear();
  EXPECT_TRUE(EvaluateLines(scene.tracks, scene.truth, kMaxChi2).empty());
}

}  // namespace window_lines_test
}  // namespace plumbline
