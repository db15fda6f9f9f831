// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/projection_search.h"

#include "tests/support/synthetic_world.h"
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const ProjectionSearchOptions kOptions;

CameraAndPyramid Imaging() { return {TestCamera(), 1.2}; }

Rigid3 LookingFrom(const Eigen::Vector3d& centre) {
  return {Eigen::Quaterniond::Identity(), -centre};
}

TEST(ProjectPoint, TellsPlaceDisparityAndScale) {
  PointModel point;
  point.position = {1, -0.5, 6};
  point.view_direction = Eigen::Vector3d(1, -0.5, 6).normalized();
  point.reference_distance = point.position.norm();
  point.reference_octave = 2;
  point.descriptor = {1, 2, 3, 4};
  const auto seen = ProjectPoint(Imaging(), {}, point);
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->px - Eigen::Vector2d(435 / 6.0 + 367, -420 * 0.5 / 6 + 252)).norm(), 1e-9);
  EXPECT_NEAR(seen->disparity, 435 * 0.11 / 6, 1e-9);
  EXPECT_EQ(seen->octave, 2);
  EXPECT_NEAR(seen->scale, 1.44, 1e-12);
  EXPECT_EQ(seen->descriptor, point.descriptor);
  // Nearer it looks larger: half the distance is 3.8 octaves of 1.2.
  const auto nearer = ProjectPoint(Imaging(), LookingFrom(0.5 * point.position), point);
  ASSERT_TRUE(nearer);
  EXPECT_EQ(nearer->octave, 6);
  // And from afar never below octave 0.
  const auto far = ProjectPoint(Imaging(), LookingFrom(-9 * point.position), point);
  ASSERT_TRUE(far);
  EXPECT_EQ(far->octave, 0);
  EXPECT_EQ(far->scale, 1);
}

TEST(ProjectPoint, LeavesOutWhatIsBehindOutsideOrTurnedAway) {
  PointModel point;
  point.position = {0, 0, -3};
  EXPECT_FALSE(ProjectPoint(Imaging(), {}, point));
  point.position = {0, 0, 0.0005};
  EXPECT_FALSE(ProjectPoint(Imaging(), {}, point));
  point.position = {4, 0, 3};
  EXPECT_FALSE(ProjectPoint(Imaging(), {}, point));
  point.position = {0, 0, 3};
  EXPECT_TRUE(ProjectPoint(Imaging(), {}, point));  // without a usual direction
  const auto seen_at = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    point.view_direction = {std::sin(angle), 0, std::cos(angle)};
    return ProjectPoint(Imaging(), {}, point).has_value();
  };
  EXPECT_TRUE(seen_at(59));
  EXPECT_FALSE(seen_at(61));
  EXPECT_FALSE(seen_at(180));
}

TEST(ProjectSegment, ClipsAtTheBordersAndAtTheNearPlane) {
  const RectifiedCamera camera = TestCamera();
  const auto inside = ProjectSegment(camera, {{-1, 0, 5}, {1, 0.5, 6}});
  ASSERT_TRUE(inside);
  EXPECT_LT((inside->start - camera.Project({-1, 0, 5})).norm(), 1e-9);
  EXPECT_LT((inside->end - camera.Project({1, 0.5, 6})).norm(), 1e-9);

  const auto across = ProjectSegment(camera, {{-50, -20, 5}, {50, 20, 5}});
  ASSERT_TRUE(across);
  EXPECT_TRUE(camera.Contains(across->start, -1e-9));
  EXPECT_TRUE(camera.Contains(across->end, -1e-9));
  const Eigen::Vector3d image_line = LineThrough(*across);
  EXPECT_NEAR(LineDistance(image_line, camera.Project({-50, -20, 5})), 0, 1e-7);

  // From behind the camera to in front of it: only the front part, up to the border.
  const Segment3 through{{0.3, 0.2, -4}, {0.3, 0.2, 6}};
  for (const Segment3& s : {through, through.Reversed()}) {
    const auto front = ProjectSegment(camera, s);
    ASSERT_TRUE(front);
    EXPECT_TRUE(camera.Contains(front->start, -1e-9));
    EXPECT_TRUE(camera.Contains(front->end, -1e-9));
    const Eigen::Vector2d far_end = s.start.z() > 0 ? front->start : front->end;
    EXPECT_LT((far_end - camera.Project({0.3, 0.2, 6})).norm(), 1e-9);
  }
}

TEST(ProjectSegment, GivesNothingOutOfSight) {
  const RectifiedCamera camera = TestCamera();
  EXPECT_FALSE(ProjectSegment(camera, {{-1, 0, -5}, {1, 0, -5}}));
  EXPECT_FALSE(ProjectSegment(camera, {{-1, 0, 0.0005}, {1, 0, 0.0005}}));
  EXPECT_FALSE(ProjectSegment(camera, {{9, -1, 5}, {9, 1, 5}}));
  EXPECT_FALSE(ProjectSegment(camera, {{-1, -9, 5}, {1, -9, 5}}));
  EXPECT_FALSE(ProjectSegment(camera, {{5.5, -2.5, 5}, {3, -4, 5}}));  // past a corner
}

