// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_error.h"

#include "plumbline/base/units.h"

#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector3d;

TrueLine Line(const Vector3d& start, const Vector3d& end) { return {{start, end}}; }

// Along x from `from` to `to`, at y.
Segment3 AlongX(double from, double to, double y = 0) { return {{from, y, 0}, {to, y, 0}}; }

Segment3 Turned(const Segment3& segment, double angle) {
  const Vector3d half = 0.5 * (segment.end - segment.start);
  const Vector3d turned = ExpSo3(angle * Vector3d::UnitY()) * half;
  return {segment.Midpoint() - turned, segment.Midpoint() + turned};
}

LineMapError Compare(const std::vector<TrueLine>& truth, const std::vector<Segment3>& estimate) {
  return CompareLineMaps(truth, estimate, {}, {});
}

TEST(LineMapError, IsNoneForTheTrueLinesThemselves) {
  const std::vector<TrueLine> truth = {Line({0, 0, 0}, {1, 0, 0}), Line({0, 0, 1}, {0, 2, 1})};
  const LineMapError error = Compare(truth, {truth[1].segment.Reversed(), truth[0].segment});
  EXPECT_EQ(error.true_lines, 2U);
  EXPECT_EQ(error.asked_lines, 2U);
  EXPECT_DOUBLE_EQ(error.asked_length, 3);
  EXPECT_DOUBLE_EQ(error.estimated_length, 3);
  ASSERT_EQ(error.at.size(), 4U);
  for (const LineMapErrorAt& at : error.at) {
    EXPECT_DOUBLE_EQ(*at.recall, 1);
    EXPECT_DOUBLE_EQ(*at.precision, 1);
    EXPECT_EQ(at.with_counterpart, 2U);
    EXPECT_LT(*at.median_angle, 1e-12);
    EXPECT_LT(*at.median_distance, 1e-12);
    EXPECT_DOUBLE_EQ(*at.segments_per_line, 1);
    EXPECT_DOUBLE_EQ(*at.multiplicity, 1);
  }
  EXPECT_EQ(error.counterparts[0]->true_line, 1U);
  EXPECT_EQ(error.counterparts[1]->true_line, 0U);
  EXPECT_LT(error.uncovered_length, 1e-12);
  EXPECT_FALSE(error.uncovered_from_surfaces);
}

TEST(LineMapError, CoversUpToTheToleranceBeyondTheEnds) {
  // 3 mm beside a true line of 2 m: sqrt(t^2 - 3^2) mm more at each end.
  const LineMapError error = Compare({Line({0, 0, 0}, {2, 0, 0})}, {AlongX(0.5, 1, 0.003)});
  for (const LineMapErrorAt& at : error.at) {
    const double beyond = std::sqrt(at.tolerance * at.tolerance - 0.003 * 0.003);
    EXPECT_NEAR(*at.recall, (0.5 + 2 * beyond) / 2, 1e-12);
    EXPECT_DOUBLE_EQ(*at.precision, 1);
    EXPECT_NEAR(*at.median_distance, 0.003, 1e-12);
  }
}

TEST(LineMapError, CountsALengthOnceHoweverManySegmentsCoverIt) {
  const std::vector<Segment3> estimate = {AlongX(0, 1), AlongX(0.5, 1.5), AlongX(0.2, 0.4)};
  EXPECT_NEAR(*Compare({Line({0, 0, 0}, {3, 0, 0})}, estimate).at[0].recall, 1.51 / 3, 1e-12);
}

TEST(LineMapError, AsksForAgreeingDirections) {
  const std::vector<TrueLine> truth = {Line({0, 0, 0}, {0.1, 0, 0})};
  const LineMapError agrees = Compare(truth, {Turned(truth[0].segment, 4.9 * kDegree)});
  EXPECT_DOUBLE_EQ(*agrees.at[0].recall, 1);
  EXPECT_NEAR(*agrees.at[0].median_angle, 4.9 * kDegree, 1e-9);
  const LineMapError differs = Compare(truth, {Turned(truth[0].segment, 5.1 * kDegree)});
  EXPECT_EQ(*differs.at[3].recall, 0);
  EXPECT_EQ(*differs.at[3].precision, 0);
  EXPECT_EQ(differs.at[3].with_counterpart, 0U);
  EXPECT_FALSE(differs.at[3].median_angle);
  EXPECT_FALSE(differs.at[3].segments_per_line);
}

