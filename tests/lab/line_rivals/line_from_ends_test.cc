// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/line_from_ends.h"

#include "tests/support/true_map.h"
#include <cstddef>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace line_from_ends_test {

const Segment3 kUpright{{-0.5, -1, 5}, {-0.3, 1, 5.5}};
// Half along the way of the camera, so that a shift of its ends is parallax.
const Segment3 kSlanting{{-1, -0.3, 5}, {1, 0.7, 5}};

// Two keyframes of one camera, the second `baseline` to the right, that show a line, each its own
// piece of it, without noise.
struct TwoPieces {
  RectifiedCamera camera = TestCamera();
  Map map;

  TwoPieces(const Segment3& in_first, const Segment3& in_second, double baseline) {
    Add({}, in_first);
    Add({Eigen::Quaterniond::Identity(), {-baseline, 0, 0}}, in_second);
  }

  void Add(const Rigid3& pose, const Segment3& piece) {
    Features features;
    LineFeature feature;
    feature.sigma_px = 0.4;
    feature.segment = *ProjectSegment(camera, {pose * piece.start, pose * piece.end});
    features.lines.push_back(feature);
    features.line_right.push_back({});
    SyntheticFrame sensed;
    sensed.indexed = IndexFeatures(camera, std::move(features));
    sensed.line_truth.push_back(0);
    AddKeyFrameTo(map, pose, sensed);
  }

  std::optional<MapLine> FromEnds() const {
    return LineFromTwoEnds(map, camera, {{KeyFrameId{0}, 0}, {KeyFrameId{1}, 0}});
  }
  std::optional<MapLine> FromPlanes() const {
    return LineFromViews(map, camera, {{KeyFrameId{0}, 0}, {KeyFrameId{1}, 0}});
  }
};

double DistanceFrom(const std::optional<MapLine>& line, const Segment3& truth) {
  return line->line.DistanceTo(truth.start) + line->line.DistanceTo(truth.end);
}

Segment3 Slid(const Segment3& segment, double by) {
  const Eigen::Vector3d step = by * segment.Direction();
  return {segment.start + step, segment.end + step};
}

TEST(LineFromTwoEnds, HasTheEndsThatBothViewsShow) {
  const TwoPieces seen(kUpright, kUpright, 0.4);
  const auto line = seen.FromEnds();
  ASSERT_TRUE(line);
  EXPECT_LT(DistanceFrom(line, kUpright), 1e-6);
  EXPECT_NEAR(line->end - line->start, kUpright.Length(), 1e-6);
  EXPECT_EQ(line->observations.size(), 2U);
  EXPECT_GT(line->information.norm(), 0);
}

// What two planes do not notice.
TEST(LineFromTwoEnds, EndsThatShiftMakeAWrongLine) {
  const TwoPieces seen(kSlanting, Slid(kSlanting, 0.03), 0.6);
  ASSERT_TRUE(seen.FromPlanes());
  EXPECT_LT(DistanceFrom(seen.FromPlanes(), kSlanting), 1e-6);
  ASSERT_TRUE(seen.FromEnds());
  EXPECT_GT(DistanceFrom(seen.FromEnds(), kSlanting), 0.1);
}

// Across the way of the camera, an end that shifts is a point half way.
TEST(LineFromTwoEnds, EndsMayShiftAcrossTheParallax) {
  const Segment3 upright{{0, -1, 5}, {0, 1, 5}};
  const TwoPieces seen(upright, Slid(upright, 0.2), 0.4);
  ASSERT_TRUE(seen.FromEnds());
  EXPECT_LT(DistanceFrom(seen.FromEnds(), upright), 1e-3);
  EXPECT_NEAR(
      seen.FromEnds()->line.ParameterOf(Slid(upright, 0.1).end), seen.FromEnds()->end, 0.01);
}

TEST(LineFromTwoEnds, NeedsParallaxOfBothEndsAndLinesThatAreTheSame) {
  EXPECT_FALSE(TwoPieces(kUpright, kUpright, 0.05).FromEnds());
  Segment3 other = kUpright;
  other.end.x() += 2;
  other.end.y() = 0;
  EXPECT_FALSE(TwoPieces(kUpright, other, 0.4).FromEnds());
  const TwoPieces seen(kUpright, kUpright, 0.4);
  const LineViewOf first{KeyFrameId{0}, 0};
  const LineViewOf second{KeyFrameId{1}, 0};
  EXPECT_FALSE(LineFromTwoEnds(seen.map, seen.camera, {first, second, second}));
}

}  // namespace line_from_ends_test
}  // namespace plumbline
