// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/laboratory_methods.h"

#include "lab/rivals/klt_initializer.h"
#include "lab/rivals/two_view.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/random.h"
#include "plumbline/initialization/rank1_initializer.h"
#include "plumbline/optimization/pose_optimization.h"
#include "plumbline/slam/system.h"

#include "tests/support/moving_poster.h"
#include "tests/support/synthetic_world.h"
#include "tests/tracking/cut_scene.h"
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::CutScene;

CuttingSettings SettingsOf(const std::string& method) {
  CuttingSettings settings;
  settings.method = method;
  settings.choose = LaboratoryMethods().choose_features;
  return settings;
}

PoseProblem CutBy(const std::string& method, const CutScene& scene) {
  return scene.Cut(LineWeighting::kNone, SettingsOf(method));
}

TEST(LaboratoryMethods, AreReadAndRunBySystem) {
  const SystemMethods& methods = LaboratoryMethods();
  Calibration one_camera = MovingPoster::MakeCalibration();
  one_camera.right.reset();
  for (const AddedMethod& method : methods.added) {
    SlamOptions options;
    OptionTable(options, methods.added).Set(method.key + "=" + method.name);
    EXPECT_NO_THROW(System(one_camera, options, {}, methods)) << method.name;
    EXPECT_THROW(System(one_camera, options), InputError) << method.name;
    EXPECT_THROW(OptionTable(options).Set(method.key + "=" + method.name), InputError);
  }
  SlamOptions options;
  options.lines.residual = "projected_ends";  // with a map
  EXPECT_NO_THROW(System(one_camera, options, {}, methods));
  EXPECT_THROW(System(one_camera, options), InputError);
}

TEST(LaboratoryMethods, MakeTheInitializerNamed) {
  const auto make = [&](const std::string& method) {
    return LaboratoryMethods().make_initializer(
        {TestCamera(), 1.2}, {.method = method}, 1, nullptr);
  };
  EXPECT_TRUE(dynamic_cast<Rank1Initializer*>(make("rank1").get()));
  EXPECT_TRUE(dynamic_cast<KltInitializer*>(make("rank1_klt").get()));
  EXPECT_TRUE(dynamic_cast<TwoViewInitializer*>(make("two_view").get()));
  EXPECT_TRUE(dynamic_cast<TwoViewImagesInitializer*>(make("two_view_images").get()));
}

TEST(LaboratoryMethods, OfTheProductCutAsByTheProduct) {
  const CutScene scene;
  const PoseProblem product = scene.Cut();
  const PoseProblem ours = CutBy("greedy", scene);
  ASSERT_EQ(ours.lines.size(), product.lines.size());
  for (std::size_t i = 0; i < ours.lines.size(); ++i) {
    EXPECT_EQ(ours.lines[i].ends.start, product.lines[i].ends.start);
    EXPECT_EQ(ours.lines[i].ends.end, product.lines[i].ends.end);
  }
}

TEST(LaboratoryMethods, KeepThePoseOfExactMeasurements) {
  for (const std::string method : {"greedy_sweeps", "joint", "drop", "best_80_greedy"}) {
    testing::ExpectPoseOfCutLines({}, SettingsOf(method));
    testing::ExpectPoseOfCutLines(LaboratoryMethods().line_method({.residual = "projected_ends"}),
                                  SettingsOf(method));
  }
}

TEST(LaboratoryMethods, DropLeavesLinesOutInBothImages) {
  const CutScene scene;
  const PoseProblem cut = CutBy("drop", scene);
  // 30 % of 12 lines are 3.
  EXPECT_EQ(cut.lines.size(), scene.problem.lines.size() - 6);
  for (std::size_t i = 0; i < cut.lines.size(); i += 2) {
    EXPECT_EQ(cut.lines[i].group, cut.lines[i + 1].group);
    EXPECT_EQ(cut.lines[i].measurement.covariance, scene.problem.lines[0].measurement.covariance);
  }
}

TEST(LaboratoryMethods, TrimGoesToTheMeasuredSegmentAndNoFurther) {
  CutScene scene;
  const RectifiedCamera& camera = scene.problem.camera;
  Segment2& seen = scene.problem.lines[0].measurement.segment;
  seen.end = seen.Midpoint();
  const PoseProblem trimmed = CutBy("trim", scene);
  ASSERT_EQ(trimmed.lines.size(), scene.problem.lines.size());
  for (std::size_t i = 0; i < trimmed.lines.size(); ++i) {
    const Segment3 &whole = scene.problem.lines[i].ends, &piece = trimmed.lines[i].ends;
    EXPECT_LT((piece.start - whole.start).norm(), 1e-6) << i;
    if (i < 2) {  // both images of the first line
      const Eigen::Vector2d shown = camera.Project(piece.end);
      EXPECT_LT((shown - seen.end).norm(), 1e-6) << i;
    } else {
      EXPECT_LT((piece.end - whole.end).norm(), 1e-6) << i;
    }
  }
  EXPECT_GT((trimmed.lines[0].ends.end - scene.problem.lines[0].ends.end).norm(), 0.1);
}

TEST(LaboratoryMethods, KeepToTheBudget) {
  CutScene scene;
  Rng rng(8, "points of a budget");
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d place(rng.Uniform(-2, 2), rng.Uniform(-1.5, 1.5), rng.Uniform(2, 7));
    scene.problem.points.push_back(
        {place, {scene.problem.camera.Project(place), testing::kSigmaPx, {}}});
  }
  for (const std::string method : {"best_80", "best_80_greedy"}) {
    PoseProblem chosen = CutBy(method, scene);
    std::set<int> groups;
    for (const auto& match : chosen.lines) groups.insert(match.group);
    EXPECT_EQ(chosen.points.size() + groups.size(), 80U);
    EXPECT_EQ(chosen.lines.size(), 2 * groups.size());
    EXPECT_FALSE(groups.empty());
    chosen.cam_from_world =
        ExpSe3((Vector6d() << 0.004, -0.003, 0.002, 0.01, -0.02, 0.01).finished());
    EXPECT_LT(LogSe3(SolvePose(chosen).cam_from_world).norm(), 1e-4);
  }
  // A budget that is not reached changes nothing.
  scene.problem.points.resize(60);
  const PoseProblem all = CutBy("best_80", scene);
  EXPECT_EQ(all.points.size(), 60U);
  EXPECT_EQ(all.lines.size(), scene.problem.lines.size());
}

}  // namespace
}  // namespace plumbline
