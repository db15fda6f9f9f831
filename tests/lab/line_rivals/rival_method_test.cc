// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_method.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/mapping/landmark_creation.h"
#include "plumbline/mapping/landmark_culling.h"
#include "plumbline/mapping/local_ba_window.h"
#include "plumbline/slam/options.h"

#include "tests/support/synthetic_run.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// The names of lines.residual, by the residual and by what else they say.
const std::array<std::vector<std::string>, 2> kResiduals = {
    std::vector<std::string>{"observed_ends", "plucker_left", "endpoints"},
    std::vector<std::string>{"projected_ends", "projected_plucker_left", "projected_endpoints"}};

LineSettings SettingsOf(const LineOptions& options) { return {options, MethodFor(options)}; }

TEST(MethodFor, HasTheMethodsOfTheProductAndThoseThatAreAdded) {
  std::vector<AddedMethod> added = AddedLineMethods();
  for (const auto& residuals : kResiduals) {
    for (const std::string& residual : residuals) {
      SlamOptions options;
      OptionTable table(options, added);
      table.Set("lines.residual=" + residual);
      table.Set("lines.reconstruction=two_view");
      EXPECT_THROW(CheckOptions(options), InputError);
      EXPECT_NO_THROW(CheckOptions(options, {.added = added, .line_method = MethodFor}));
    }
  }
}

TEST(RivalLinesOf, ReadsResidualAndParameters) {
  constexpr std::array kParametrizations{LineParametrization::kPlucker,
                                         LineParametrization::kPluckerLeft,
                                         LineParametrization::kEndpoints};
  for (std::size_t i = 0; i < kParametrizations.size(); ++i) {
    EXPECT_EQ(RivalLinesOf(kResiduals[0][i]).parametrization, kParametrizations[i]);
    EXPECT_EQ(RivalLinesOf(kResiduals[1][i]).parametrization, kParametrizations[i]);
    EXPECT_EQ(RivalLinesOf(kResiduals[0][i]).residual, LineResidualKind::kObservedEnds);
    EXPECT_EQ(RivalLinesOf(kResiduals[1][i]).residual, LineResidualKind::kProjectedEnds);
  }
}

TEST(MethodFor, MakesLinesOfPairsWhereTwoViewsAreAskedFor) {
  const SyntheticWorld world = MakeSyntheticWorld(200, 300);
  TrueMap scene = MakeTrueMap(world,
                              {PoseOnPath(0), PoseOnPath(15), PoseOnPath(30)},
                              {.depth = false, .noise = 0.3, .missed = 0});
  MapEdit without_lines;
  for (const auto& [index, id] : scene.line_of) without_lines.push_back(edit::RemoveLine{id});
  scene.map.Apply(without_lines);
  const auto most_views = [&](const std::string& reconstruction) {
    const LineSettings lines = SettingsOf({.reconstruction = reconstruction});
    std::size_t most = 0;
    for (const MapChange& change :
         CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{2}, lines)) {
      const auto* add = std::get_if<edit::AddLine>(&change);
      if (add != nullptr) most = std::max(most, add->landmark.observations.size());
    }
    return most;
  };
  EXPECT_EQ(most_views("n_view"), 3U);
  EXPECT_EQ(most_views("two_view"), 2U);
}

// The covariances become those of the projected ends, and no line is held parallel, which the
// solver would refuse.
TEST(MethodFor, CompletesWindowsForProjectedEnds) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(5), PoseOnPath(10)}, {});
  const LineOptions lines{.residual = "projected_ends"};
  BaProblem observed =
      MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{2}, {lines}, {}).problem;
  observed.axes = {Eigen::Vector3d::UnitY()};
  observed.parallel_lines = {{0, 0, 0.01}};
  const LineMethod method = MethodFor(lines);
  EXPECT_THROW(method.adjust_window(observed, {}, {}), BugError);
  BaProblem projected = observed;
  method.complete_window(lines.weights(), projected);
  int correlated = 0;
  for (const auto& o : projected.line_observations) {
    correlated += o.measurement.covariance(0, 1) != 0;
  }
  EXPECT_GT(2 * correlated, static_cast<int>(projected.line_observations.size()));
  EXPECT_NE(method.adjust_window(projected, {}, {}).termination, BaTermination::kNotFinite);
  // At the end of a run the residual is that of the observed ends.
  EXPECT_NO_THROW(method.adjust_map(observed, {}, {}));
}

