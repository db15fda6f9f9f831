// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_rivals/rival_method.h"

#include "plumbline/base/error.h"
#include "plumbline/mapping/landmark_creation.h"
#include "plumbline/mapping/local_ba_window.h"
#include "plumbline/slam/options.h"

#include "tests/support/synthetic_run.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::array kParametrizations{LineParametrization::kPlucker,
                                       LineParametrization::kPluckerLeft,
                                       LineParametrization::kEndpoints};
constexpr std::array kResiduals{LineResidualKind::kObservedEnds, LineResidualKind::kProjectedEnds};
constexpr std::array kReconstructions{LineReconstruction::kNView, LineReconstruction::kTwoView};

TEST(MethodFor, DoesWhatTheOptionsSayAndTheProductRefuses) {
  for (const auto parametrization : kParametrizations) {
    for (const auto residual : kResiduals) {
      for (const auto reconstruction : kReconstructions) {
        SlamOptions options;
        options.lines.parametrization = parametrization;
        options.lines.residual = residual;
        options.lines.reconstruction = reconstruction;
        const bool product = parametrization == LineParametrization::kPlucker &&
                             residual == LineResidualKind::kObservedEnds &&
                             reconstruction == LineReconstruction::kNView;
        if (!product) {
          EXPECT_THROW(CheckOptions(options), InputError);
        }
        options.lines.method = MethodFor(options.lines);
        EXPECT_NO_THROW(CheckOptions(options));
      }
    }
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
  const auto most_views = [&](LineReconstruction reconstruction) {
    LineOptions lines{.reconstruction = reconstruction};
    lines.method = MethodFor(lines);
    std::size_t most = 0;
    for (const MapChange& change :
         CreateLinesFromViews(scene.map, world.Imaging(), KeyFrameId{2}, lines)) {
      const auto* add = std::get_if<edit::AddLine>(&change);
      if (add != nullptr) most = std::max(most, add->line.observations.size());
    }
    return most;
  };
  EXPECT_EQ(most_views(LineReconstruction::kNView), 3U);
  EXPECT_EQ(most_views(LineReconstruction::kTwoView), 2U);
}

// The covariances become those of the projected ends, and no line is held parallel, which the
// solver would refuse.
TEST(MethodFor, CompletesWindowsForProjectedEnds) {
  const SyntheticWorld world = MakeSyntheticWorld(300, 40);
  const TrueMap scene = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(5), PoseOnPath(10)}, {});
  LineOptions lines{.residual = LineResidualKind::kProjectedEnds};
  BaProblem observed =
      MakeLocalBaWindow(scene.map, world.Imaging(), KeyFrameId{2}, lines, {}).problem;
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

TEST(MethodFor, FollowsASmoothPathByEachKindOfLine) {
  const SyntheticWorld world = MakeSyntheticWorld(600, 120);
  for (const auto parametrization : kParametrizations) {
    for (const auto residual : kResiduals) {
      SlamOptions options = SyntheticRun::InlineOptions();
      options.lines.parametrization = parametrization;
      options.lines.residual = residual;
      options.lines.method = MethodFor(options.lines);
      options.cutting.method = CuttingMethod::kGreedy;
      SyntheticRun run(world, options);
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
