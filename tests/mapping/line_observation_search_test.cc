// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_observation_search.h"

#include "plumbline/base/random.h"

#include "tests/support/true_map.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

const SensorModel kExactly{.points = false, .noise = 0, .missed = 0};

TrueMap SixKeyFrames(const SyntheticWorld& world, const SensorModel& sensor) {
  std::vector<Rigid3> poses;
  for (int frame = 0; frame <= 50; frame += 10) poses.push_back(PoseOnPath(frame));
  return MakeTrueMap(world, poses, sensor);
}

LineHypothesis HypothesisOf(const MapLine& line) {
  return {line.line, {line.start, line.end}, line.information};
}

TEST(LineSupportSearch, FindsTheSegmentsOfALineWithoutItsMatches) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 60);
  TrueMap scene = SixKeyFrames(world, kExactly);
  const Map matched = scene.map;
  MapEdit forget;
  for (const auto& [id, line] : matched.lines()) forget.push_back(edit::RemoveLine{id});
  scene.map.Apply(forget);
  const CameraAndPyramid imaging = world.Imaging();
  const LineSupportSearch search(scene.map, imaging);
  int all = 0, found = 0, wrong = 0;
  for (const auto& [index, id] : scene.line_of) {
    const MapLine& line = *matched.Find(id);
    all += static_cast<int>(line.observations.size());
    for (const LineSupport& support : search.Find(HypothesisOf(line))) {
      const auto observed = line.observations.find(support.keyframe->id);
      const bool right = observed != line.observations.end() &&
                         observed->second == static_cast<int>(support.feature);
      (right ? found : wrong) += 1;
    }
  }
  EXPECT_GT(all, 100);
  EXPECT_GE(found, 0.97 * all);
  EXPECT_LE(wrong, 0.03 * all);
}

TEST(LineSupportSearch, LooksNoFurtherThanItsReach) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const CameraAndPyramid imaging = world.Imaging();
  const LineSupportSearch search(scene.map, imaging);
  int near = 0, far = 0;
  for (const auto& [id, line] : scene.map.lines()) {
    LineHypothesis hypothesis = HypothesisOf(line);
    const Eigen::Vector3d middle = SegmentOf(line.line, hypothesis.interval).Midpoint();
    const auto distance = [&](const LineSupport& support) {
      return (support.keyframe->frame.cam_from_world * middle).norm();
    };
    const auto all = search.Find(hypothesis);
    if (all.size() < 3) continue;
    hypothesis.reach = distance(all[all.size() / 2]);
    auto expected = all;
    std::erase_if(expected, [&](const auto& s) { return distance(s) > hypothesis.reach; });
    EXPECT_EQ(search.Find(hypothesis), expected);
    near += static_cast<int>(expected.size());
    far += static_cast<int>(all.size() - expected.size());
  }
  EXPECT_GT(near, 20);
  EXPECT_GT(far, 20);
}

TEST(LineSupportSearch, LeavesOutWhatIsClaimed) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const CameraAndPyramid imaging = world.Imaging();
  LineSupportSearch search(scene.map, imaging);
  const LineHypothesis hypothesis = HypothesisOf(scene.map.lines().begin()->second);
  const auto supports = search.Find(hypothesis);
  ASSERT_FALSE(supports.empty());
  search.Claim(supports);
  EXPECT_TRUE(search.Find(hypothesis).empty());
}

// The inverse of a covariance that rounding errors made singular.
TEST(LineSupportSearch, FindsNothingForALineOfWhichNothingIsKnown) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const CameraAndPyramid imaging = world.Imaging();
  const LineSupportSearch search(scene.map, imaging);
  LineHypothesis hypothesis = HypothesisOf(scene.map.lines().begin()->second);
  ASSERT_FALSE(search.Find(hypothesis).empty());
  hypothesis.information.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(search.Find(hypothesis).empty());
}