// A map with one line pulled out along itself by twice its length, and the line's length then.
struct PulledLine {
  Map map;
  LineId id;
  double length = 0;

  double Length() const {
    const MapLine& line = *map.Find(id);
    return line.end - line.start;
  }
};

PulledLine PullALine(const SyntheticWorld& world) {
  TrueMap scene = MakeTrueMap(
      world, {PoseOnPath(0), PoseOnPath(8), PoseOnPath(16), PoseOnPath(24)}, {.noise = 0.3});
  PulledLine pulled;
  for (const auto& [id, line] : scene.map.lines()) {
    if (line.observations.size() == 4) pulled.id = id;
  }
  const MapLine line = *scene.map.Find(pulled.id);
  const double end = line.end + 2 * (line.end - line.start);
  scene.map.Apply({edit::MoveLine{line.id, line.line, line.start, end, line.information}});
  pulled.map = std::move(scene.map);
  pulled.length = end - line.start;
  return pulled;
}

// The ends come from the map into the adjustment and go back from it into the map; nothing cuts
// them to what a view shows, neither there nor when the run ends.
TEST(MethodFor, EndsPulledAlongTheirLineStayThereInTheMap) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  for (const auto& residuals : kResiduals) {
    for (const std::string& residual : residuals) {
      PulledLine pulled = PullALine(world);
      const LineSettings lines = SettingsOf({.residual = residual});
      for (int round = 0; round < 2; ++round) {
        const LocalBaWindow window =
            MakeLocalBaWindow(pulled.map, world.Imaging(), KeyFrameId{3}, lines, {});
        ASSERT_NE(std::find(window.lines.begin(), window.lines.end(), pulled.id),
                  window.lines.end());
        const BaResult result = lines.method.adjust_window(window.problem, {}, {});
        pulled.map.Apply(ToEdit(pulled.map, world.Imaging(), window, result));
      }
      const double length = pulled.Length();
      if (residual.ends_with("endpoints")) {
        EXPECT_NEAR(length, pulled.length, 0.2 * pulled.length);
      } else {
        EXPECT_LT(length, 0.5 * pulled.length) << "the rest is not in view";
      }
    }
  }
}

TEST(MethodFor, RemovingOutliersLeavesEndsWhereTheyAre) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  for (const std::string& residual : kResiduals[0]) {
    PulledLine pulled = PullALine(world);
    const LineSettings lines = SettingsOf({.residual = residual});
    // One view now shows another line.
    const KeyFrameId wrong{1};
    const int seen = pulled.map.Find(pulled.id)->observations.at(wrong);
    const auto& shown = pulled.map.Find(wrong)->frame.lines;
    const int other = seen == 0 ? 1 : 0;
    pulled.map.Apply({edit::RemoveLine{shown[static_cast<std::size_t>(other)]},
                      edit::RemoveLineObservation{pulled.id, wrong},
                      edit::AddLineObservation{pulled.id, wrong, other}});
    pulled.map.Apply(RemoveOutliers(pulled.map, world.Imaging(), lines));
    ASSERT_FALSE(pulled.map.Find(pulled.id)->observations.contains(wrong));
    if (lines.method.keeps_ends) {
      EXPECT_NEAR(pulled.Length(), pulled.length, 0.05 * pulled.length);
    } else {
      EXPECT_LT(pulled.Length(), 0.5 * pulled.length);
    }
  }
}

TEST(MethodFor, FollowsASmoothPathByEachKindOfLine) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 120);
  for (const auto& residuals : kResiduals) {
    for (const std::string& residual : residuals) {
      SlamOptions options = SyntheticRun::InlineOptions();
      options.lines.residual = residual;
      options.cutting.method = "greedy";
      SyntheticRun run(world, options, {.line_method = MethodFor});
      for (int i = 0; i <= 30; ++i) {
        const TrackingResult result = run.Step(PoseOnPath(i), {});
        ASSERT_TRUE(result.cam_from_world) << i;
        EXPECT_LT(CentreDistance(*result.cam_from_world, PoseOnPath(i)), 0.04) << i;
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