TEST(LineMapError, RecallLeavesOutWhatFewFramesSeeAndPrecisionDoesNot) {
  std::vector<TrueLine> truth = {
      Line({0, 0, 0}, {1, 0, 0}), Line({0, 5, 0}, {1, 5, 0}), Line({0, 9, 0}, {1, 9, 0})};
  truth[0].visible = {{0, 1}};          // two frames
  truth[1].visible = {{0, 0}, {5, 6}};  // three
  truth[2].visible.emplace();           // never
  const std::vector<Segment3> estimate = {AlongX(0, 1), AlongX(0, 0.5, 5), AlongX(0, 1, 9)};
  const LineMapError error = Compare(truth, estimate);
  EXPECT_EQ(error.true_lines, 3U);
  EXPECT_EQ(error.asked_lines, 1U);
  EXPECT_DOUBLE_EQ(error.true_length, 3);
  EXPECT_DOUBLE_EQ(error.asked_length, 1);
  EXPECT_NEAR(*error.at[0].recall, 0.51, 1e-12);
  EXPECT_DOUBLE_EQ(*error.at[0].precision, 1);
  LineMapErrorOptions options;
  options.min_visible_frames = 2;
  EXPECT_NEAR(*CompareLineMaps(truth, estimate, {}, options).at[0].recall, 1.51 / 2, 1e-12);
}

TEST(LineMapError, TellsRecallByKind) {
  std::vector<TrueLine> truth = {
      Line({0, 0, 0}, {1, 0, 0}), Line({0, 5, 0}, {1, 5, 0}), Line({0, 9, 0}, {3, 9, 0})};
  truth[1].kind = truth[2].kind = TrueLineKind::kShadow;
  const LineMapErrorAt at = Compare(truth, {AlongX(0, 1), AlongX(0, 3, 9)}).at[0];
  EXPECT_DOUBLE_EQ(*at.recall_by_kind[0], 1);
  EXPECT_FALSE(at.recall_by_kind[1]);
  EXPECT_DOUBLE_EQ(*at.recall_by_kind[2], 0.75);
  EXPECT_DOUBLE_EQ(*at.recall, 0.8);
}

TEST(LineMapError, CounterpartIsTheNearestOfThoseThatCoverAboutAsMuch) {
  const std::vector<TrueLine> truth = {
      Line({0, 0.008, 0}, {1, 0.008, 0}),       // covers all of it, 6 mm away
      Line({0.05, 0, 0}, {1, 0, 0}),            // a little less, 2 mm away
      Line({0.4, 0.002, 0}, {0.6, 0.002, 0})};  // a fifth, in its place
  const LineMapError error = Compare(truth, {AlongX(0, 1, 0.002)});
  ASSERT_TRUE(error.counterparts[0]);
  EXPECT_EQ(error.counterparts[0]->true_line, 1U);
  EXPECT_EQ(error.counterparts[0]->tolerance, 0U);
  EXPECT_NEAR(error.counterparts[0]->distance, 0.002, 1e-12);
}

TEST(LineMapError, CounterpartComesWithTheToleranceThatCoversHalf) {
  const std::vector<TrueLine> truth = {Line({0, 0, 0}, {1, 0, 0}),
                                       Line({0, 0.09, 0}, {1, 0.09, 0})};
  const LineMapError error =
      Compare(truth, {AlongX(0, 1, 0.03), AlongX(0.92, 2, 0), AlongX(0, 1, 7)});
  ASSERT_TRUE(error.counterparts[0]);
  EXPECT_EQ(error.counterparts[0]->tolerance, 2U);  // 5 cm
  EXPECT_EQ(error.counterparts[0]->true_line, 0U);
  EXPECT_FALSE(error.counterparts[1]);  // 18 cm of 108 at the most
  EXPECT_FALSE(error.counterparts[2]);
  EXPECT_EQ(error.at[1].with_counterpart, 0U);
  EXPECT_EQ(error.at[2].with_counterpart, 1U);
  EXPECT_EQ(error.at[3].with_counterpart, 1U);
}

TEST(LineMapError, ASegmentOverManyTrueOnesHasItsCounterpartAmongThem) {
  const std::vector<TrueLine> tiles = {
      Line({0, 0, 0}, {0.3, 0, 0}), Line({0.3, 0, 0}, {0.7, 0, 0}), Line({0.7, 0, 0}, {1, 0, 0})};
  const LineMapError error = Compare(tiles, {AlongX(0, 1)});
  ASSERT_TRUE(error.counterparts[0]);
  EXPECT_EQ(error.counterparts[0]->true_line, 1U);
  EXPECT_DOUBLE_EQ(*error.at[0].recall, 1);
  EXPECT_DOUBLE_EQ(*error.at[0].segments_per_line, 1);
}