TEST(ProjectLine, GatesOnLengthAndView) {
  LineModel line;
  line.line = LineThroughPoints({-0.5, 0, 5}, {0.5, 0, 5});
  line.start = -0.5;
  line.end = 0.5;
  line.descriptor = {5, 6, 7, 8};
  const auto seen = ProjectLine(Imaging(), {}, line);
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->segment.start - TestCamera().Project({-0.5, 0, 5})).norm(), 1e-9);
  EXPECT_LT((seen->segment.end - TestCamera().Project({0.5, 0, 5})).norm(), 1e-9);
  EXPECT_EQ(seen->descriptor, line.descriptor);
  line.end = -0.5 + 19 * 5 / 435.0;  // 19 px
  EXPECT_FALSE(ProjectLine(Imaging(), {}, line));
  line.end = 0.5;
  line.view_direction = Eigen::Vector3d(0, 1, 0.3).normalized();
  EXPECT_FALSE(ProjectLine(Imaging(), {}, line));
}

// An image with points of octave 0 at the given places.
class PointImage {
 public:
  void Add(const Eigen::Vector2d& px,
           int distance_from_zero,
           std::optional<double> disparity = {}) {
    PointFeature feature;
    feature.px = px;
    for (int b = 0; b < distance_from_zero; ++b) {
      feature.descriptor[static_cast<std::size_t>(b / 64)] |= std::uint64_t{1} << (b % 64);
    }
    features_.points.push_back(feature);
    std::optional<Disparity> d;
    if (disparity) d = Disparity{*disparity, 0.2};
    features_.point_disparity.push_back(d);
  }
  PointFeature& feature(std::size_t i) { return features_.points[i]; }

  std::vector<LandmarkMatch> Match(const std::vector<std::optional<ProjectedPoint>>& landmarks,
                                   std::vector<bool> taken = {}) const {
    taken.resize(features_.points.size());
    return MatchProjectedPoints(
        *IndexFeatures(TestCamera(), features_), landmarks, taken, kOptions);
  }

 private:
  Features features_;
};

ProjectedPoint At(double x, double y, double disparity = 10) {
  return {.px = {x, y}, .disparity = disparity};
}

TEST(MatchProjectedPoints, TakesTheMostSimilarInTheWindow) {
  PointImage image;
  image.Add({100, 100}, 60);
  image.Add({103.9, 100}, 10);
  image.Add({104.1, 100}, 0);  // outside of 4 px
  const auto matches = image.Match({std::nullopt, At(100, 100), At(300, 300)});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].landmark, 1);
  EXPECT_EQ(matches[0].feature, 1);
}

TEST(MatchProjectedPoints, LeavesOutTakenUnlikeAmbiguousAndWrongScale) {
  PointImage image;
  image.Add({100, 100}, 10);
  EXPECT_EQ(image.Match({At(100, 100)}).size(), 1U);
  EXPECT_TRUE(image.Match({At(100, 100)}, {true}).empty());
  image.feature(0).octave = 1;
  EXPECT_EQ(image.Match({At(100, 100)}).size(), 1U);
  image.feature(0).octave = 2;
  EXPECT_TRUE(image.Match({At(100, 100)}).empty());

  PointImage unlike;
  unlike.Add({100, 100}, 81);
  EXPECT_TRUE(unlike.Match({At(100, 100)}).empty());

  PointImage ambiguous;
  ambiguous.Add({100, 100}, 20);
  ambiguous.Add({101, 100}, 22);
  EXPECT_TRUE(ambiguous.Match({At(100, 100)}).empty());
  ambiguous.feature(1).octave = 1;  // another scale of the same corner is no rival
  EXPECT_EQ(ambiguous.Match({At(100, 100)}).size(), 1U);
}

TEST(MatchProjectedPoints, DisparityMustAgree) {
  PointImage image;
  image.Add({100, 100}, 10, 14.7);  // 4 px of the window and 4 sigmas of 0.2
  EXPECT_EQ(image.Match({At(100, 100, 10)}).size(), 1U);
  EXPECT_TRUE(image.Match({At(100, 100, 9.8)}).empty());
}

TEST(MatchProjectedPoints, IsOneToOne) {
  PointImage image;
  image.Add({100, 100}, 10);
  ProjectedPoint better = At(100, 100);
  better.descriptor[0] = 0x3ff;  // the ten bits
  auto matches = image.Match({At(100, 100), better, At(101, 100)});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].landmark, 1);
  matches = image.Match({At(100, 100), At(101, 100)});  // equally similar: the lower index
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].landmark, 0);
}

