// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/projected_matches.h"

#include "plumbline/matching/measurements.h"

#include "tests/matching/line_scene.h"
#include "tests/tracking/cut_scene.h"
#include "tests/tracking/matched_frame.h"
#include <optional>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CutScene;
using testing::kExact;
using testing::kSlanted;
using testing::LineScene;

LineSettings Projected(LineWeighting weighting = LineWeighting::kCovariance) {
  const LineOptions options{.residual = "projected_ends", .weighting = weighting};
  return {options, ProductLineMethod(options)};
}

TEST(UseProjectedEnds, FollowsTheWeighting) {
  const LineScene scene(kSlanted, kExact);
  const Eigen::Matrix4d information =
      LineInformation(scene.world.camera, scene.frame, 0, scene.line);
  const auto with = [&](LineWeighting weighting, const std::optional<Eigen::Matrix4d>& known) {
    LineMeasurement m = MeasureLeftLine(scene.frame.features(), 0, weighting);
    UseProjectedEnds(scene.world.camera,
                     scene.cam_from_world,
                     {scene.line, {scene.line.PointAt(-0.3), scene.line.PointAt(1.5)}},
                     known,
                     weighting,
                     m);
    return m.covariance;
  };
  EXPECT_TRUE(with(LineWeighting::kNone, information).isIdentity());
  const Eigen::Matrix2d full = with(LineWeighting::kCovariance, information);
  const Eigen::Matrix2d scalar = with(LineWeighting::kScalar, information);
  const Eigen::Matrix2d exact = with(LineWeighting::kCovariance, std::nullopt);
  EXPECT_NE(full(0, 1), 0);
  EXPECT_TRUE(scalar.isApprox(0.5 * full.trace() * Eigen::Matrix2d::Identity(), 1e-12));
  EXPECT_GT((full - exact).trace(), 0);
  EXPECT_GT((full - exact).determinant(), -1e-9 * full.determinant());
}

TEST(ProjectedMatches, RecoverThePoseAndDropWrongMatches) {
  testing::ExpectPoseWithWrongMatches(Projected(LineWeighting::kNone), 2);
  testing::ExpectPoseWithWrongMatches(Projected(LineWeighting::kCovariance), 2);
  // The mean variance of two projected ends is that of the worse known: its gates are lax.
  testing::ExpectPoseWithWrongMatches(Projected(LineWeighting::kScalar), 8);
}

TEST(ProjectedMatches, KeepThePoseOfExactMeasurementsWhenTheyAreCut) {
  testing::ExpectPoseOfCutLines(Projected().method);
}

TEST(ProjectedMatches, AreCutInTheMapAndNotInTheImage) {
  const CutScene scene(Projected().method);
  const PoseProblem cut = scene.Cut();
  int pieces = 0;
  for (std::size_t i = 0; i < cut.lines.size(); ++i) {
    const PoseProblem::LineMatch& whole = scene.problem.lines[i];
    EXPECT_EQ(cut.lines[i].measurement.segment.start, whole.measurement.segment.start);
    EXPECT_EQ(cut.lines[i].measurement.segment.end, whole.measurement.segment.end);
    pieces += cut.lines[i].ends.Length() < 0.99 * whole.ends.Length();
  }
  EXPECT_GT(pieces, 10);
}

TEST(ProjectedMatches, OfBothImagesAreJudgedTogether) {
  testing::ExpectBothImagesJudgedTogether(Projected().method);
}

TEST(ProjectedMatches, HaveInfiniteChi2BehindTheCamera) {
  const CutScene scene;
  const PoseProblem::LineMatch& match = scene.problem.lines.front();
  EXPECT_NEAR(ProjectedMatchChi2(scene.problem.camera, {}, match), 0, 1e-12);
  const Rigid3 ahead{Eigen::Quaterniond::Identity(), {0, 0, -20}};
  EXPECT_TRUE(std::isinf(ProjectedMatchChi2(scene.problem.camera, ahead, match)));
}

// Of a line that reaches behind the camera the ends are those of the part in front.
TEST(WeighProjectedMatch, TakesTheVisiblePartForEnds) {
  const LineScene scene(kSlanted, kExact);
  PoseProblem problem;
  problem.camera = scene.world.camera;
  LineModel line;
  line.line = LineThroughPoints({0.5, 0.2, -1}, {0.5, 0.2, 6});
  line.start = line.line.ParameterOf({0.5, 0.2, -1});
  line.end = line.line.ParameterOf({0.5, 0.2, 6});
  PoseProblem::LineMatch match{line.line, {}, 0};
  WeighProjectedMatch(problem, line, LineWeighting::kNone, match);
  EXPECT_GT(match.ends.start.z(), 0);
  EXPECT_GT(match.ends.end.z(), 0);
  EXPECT_GT(match.ends.Length(), 1);
}

}  // namespace
}  // namespace plumbline