TEST(LineMapError, TellsPiecesFromDuplicates) {
  const std::vector<TrueLine> truth = {Line({0, 0, 0}, {1, 0, 0}), Line({0, 3, 0}, {1, 3, 0})};
  const LineMapErrorAt pieces =
      Compare(truth, {AlongX(0, 0.5), AlongX(0.5, 1), AlongX(0, 1, 3)}).at[3];
  EXPECT_DOUBLE_EQ(*pieces.segments_per_line, 1.5);
  EXPECT_DOUBLE_EQ(*pieces.multiplicity, 1);
  const LineMapErrorAt copies =
      Compare(truth, {AlongX(0, 1, 0.01), AlongX(0, 1), AlongX(0, 1, 3)}).at[3];
  EXPECT_DOUBLE_EQ(*copies.segments_per_line, 1.5);
  EXPECT_DOUBLE_EQ(*copies.multiplicity, 1.5);
  // What lies beyond the end of the true line is not mapped twice.
  const LineMapErrorAt beyond = Compare(truth, {AlongX(0.5, 1.05), AlongX(0.9, 1.08)}).at[3];
  EXPECT_NEAR(*beyond.multiplicity, 0.6 / 0.5, 1e-12);
}

TEST(LineMapError, TellsLinesOnSurfacesFromLinesInTheAir) {
  const std::vector<TrueLine> truth = {Line({0, 0, 0}, {1, 0, 0})};
  const std::vector<Parallelogram> wall = {{{-1, 0, -5}, {10, 0, 0}, {0, 0, 10}}};  // y = 0
  const std::vector<Segment3> estimate = {
      AlongX(0, 1),                  // true
      {{0, 0.01, 2}, {3, 0.01, 2}},  // a line on the wall that nobody listed, 3 m
      {{0, 0.4, 2}, {1, 0.4, 2}}};   // in the air, 1 m
  const LineMapError error = CompareLineMaps(truth, estimate, wall, {});
  EXPECT_NEAR(error.uncovered_length, 4, 1e-12);
  ASSERT_TRUE(error.uncovered_from_surfaces);
  EXPECT_NEAR(error.uncovered_from_surfaces->median, 0.01, 1e-12);
  EXPECT_NEAR(error.uncovered_from_surfaces->share_beyond, 0.25, 1e-9);
  EXPECT_FALSE(CompareLineMaps(truth, estimate, {}, {}).uncovered_from_surfaces);
  EXPECT_FALSE(CompareLineMaps(truth, {{AlongX(0, 1)}}, wall, {}).uncovered_from_surfaces);
}

TEST(LineMapError, UncoveredIsWhatLiesBetween) {
  const std::vector<TrueLine> truth = {Line({1, 0, 0}, {2, 0, 0}), Line({3, 0, 0}, {4, 0, 0})};
  EXPECT_NEAR(Compare(truth, {AlongX(0, 6)}).uncovered_length, 0.9 + 0.8 + 1.9, 1e-12);
}

TEST(LineMapError, HasNoSharesOfNothing) {
  const LineMapError nothing = Compare({}, {});
  EXPECT_FALSE(nothing.at[0].recall);
  EXPECT_FALSE(nothing.at[0].precision);
  const LineMapError no_map = Compare({Line({0, 0, 0}, {1, 0, 0})}, {});
  EXPECT_EQ(no_map.at[0].recall, 0);
  EXPECT_FALSE(no_map.at[0].precision);
  const LineMapError no_truth = Compare({}, {AlongX(0, 1)});
  EXPECT_FALSE(no_truth.at[0].recall);
  EXPECT_EQ(no_truth.at[0].precision, 0);
  const LineMapError point = Compare({Line({0, 0, 0}, {1, 0, 0})}, {AlongX(0.5, 0.5)});
  EXPECT_EQ(point.at[3].recall, 0);
  EXPECT_FALSE(point.at[3].precision);
  EXPECT_FALSE(point.counterparts[0]);
}

// A world of sticks, and estimates of some of them that are off, cut and doubled.
struct Sticks {
  std::vector<TrueLine> truth;
  std::vector<Segment3> estimate;
};

