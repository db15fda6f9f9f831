// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/initial_map.h"

#include "plumbline/base/statistics.h"
#include "plumbline/base/units.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

namespace plumbline {
namespace initial_map_test {

struct Scene {
  SyntheticWorld world = MakeSyntheticWorld(400, 60);
  std::vector<InitialView> views;
  std::vector<FeatureTrack> points, lines;
  std::vector<std::size_t> point_truth, line_truth;  // of the tracks
};

void Collect(const std::vector<std::size_t>& truth,
             int view,
             std::map<std::size_t, FeatureTrack>& tracks) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    tracks[truth[i]].push_back({view, static_cast<int>(i)});
  }
}

void Keep(const std::map<std::size_t, FeatureTrack>& all,
          std::vector<FeatureTrack>& tracks,
          std::vector<std::size_t>& truth) {
  for (const auto& [landmark, track] : all) {
    if (track.size() < 2) continue;
    tracks.push_back(track);
    truth.push_back(landmark);
  }
}

// Frames 0, 10 and 20 of the path: a median parallax of some degrees.
Scene MakeScene(double noise) {
  Scene scene;
  Rng rng(5, "structure");
  std::map<std::size_t, FeatureTrack> points;
  std::map<std::size_t, FeatureTrack> lines;
  for (int i = 0; i < 3; ++i) {
    const Rigid3 pose = PoseOnPath(10 * i);
    const SyntheticFrame frame = Sense(scene.world, pose, {.depth = false, .noise = noise}, rng);
    scene.views.push_back({{FrameId{i}, i * 500'000'000, frame.indexed, nullptr}, pose});
    Collect(frame.point_truth, i, points);
    Collect(frame.line_truth, i, lines);
  }
  Keep(points, scene.points, scene.point_truth);
  Keep(lines, scene.lines, scene.line_truth);
  return scene;
}

InitialMap Build(const Scene& scene) {
  return TriangulateMap(scene.world.camera, scene.views, scene.points, scene.lines);
}

// Index of the track that a landmark of the map was made from.
template <class Landmark>
std::size_t TrackOf(const Landmark& landmark, const std::vector<FeatureTrack>& tracks) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const InitialObservation& o = landmark.observations.back();
    const auto is_same = [&](const InitialObservation& other) {
      return other.view == o.view && other.feature == o.feature;
    };
    if (std::any_of(tracks[i].begin(), tracks[i].end(), is_same)) return i;
  }
  ADD_FAILURE() << "a landmark without track";
  return 0;
}

TEST(TriangulateMap, ExactMeasurementsGiveTheWorld) {
  const Scene scene = MakeScene(0);
  const InitialMap map = Build(scene);
  EXPECT_GT(map.points.size(), scene.points.size() * 8 / 10);
  for (const InitialPoint& point : map.points) {
    const auto& truth = scene.world.points[scene.point_truth[TrackOf(point, scene.points)]];
    EXPECT_LT((point.position - truth.position).norm(), 1e-6);
  }
  EXPECT_GT(map.lines.size(), scene.lines.size() / 2);
  for (const InitialLine& line : map.lines) {
    const auto& truth = scene.world.lines[scene.line_truth[TrackOf(line, scene.lines)]];
    EXPECT_LT(line.line.DistanceTo(truth.segment.start), 1e-5);
    EXPECT_LT(line.line.DistanceTo(truth.segment.end), 1e-5);
    EXPECT_GT(line.segment.Direction().dot(truth.segment.Direction()), 0.999);
    EXPECT_LE(line.segment.Length(), truth.segment.Length() * 1.01);
  }
}

TEST(TriangulateMap, TracksThatDoNotFitAreLeftOut) {
  Scene scene = MakeScene(1);
  const std::size_t before = Build(scene).points.size();
  std::size_t spoiled = 0;
  for (std::size_t i = 0; i + 1 < scene.points.size(); i += 10) {
    std::swap(scene.points[i].back(), scene.points[i + 1].back());
    if (scene.points[i].back().view != scene.points[i + 1].back().view) {
      std::swap(scene.points[i].back(), scene.points[i + 1].back());
      continue;
    }
    spoiled += 2;
  }
  ASSERT_GT(spoiled, 20U);
  EXPECT_LT(Build(scene).points.size(), before - spoiled * 7 / 10);
}

TEST(TriangulateMap, LinesFarFromWhereThePointsAreAreLeftOut) {
  Scene scene = MakeScene(0);
  const std::size_t before = Build(scene).lines.size();
  // Points all at one near place: no line can be there.
  for (auto& [position, descriptor] : scene.world.points) position = {0, 0, 0.5};
  Rng rng(1);
  for (InitialView& view : scene.views) {
    Features features = view.frame.indexed->features;
    for (PointFeature& p : features.points) {
      p.px = scene.world.camera.Project(view.cam_from_world * Eigen::Vector3d(0, 0, 0.5));
    }
    view.frame.indexed = IndexFeatures(scene.world.camera, std::move(features));
  }
  EXPECT_GT(before, 10U);
  EXPECT_EQ(Build(scene).lines.size(), 0U);
}