TEST(LineSupportSearch, RefusesALineThatRunsTheOtherWay) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const CameraAndPyramid imaging = world.Imaging();
  const LineSupportSearch search(scene.map, imaging);
  LineHypothesis hypothesis = HypothesisOf(scene.map.lines().begin()->second);
  hypothesis.line = {-hypothesis.line.moment, -hypothesis.line.direction};
  hypothesis.interval = {-hypothesis.interval.end, -hypothesis.interval.start};
  EXPECT_TRUE(search.Find(hypothesis).empty());
}

TEST(LineThroughSupports, IsTheTrueLineWhereNothingIsNoisy) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const CameraAndPyramid imaging = world.Imaging();
  const LineSupportSearch search(scene.map, imaging);
  int lines = 0;
  for (const auto& [index, id] : scene.line_of) {
    const auto supports = search.Find(HypothesisOf(*scene.map.Find(id)));
    if (CountKeyFrames(supports) < 6) continue;
    const auto through = LineThroughSupports(world.camera, supports);
    ASSERT_TRUE(through);
    const Segment3& truth = world.lines[index].segment;
    if (through->line.DistanceTo(truth.start) > 1e-3 ||
        through->line.DistanceTo(truth.end) > 1e-3) {
      continue;  // another line lies behind this one
    }
    ++lines;
    const auto parts = ShownParts(world.camera, through->line, supports, 6, 0.4);
    EXPECT_LE(parts.size(), 1U);
    for (const LineInterval& part : parts) {
      EXPECT_GE(part.start, through->line.ParameterOf(truth.start) - 1e-3);
      EXPECT_LE(part.end, through->line.ParameterOf(truth.end) + 1e-3);
    }
  }
  EXPECT_GT(lines, 5);
}

TEST(ShownParts, CountKeyFramesPlaceByPlace) {
  const SyntheticWorld world = MakeSyntheticWorld(0, 30);
  const TrueMap scene = SixKeyFrames(world, kExactly);
  const MapLine& line = scene.map.lines().begin()->second;
  std::vector<LineSupport> supports;
  for (const auto& [id, feature] : line.observations) {
    supports.push_back({scene.map.Find(id), static_cast<std::size_t>(feature), false});
  }
  const int views = CountKeyFrames(supports);
  ASSERT_GE(views, 3);
  const auto length = [&](int min_keyframes, double min_share) {
    double sum = 0;
    for (const auto& part :
         ShownParts(world.camera, line.line, supports, min_keyframes, min_share)) {
      sum += part.end - part.start;
    }
    return sum;
  };
  EXPECT_GT(length(1, 0), 0);
  EXPECT_GE(length(1, 0), length(views, 0));
  EXPECT_EQ(length(views + 1, 0), 0);
  EXPECT_EQ(length(1, 1.5), 0);  // more often than expected
}