Sticks MakeSticks(std::uint64_t seed) {
  Rng rng(seed);
  Sticks sticks;
  for (int i = 0; i < 60; ++i) {
    const Vector3d start = RandomVector<3>(rng, 0.5);
    const Vector3d direction = (Vector3d::Unit(i % 3) + RandomVector<3>(rng, 0.02)).normalized();
    TrueLine line = Line(start, start + rng.Uniform(0.05, 1) * direction);
    line.kind = static_cast<TrueLineKind>(i % 3);
    line.visible = {{0, i % 8}};
    sticks.truth.push_back(line);
    for (int copy = 0; copy < i % 3; ++copy) {
      const Vector3d shift = rng.Uniform(-0.3, 0.3) * direction;
      sticks.estimate.push_back({line.segment.start + shift + RandomVector<3>(rng, 0.01),
                                 line.segment.end + shift + RandomVector<3>(rng, 0.01)});
    }
  }
  return sticks;
}

// Share of points of the segments that one of the others covers, straight from the definition.
double SampledShare(const std::vector<Segment3>& segments,
                    const std::vector<Segment3>& others,
                    double tolerance) {
  constexpr double kStep = 2e-4;
  double covered = 0, all = 0;
  for (const Segment3& segment : segments) {
    const int count = static_cast<int>(std::ceil(segment.Length() / kStep));
    const double step = segment.Length() / count;
    for (int k = 0; k < count; ++k) {
      const Vector3d point = segment.start + (k + 0.5) * step * segment.Direction();
      all += step;
      const bool near = std::any_of(others.begin(), others.end(), [&](const Segment3& other) {
        const double cosine = std::abs(segment.Direction().dot(other.Direction()));
        return cosine >= std::cos(5 * kDegree) && Distance(other, point) <= tolerance;
      });
      if (near) covered += step;
    }
  }
  return covered / all;
}

TEST(LineMapError, AgreesWithDenseSampling) {
  const Sticks sticks = MakeSticks(4);
  std::vector<Segment3> asked, all;
  for (const TrueLine& line : sticks.truth) {
    all.push_back(line.segment);
    if (line.VisibleFrames() >= 3) asked.push_back(line.segment);
  }
  const LineMapError error = Compare(sticks.truth, sticks.estimate);
  EXPECT_EQ(error.asked_lines, asked.size());
  for (const LineMapErrorAt& at : error.at) {
    EXPECT_NEAR(*at.recall, SampledShare(asked, sticks.estimate, at.tolerance), 2e-4);
    EXPECT_NEAR(*at.precision, SampledShare(sticks.estimate, all, at.tolerance), 2e-4);
  }
  EXPECT_GT(*error.at[0].recall, 0.02);
  EXPECT_GT(*error.at[3].recall, *error.at[0].recall + 0.1);
  EXPECT_LT(*error.at[3].recall, 0.98);
  EXPECT_LT(*error.at[3].precision, 0.98);
}

TEST(LineMapError, DoesNotDependOnOrderDirectionOrWorld) {
  const Sticks sticks = MakeSticks(9);
  const LineMapError before = Compare(sticks.truth, sticks.estimate);
  Rng rng(1);
  const Rigid3 motion = RandomRigid(rng);
  Sticks other = sticks;
  for (TrueLine& line : other.truth) {
    line.segment = {motion * line.segment.end, motion * line.segment.start};
  }
  for (Segment3& segment : other.estimate) segment = {motion * segment.start, motion * segment.end};
  std::reverse(other.truth.begin(), other.truth.end());
  std::reverse(other.estimate.begin(), other.estimate.end());
  const LineMapError after = Compare(other.truth, other.estimate);
  for (std::size_t t = 0; t < before.at.size(); ++t) {
    EXPECT_NEAR(*before.at[t].recall, *after.at[t].recall, 1e-9);
    EXPECT_NEAR(*before.at[t].precision, *after.at[t].precision, 1e-9);
    EXPECT_EQ(before.at[t].with_counterpart, after.at[t].with_counterpart);
    EXPECT_NEAR(*before.at[t].median_angle, *after.at[t].median_angle, 1e-9);
    EXPECT_NEAR(*before.at[t].median_distance, *after.at[t].median_distance, 1e-9);
    EXPECT_NEAR(*before.at[t].segments_per_line, *after.at[t].segments_per_line, 1e-9);
    EXPECT_NEAR(*before.at[t].multiplicity, *after.at[t].multiplicity, 1e-9);
  }
}

}  // namespace
}  // namespace plumbline