// Matches of one predicted line against one feature.
bool LineMatches(const Segment2& predicted, const Segment2& feature, int distance = 0) {
  Features features;
  LineFeature line;
  line.segment = feature;
  for (int b = 0; b < distance; ++b) {
    line.descriptor[static_cast<std::size_t>(b / 64)] |= std::uint64_t{1} << (b % 64);
  }
  features.lines.push_back(line);
  features.line_right.push_back({});
  return !MatchProjectedLines(*IndexFeatures(TestCamera(), features),
                              {ProjectedLine{predicted, {}}},
                              {false},
                              kOptions)
              .empty();
}

TEST(MatchProjectedLines, NeedsPlaceDirectionOverlapAndLooks) {
  const Segment2 predicted{{100, 100}, {200, 100}};
  EXPECT_TRUE(LineMatches(predicted, predicted));
  EXPECT_FALSE(LineMatches(predicted, predicted.Reversed()));
  EXPECT_TRUE(LineMatches(predicted, {{100, 109}, {200, 109}}));
  EXPECT_FALSE(LineMatches(predicted, {{100, 111}, {200, 111}}));
  EXPECT_TRUE(LineMatches(predicted, {{100, 94}, {200, 106}}));    // 6.8 degrees
  EXPECT_FALSE(LineMatches(predicted, {{100, 92}, {200, 108}}));   // 9.1 degrees
  EXPECT_TRUE(LineMatches(predicted, {{165, 100}, {265, 100}}));   // 35 % overlap
  EXPECT_FALSE(LineMatches(predicted, {{175, 100}, {275, 100}}));  // 25 %
  EXPECT_TRUE(LineMatches(predicted, predicted, 80));
  EXPECT_FALSE(LineMatches(predicted, predicted, 81));
}

TEST(MatchProjectedLines, IsOneToOne) {
  Features features;
  features.lines.push_back({.segment = {{100, 100}, {200, 100}}});
  features.line_right.push_back({});
  features.lines.push_back({.segment = {{100, 300}, {200, 300}}});
  features.line_right.push_back({});
  const ProjectedLine near_first{{{100, 102}, {200, 102}}, {1}};
  const ProjectedLine exact{{{100, 100}, {200, 100}}, {}};
  const ProjectedLine second{{{100, 300}, {200, 300}}, {}};
  const auto matches = MatchProjectedLines(*IndexFeatures(TestCamera(), features),
                                           {near_first, std::nullopt, exact, second},
                                           {false, false},
                                           kOptions);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].landmark, 2);
  EXPECT_EQ(matches[0].feature, 0);
  EXPECT_EQ(matches[1].landmark, 3);
  EXPECT_EQ(matches[1].feature, 1);
  EXPECT_TRUE(
      MatchProjectedLines(*IndexFeatures(TestCamera(), features), {exact}, {true, false}, kOptions)
          .empty());
}

// Landmarks of the world projected with the true pose against the features of a noisy frame.
TEST(MatchProjectedPoints, FindsNearlyAllLandmarksOfAWorldAndNoWrongOnes) {
  const SyntheticWorld world = MakeSyntheticWorld(800, 120);
  Rng rng(2);
  const Rigid3 pose = PoseOnPath(20);
  const SyntheticFrame sensed = Sense(world, pose, {}, rng);
  std::vector<std::optional<ProjectedPoint>> points;
  for (const auto& p : world.points) {
    PointModel model;
    model.position = p.position;
    model.descriptor = p.descriptor;
    model.reference_distance = 8;  // shows in octave 0 there
    points.push_back(ProjectPoint(world.Imaging(), pose, model));
  }
  const std::vector<bool> no_point(sensed.point_truth.size(), false);
  const auto matches = MatchProjectedPoints(*sensed.indexed, points, no_point, kOptions);
  EXPECT_GT(matches.size(), sensed.point_truth.size() * 97 / 100);
  for (const LandmarkMatch& m : matches) {
    EXPECT_EQ(sensed.point_truth[static_cast<std::size_t>(m.feature)],
              static_cast<std::size_t>(m.landmark));
  }
  std::vector<std::optional<ProjectedLine>> lines;
  for (const auto& l : world.lines) {
    LineModel model;
    model.line = LineThroughPoints(l.segment.start, l.segment.end);
    model.start = model.line.ParameterOf(l.segment.start);
    model.end = model.line.ParameterOf(l.segment.end);
    model.descriptor = l.descriptor;
    lines.push_back(ProjectLine(world.Imaging(), pose, model));
  }
  const std::vector<bool> no_line(sensed.line_truth.size(), false);
  const auto line_matches = MatchProjectedLines(*sensed.indexed, lines, no_line, kOptions);
  EXPECT_GT(line_matches.size(), sensed.line_truth.size() * 9 / 10);
  for (const LandmarkMatch& m : line_matches) {
    EXPECT_EQ(sensed.line_truth[static_cast<std::size_t>(m.feature)],
              static_cast<std::size_t>(m.landmark));
  }
}

}  // namespace
}  // namespace plumbline