TEST(ScaleToMedianDepth, KeepsImagesAndDividesDepths) {
  const Scene scene = MakeScene(0);
  InitialMap map = Build(scene);
  const Eigen::Vector3d in_camera = map.views[2].cam_from_world * map.points[3].position;
  const Eigen::Vector3d on_line = map.lines.front().segment.start;
  const double depth = MedianDepth(map);
  EXPECT_NEAR(depth, 6, 1.5);
  ScaleToMedianDepth(map);
  EXPECT_NEAR(MedianDepth(map), 1, 1e-12);
  const Eigen::Vector3d scaled = map.views[2].cam_from_world * map.points[3].position;
  EXPECT_LT((scaled * depth - in_camera).norm(), 1e-9);
  EXPECT_LT(map.lines.front().line.DistanceTo(on_line / depth), 1e-9);
  EXPECT_LT((map.lines.front().segment.start - on_line / depth).norm(), 1e-9);
}

// Of all observations of points.
std::vector<double> PointChi2(const RectifiedCamera& camera, const InitialMap& map) {
  std::vector<double> chi2;
  for (const InitialPoint& point : map.points) {
    for (const InitialObservation& o : point.observations) {
      const InitialView& view = map.views[static_cast<std::size_t>(o.view)];
      const auto measured =
          MeasurePoint(view.frame.indexed->features, static_cast<std::size_t>(o.feature));
      const auto residual = EvaluatePoint(camera, view.cam_from_world, point.position, measured);
      if (residual) chi2.push_back(residual->r.head(residual->rows).squaredNorm());
    }
  }
  return chi2;
}

TEST(AdjustMap, BringsPosesBackAndDropsWhatDoesNotFit) {
  Scene scene = MakeScene(1);
  std::vector<Rigid3> truth;
  for (const InitialView& view : scene.views) truth.push_back(view.cam_from_world);
  InitialMap map = Build(scene);
  const Eigen::Vector3d wrong = map.points.front().position + Eigen::Vector3d(0.5, 0.5, 0);
  map.points.front().position = wrong;  // a bad start is no reason to lose a point
  map.points[1].observations.back().feature = map.points[2].observations.back().feature;
  const InitialPoint spoiled = map.points[1];
  map.views[1].cam_from_world =
      ExpSe3((Vector6d() << 0.003, -0.002, 0.002, 0.01, 0, 0).finished()) *
      map.views[1].cam_from_world;
  const std::size_t observations = PointChi2(scene.world.camera, map).size();
  AdjustMap(scene.world.camera, map);
  const std::vector<double> chi2 = PointChi2(scene.world.camera, map);
  EXPECT_GT(chi2.size(), observations * 9 / 10);
  EXPECT_NEAR(UpperMedian(chi2), 0.5, 0.4);  // three observations of three unknowns: less than 1.39
  EXPECT_NEAR(MedianDepth(map), 1, 1e-12);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Rigid3& pose = map.views[i].cam_from_world;
    EXPECT_LT(AngularDistance(pose.rotation, truth[i].rotation),
              0.25 * kDegree);  // the noise limit is 0.13
    EXPECT_GT(pose.translation.normalized().dot(truth[i].translation.normalized()),
              std::cos(5 * kDegree));
  }
  for (const InitialPoint& point : map.points) {
    EXPECT_GE(point.observations.size(), 2U);
    const bool has_spoiled =
        point.observations.size() == spoiled.observations.size() &&
        point.observations.back().feature == spoiled.observations.back().feature &&
        point.observations.front().feature == spoiled.observations.front().feature;
    EXPECT_FALSE(has_spoiled);
  }
}

// Features have an error of one pixel, the places given beside them have none.
TEST(AdjustMap, MeasuresPlacesThatAreKnownBetterThanFeatures) {
  Scene scene = MakeScene(1);
  for (std::size_t k = 0; k < scene.points.size(); ++k) {
    const Eigen::Vector3d& position = scene.world.points[scene.point_truth[k]].position;
    for (InitialObservation& o : scene.points[k]) {
      const Rigid3& pose = scene.views[static_cast<std::size_t>(o.view)].cam_from_world;
      o.px = scene.world.camera.Project(pose * position);
    }
  }
  scene.lines.clear();
  const Rigid3 truth = scene.views[1].cam_from_world;
  InitialMap map = Build(scene);
  map.views[1].cam_from_world.rotation =
      ExpSo3({0.003, -0.002, 0.002}) * map.views[1].cam_from_world.rotation;
  AdjustMap(scene.world.camera, map);
  EXPECT_LT(AngularDistance(map.views[1].cam_from_world.rotation, truth.rotation), 0.005 * kDegree);
}

}  // namespace initial_map_test
}  // namespace plumbline
