// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/tracking/pose_estimation.h"

#include "tests/support/true_map.h"
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline::testing {

// A frame at a pose and the landmarks of a true map as candidates, each matched with its feature.
struct MatchedFrame {
  SyntheticWorld world = MakeSyntheticWorld(400, 80);
  TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10)}, {});
  Rigid3 pose = PoseOnPath(15);
  SyntheticFrame sensed;
  LandmarkMatches association;
  std::vector<bool> wrong_point, wrong_line;  // by feature

  explicit MatchedFrame(double wrong_share) {
    Rng rng(11, "matched_frame");
    sensed = Sense(world, pose, {}, rng);
    association = LandmarkMatches(sensed.point_truth.size(), sensed.line_truth.size());
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

inline int CountWrongLeft(const std::vector<bool>& wrong,
                          const std::vector<int>& match_of_feature) {
  int count = 0;
  for (std::size_t i = 0; i < wrong.size(); ++i) count += wrong[i] && match_of_feature[i] >= 0;
  return count;
}

// Half a degree and some centimetres off.
inline Rigid3 Disturbed(const Rigid3& pose) {
  return ExpSe3((Vector6d() << 0.01, -0.008, 0.005, 0.04, -0.03, 0.05).finished()) * pose;
}

inline void ExpectNear(const Rigid3& pose, const Rigid3& truth, double metres, double degrees) {
  EXPECT_LT(CentreDistance(pose, truth), metres);
  EXPECT_LT(AngularDistance(pose.rotation, truth.rotation) * 180 / std::numbers::pi, degrees);
}

// A fifth of the matches are wrong; no more than `wrong_lines` of those of lines may stay.
inline void ExpectPoseWithWrongMatches(const LineSettings& options, int wrong_lines) {
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
  EXPECT_LE(CountWrongLeft(frame.wrong_line, frame.association.matches.line_of_feature),
            wrong_lines);
}

}  // namespace plumbline::testing
