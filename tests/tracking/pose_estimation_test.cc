// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_estimation.h"

#include "tests/tracking/matched_frame.h"
#include <algorithm>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CountWrongLeft;
using testing::Disturbed;
using testing::ExpectNear;
using testing::MatchedFrame;

TEST(EstimatePose, RecoversThePoseAndDropsWrongMatches) {
  for (const auto weighting :
       {LineWeighting::kNone, LineWeighting::kScalar, LineWeighting::kCovariance}) {
    testing::ExpectPoseWithWrongMatches({.weighting = weighting}, 2);
  }
}

TEST(EstimatePose, WorksWithPointsOrLinesAlone) {
  MatchedFrame points(0);
  std::fill(points.association.matches.line_of_feature.begin(),
            points.association.matches.line_of_feature.end(),
            -1);
  const PoseEstimate from_points =
      PoseEstimator(points.world.camera, {}, {})
          .Estimate(
              points.sensed.indexed->features, Disturbed(points.pose), {}, points.association);
  EXPECT_TRUE(from_points.converged);
  EXPECT_EQ(from_points.inlier_lines, 0);
  ExpectNear(from_points.cam_from_world, points.pose, 0.01, 0.1);

  MatchedFrame lines(0);
  std::fill(lines.association.matches.point_of_feature.begin(),
            lines.association.matches.point_of_feature.end(),
            -1);
  const PoseEstimate from_lines =
      PoseEstimator(lines.world.camera, {}, {})
          .Estimate(lines.sensed.indexed->features, Disturbed(lines.pose), {}, lines.association);
  EXPECT_TRUE(from_lines.converged);
  EXPECT_EQ(from_lines.inlier_points, 0);
  ExpectNear(from_lines.cam_from_world, lines.pose, 0.03, 0.2);
}

TEST(EstimatePose, TellsWhenThePoseIsNotDetermined) {
  MatchedFrame frame(0);
  std::fill(frame.association.matches.line_of_feature.begin(),
            frame.association.matches.line_of_feature.end(),
            -1);
  std::fill(frame.association.matches.point_of_feature.begin() + 1,
            frame.association.matches.point_of_feature.end(),
            -1);
  const PoseEstimate estimate =
      PoseEstimator(frame.world.camera, {}, {})
          .Estimate(frame.sensed.indexed->features, frame.pose, {}, frame.association);
  EXPECT_FALSE(estimate.converged);
}

TEST(DropDisagreeing, LeavesWhatAgreesWithThePose) {
  MatchedFrame frame(0.2);
  const int points = frame.association.matches.Points();
  const int lines = frame.association.matches.Lines();
  PoseEstimator(frame.world.camera, {}, {})
      .DropDisagreeing(frame.sensed.indexed->features, frame.pose, 1, frame.association);
  EXPECT_LE(CountWrongLeft(frame.wrong_point, frame.association.matches.point_of_feature), 1);
  EXPECT_LE(CountWrongLeft(frame.wrong_line, frame.association.matches.line_of_feature), 2);
  EXPECT_GT(frame.association.matches.Points(), points * 7 / 10);
  EXPECT_GT(frame.association.matches.Lines(), lines / 2);
}

TEST(TakeOutYoung, PartsMatchesByTheViewsOfTheirLandmarks) {
  const MatchedFrame frame(0);
  MapSnapshot snapshot;
  for (const CandidatePoint& point : frame.association.points) {
    if (point.id.value % 3 == 0) continue;  // not in the snapshot: as young as can be
    snapshot.points.push_back({{point.model}, point.id, point.id.value % 3 == 1 ? 2 : 3});
  }
  for (const CandidateLine& line : frame.association.lines) {
    snapshot.lines.push_back({{line.model}, line.id, line.id.value % 2 == 1 ? 2 : 3});
  }
  FrameAssociation parted = frame.association;
  const FrameMatches young = TakeOutYoung(snapshot, 3, parted);
  FrameMatches& established = parted.matches;
  for (std::size_t i = 0; i < young.point_of_feature.size(); ++i) {
    const int match = frame.association.matches.point_of_feature[i];
    EXPECT_EQ(established.point_of_feature[i], match >= 0 && match % 3 == 2 ? match : -1);
    EXPECT_EQ(young.point_of_feature[i], match >= 0 && match % 3 != 2 ? match : -1);
  }
  for (std::size_t i = 0; i < young.line_of_feature.size(); ++i) {
    const int match = frame.association.matches.line_of_feature[i];
    EXPECT_EQ(established.line_of_feature[i], match >= 0 && match % 2 == 0 ? match : -1);
  }
  PutBack(young, established);
  EXPECT_EQ(established.point_of_feature, frame.association.matches.point_of_feature);
  EXPECT_EQ(established.line_of_feature, frame.association.matches.line_of_feature);
}

TEST(MatchCandidates, MatchesWhatIsFreeAndTellsWhatShouldBeSeen) {
  MatchedFrame frame(0);
  const FrameMatches all = frame.association.matches;
  // Half of the matches known before, the others to be found.
  for (std::size_t i = 0; i < all.point_of_feature.size(); i += 2) {
    frame.association.matches.point_of_feature[i] = -1;
  }
  for (std::size_t i = 0; i < all.line_of_feature.size(); i += 2) {
    frame.association.matches.line_of_feature[i] = -1;
  }
  const ExpectedLandmarks expected = MatchCandidates(
      frame.world.Imaging(), *frame.sensed.indexed, frame.pose, {}, frame.association);
  EXPECT_GT(frame.association.matches.Points(), all.Points() * 95 / 100);
  EXPECT_GT(frame.association.matches.Lines(), all.Lines() * 9 / 10);
  std::vector<int> matched;
  for (std::size_t i = 0; i < all.point_of_feature.size(); ++i) {
    const int match = frame.association.matches.point_of_feature[i];
    if (i % 2 == 1) {
      EXPECT_EQ(match, all.point_of_feature[i]);
    }
    if (match < 0) continue;
    matched.push_back(match);
    if (all.point_of_feature[i] >= 0) {
      EXPECT_EQ(match, all.point_of_feature[i]);
    }
  }
  std::sort(matched.begin(), matched.end());
  EXPECT_EQ(std::adjacent_find(matched.begin(), matched.end()), matched.end());
  // Expected to be seen: nearly those matched and the few that the sensor missed.
  EXPECT_GE(static_cast<int>(expected.points.size()), frame.association.matches.Points());
  EXPECT_LT(static_cast<int>(expected.points.size()), all.Points() * 12 / 10);
}

}  // namespace
}  // namespace plumbline