TEST(PartInImage, AgreesWithProjection) {
  Rng rng(3, "part_in_image");
  const RectifiedCamera camera = TestCamera();
  int inside = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Rigid3 pose = RandomRigid(rng, 1, 2);
    const PluckerLine line = LineThroughPoints(RandomVector<3>(rng, 3) + Eigen::Vector3d(0, 0, 4),
                                               RandomVector<3>(rng, 3) + Eigen::Vector3d(0, 0, 4));
    const auto part = PartInImage(camera, pose, line);
    for (double t = -8; t < 8; t += 0.37) {
      const Eigen::Vector3d point = pose * line.PointAt(t);
      const bool seen = point.z() > 0 && camera.Contains(camera.Project(point));
      EXPECT_EQ(part && part->from <= t && t <= part->to, seen);
      inside += seen;
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(OverlapRatio, IsOfTheShorterInterval) {
  EXPECT_DOUBLE_EQ(OverlapRatio(LineInterval{0, 4}, LineInterval{3, 5}), 0.5);
  EXPECT_DOUBLE_EQ(OverlapRatio(LineInterval{0, 4}, LineInterval{1, 2}), 1);
  EXPECT_DOUBLE_EQ(OverlapRatio(LineInterval{0, 1}, LineInterval{2, 3}), 0);
}

constexpr int kWidth = 752, kHeight = 480;
constexpr double kTurn = 2 * std::numbers::pi;

std::vector<Segment2> RandomSegments(Rng& rng, std::size_t count) {
  std::vector<Segment2> segments;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d start(rng.Uniform(-5, kWidth + 5), rng.Uniform(-5, kHeight + 5));
    const double angle = rng.Uniform() < 0.2 ? 0.25 * kTurn * static_cast<double>(rng.Index(5))
                                             : rng.Uniform(-kTurn, kTurn);
    const double length = rng.Uniform(10, 200);
    segments.push_back({start, start + length * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
  }
  return segments;
}

SegmentIndex IndexOf(const std::vector<Segment2>& segments) {
  SegmentIndex index(kWidth, kHeight, segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) index.Add(i, segments[i]);
  return index;
}

std::vector<std::size_t> Near(const SegmentIndex& index,
                              const Eigen::AlignedBox2d& box,
                              double angle) {
  std::vector<std::size_t> found;
  index.ForEachNear(
      box, {std::cos(angle), std::sin(angle)}, [&](std::size_t i) { found.push_back(i); });
  return found;
}

TEST(SegmentIndex, LeavesOutNothingNearAndParallel) {
  Rng rng(1, "segments");
  for (const std::size_t count : {1U, 63U, 64U, 65U, 300U}) {
    const std::vector<Segment2> segments = RandomSegments(rng, count);
    const SegmentIndex index = IndexOf(segments);
    std::size_t total = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Vector2d corner(rng.Uniform(-100, kWidth), rng.Uniform(-100, kHeight));
      const Eigen::AlignedBox2d box(
          corner, corner + Eigen::Vector2d(rng.Uniform(1, 150), rng.Uniform(1, 150)));
      const double angle = trial % 8 == 0 ? 0.25 * kTurn * trial : rng.Uniform(-kTurn, kTurn);
      const std::vector<std::size_t> found = Near(index, box, angle);
      ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      total += found.size();
      for (std::size_t i = 0; i < count; ++i) {
        Eigen::AlignedBox2d own(segments[i].start);
        own.extend(segments[i].end);
        const double cosine =
            segments[i].Direction().dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)));
        if (!own.intersects(box) || cosine < 0.95) continue;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i));
      }
    }
    EXPECT_LT(total, 200 * count / 4 + 50) << "some are passed over";
  }
}

TEST(SegmentIndex, TakesABoxWithoutBounds) {
  Rng rng(2, "segments");
  const std::vector<Segment2> segments = RandomSegments(rng, 100);
  const double most = std::numeric_limits<double>::max();
  const Eigen::AlignedBox2d all(Eigen::Vector2d(-most, -most), Eigen::Vector2d(most, most));
  const SegmentIndex index = IndexOf(segments);
  std::vector<bool> found(100, false);
  for (int k = 0; k < 12; ++k) {
    for (const std::size_t i : Near(index, all, kTurn * k / 12)) found[i] = true;
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), true), 100);
}

TEST(SegmentIndex, DoesNotFindWhatIsRemoved) {
  const std::vector<Segment2> segments(70, Segment2{{100, 100}, {200, 100}});
  SegmentIndex index = IndexOf(segments);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(90, 90), Eigen::Vector2d(110, 110));
  ASSERT_EQ(Near(index, box, 0).size(), 70U);
  EXPECT_TRUE(Near(index, box, 0.5 * kTurn).empty()) << "against it";
  index.Remove(66);
  const auto found = Near(index, box, 0);
  EXPECT_EQ(found.size(), 69U);
  EXPECT_FALSE(std::binary_search(found.begin(), found.end(), 66U));
}

TEST(SegmentIndex, HasNothingOfAnEmptyImage) {
  const SegmentIndex index(kWidth, kHeight, 0);
  const Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0), Eigen::Vector2d(110, 110));
  EXPECT_TRUE(Near(index, box, 0).empty());
}

}  // namespace

}  // namespace plumbline
