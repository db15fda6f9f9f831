// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_estimation.h"

#include "tests/tracking/matched_frame.h"
#include <algorithm>
#include <cstddef>
#include <vector>

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
    testing::ExpectPoseWithWrongMatches({{.weighting = weighting}}, 2);
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

TEST(SplitMatches, PartsMatchesByTheViewsOfTheirLandmarks) {
  const MatchedFrame frame(0);
  MapSnapshot snapshot;
  for (const PointCandidate& point : frame.association.points) {
    if (point.id.value % 3 == 0) continue;  // not in the snapshot: as young as can be
    snapshot.points.push_back({{point.model}, point.id, point.id.value % 3 == 1 ? 2 : 3});
  }
  for (const LineCandidate& line : frame.association.lines) {
    snapshot.lines.push_back({{line.model}, line.id, line.id.value % 2 == 1 ? 2 : 3});
  }
  LandmarkMatches parted = frame.association;
  const FrameMatches young = SplitMatches(snapshot, 3, parted);
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
  MergeMatches(young, established);
  EXPECT_EQ(established.point_of_feature, frame.association.matches.point_of_feature);
  EXPECT_EQ(established.line_of_feature, frame.association.matches.line_of_feature);
}

// Takes every second match out.
void Halve(FrameMatches& matches) {
  for (std::vector<int>* of_feature : {&matches.point_of_feature, &matches.line_of_feature}) {
    for (std::size_t i = 0; i < of_feature->size(); i += 2) (*of_feature)[i] = -1;
  }
}

TEST(MatchCandidates, MatchesWhatIsFree) {
  MatchedFrame frame(0);
  const FrameMatches all = frame.association.matches;
  Halve(frame.association.matches);
  MatchCandidates(frame.world.Imaging(), *frame.sensed.indexed, frame.pose, {}, frame.association);
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
}

TEST(MatchSnapshot, MatchesAsIfAllItsLandmarksWereCandidates) {
  MatchedFrame frame(0);
  LandmarkMatches& plain = frame.association;
  const int all_points = plain.matches.Points();
  MapSnapshot snapshot;
  for (const auto& point : plain.points) snapshot.points.push_back({{point.model}, point.id, 2});
  for (const auto& line : plain.lines) snapshot.lines.push_back({{line.model}, line.id, 2});
  Halve(plain.matches);
  LandmarkMatches association(frame.sensed.point_truth.size(), frame.sensed.line_truth.size());
  CopyMatches(plain, true, association);

  const CameraAndPyramid imaging = frame.world.Imaging();
  MatchCandidates(imaging, *frame.sensed.indexed, frame.pose, {}, plain);
  const LandmarkIds expected =
      MatchSnapshot(imaging, *frame.sensed.indexed, frame.pose, {}, snapshot, association);
  Frame with_plain, with_snapshot;
  SetLandmarks(plain, with_plain);
  SetLandmarks(association, with_snapshot);
  EXPECT_EQ(with_snapshot.points, with_plain.points);
  EXPECT_EQ(with_snapshot.lines, with_plain.lines);
  EXPECT_EQ(static_cast<int>(association.points.size()), association.matches.Points());
  EXPECT_EQ(static_cast<int>(association.lines.size()), association.matches.Lines());
  for (const PointCandidate& point : association.points) {
    EXPECT_EQ(point.model.position, snapshot.Find(point.id)->position);
  }
  for (const LineCandidate& line : association.lines) {
    EXPECT_EQ(line.model.line.moment, snapshot.Find(line.id)->line.moment);
  }

  LandmarkIds projected;
  for (const SnapshotPoint& point : snapshot.points) {
    if (ProjectPoint(imaging, frame.pose, point)) projected.points.push_back(point.id);
  }
  for (const SnapshotLine& line : snapshot.lines) {
    if (ProjectLine(imaging, frame.pose, line)) projected.lines.push_back(line.id);
  }
  EXPECT_EQ(expected.points, projected.points);
  EXPECT_EQ(expected.lines, projected.lines);
  // Nearly only those that are matched, and the few that the sensor missed.
  EXPECT_GE(static_cast<int>(expected.points.size()), association.matches.Points());
  EXPECT_LT(static_cast<int>(expected.points.size()), all_points * 12 / 10);
}

TEST(CountSeen, AddsToTheScoresOfWhatIsExpectedAndOfWhatIsFound) {
  LandmarkMatches association(4, 1);
  for (const int id : {7, 3, -1}) association.points.push_back({PointId{id}, {}});
  association.lines.push_back({LineId{5}, {}});
  association.matches.point_of_feature = {0, -1, 1, 2};  // the last was made on the spot
  association.matches.line_of_feature = {0};
  TrackingScores scores;
  scores.points[PointId{3}] = {2, 1};
  scores.points[PointId{4}] = {6, 5};
  CountSeen({{PointId{1}, PointId{3}}, {LineId{5}}}, association, scores);
  const auto expect = [](const TrackingScore& score, int visible, int found) {
    EXPECT_EQ(score.visible, visible);
    EXPECT_EQ(score.found, found);
  };
  ASSERT_EQ(scores.points.size(), 4U);
  expect(scores.points.at(PointId{1}), 1, 0);
  expect(scores.points.at(PointId{3}), 3, 2);
  expect(scores.points.at(PointId{4}), 6, 5);
  expect(scores.points.at(PointId{7}), 0, 1);
  ASSERT_EQ(scores.lines.size(), 1U);
  expect(scores.lines.at(LineId{5}), 1, 1);
}

}  // namespace
}  // namespace plumbline
