// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/pose_estimation.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A frame at a pose and the landmarks of a true map as candidates, each matched with its feature.
struct MatchedFrame {
  SyntheticWorld world = MakeSyntheticWorld(400, 80);
  TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10)}, {});
  Rigid3 pose = PoseOnPath(15);
  SyntheticFrame sensed;
  FrameAssociation association;
  std::vector<bool> wrong_point, wrong_line;  // by feature

  explicit MatchedFrame(double wrong_share) {
    Rng rng(11, "matched_frame");
    sensed = Sense(world, pose, {}, rng);
    association = FrameAssociation(sensed.point_truth.size(), sensed.line_truth.size());
    for (const auto& [id, point] : scene.map.points()) association.points.push_back({id, point});
    for (const auto& [id, line] : scene.map.lines()) association.lines.push_back({id, line});
    wrong_point = Match(scene.point_of,
                        sensed.point_truth,
                        association.points.size(),
                        wrong_share,
                        rng,
                        association.matches.point_of_feature);
    wrong_line = Match(scene.line_of,
                       sensed.line_truth,
                       association.lines.size(),
                       wrong_share,
                       rng,
                       association.matches.line_of_feature);
  }

 private:
  template <class LandmarkId>
  static std::vector<bool> Match(const std::map<std::size_t, LandmarkId>& id_of,
                                 const std::vector<std::size_t>& truth,
                                 std::size_t candidates,
                                 double wrong_share,
                                 Rng& rng,
                                 std::vector<int>& match_of_feature) {
    std::vector<bool> wrong(truth.size(), false);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto it = id_of.find(truth[i]);
      if (it == id_of.end()) continue;
      // Ids of a true map count from 0, so they are the candidates' indices.
      match_of_feature[i] = static_cast<int>(it->second.value);
      if (rng.Uniform() >= wrong_share) continue;
      match_of_feature[i] = static_cast<int>(rng.Index(candidates));
      wrong[i] = match_of_feature[i] != static_cast<int>(it->second.value);
    }
    return wrong;
  }
};

int CountWrongLeft(const std::vector<bool>& wrong, const std::vector<int>& match_of_feature) {
  int count = 0;
  for (std::size_t i = 0; i < wrong.size(); ++i) count += wrong[i] && match_of_feature[i] >= 0;
  return count;
}

// Half a degree and some centimetres off.
Rigid3 Disturbed(const Rigid3& pose) {
  return ExpSe3((Vector6d() << 0.01, -0.008, 0.005, 0.04, -0.03, 0.05).finished()) * pose;
}

void ExpectNear(const Rigid3& pose, const Rigid3& truth, double metres, double degrees) {
  EXPECT_LT(CentreDistance(pose, truth), metres);
  EXPECT_LT(AngularDistance(pose.rotation, truth.rotation) * 180 / std::numbers::pi, degrees);
}

class EstimatePoseBy
    : public ::testing::TestWithParam<std::tuple<LineResidualKind, LineWeighting>> {};
INSTANTIATE_TEST_SUITE_P(ResidualsAndWeights,
                         EstimatePoseBy,
                         ::testing::Combine(::testing::Values(LineResidualKind::kObservedEnds,
                                                              LineResidualKind::kProjectedEnds),
                                            ::testing::Values(LineWeighting::kNone,
                                                              LineWeighting::kScalar,
                                                              LineWeighting::kCovariance)));

TEST_P(EstimatePoseBy, RecoversThePoseAndDropsWrongMatches) {
  LineOptions options;
  std::tie(options.residual, options.weighting) = GetParam();
  {
    MatchedFrame frame(0.2);
    const int points = frame.association.matches.Points();
    const int lines = frame.association.matches.Lines();
    const PoseEstimate estimate =
        PoseEstimator(frame.world.camera, options, {})
            .Estimate(frame.sensed.indexed->features, Disturbed(frame.pose), {}, frame.association);
    EXPECT_TRUE(estimate.converged);
    ExpectNear(estimate.cam_from_world, frame.pose, 0.01, 0.1);
    EXPECT_EQ(estimate.inlier_points, frame.association.matches.Points());
    EXPECT_EQ(estimate.inlier_lines, frame.association.matches.Lines());
    EXPECT_EQ(estimate.Inliers(), estimate.inlier_points + estimate.inlier_lines);
    EXPECT_GT(estimate.inlier_points, points * 7 / 10);  // 0.8 of 0.95
    EXPECT_GT(estimate.inlier_lines, lines / 2);
    EXPECT_LE(CountWrongLeft(frame.wrong_point, frame.association.matches.point_of_feature), 1);
    // The mean variance of two projected ends is that of the worse known: its gates are lax.
    const bool lax = options.residual == LineResidualKind::kProjectedEnds &&
                     options.weighting == LineWeighting::kScalar;
    EXPECT_LE(CountWrongLeft(frame.wrong_line, frame.association.matches.line_of_feature),
              lax ? 8 : 2);
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
