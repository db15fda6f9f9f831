// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/pose_optimization.h"

#include "plumbline/geometry/covariance.h"
#include "plumbline/optimization/residuals.h"

#include "tests/optimization/pose_scene.h"
#include <iterator>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace plumbline {
namespace pose_optimization_test {

static_assert(OptionGroup<PoseOnlyOptions>);

using testing::MakePoseScene;
using Scene = testing::PoseScene;

double Error(const Rigid3& a, const Rigid3& b) { return LogSe3(a * Inverse(b)).norm(); }

TEST(SolvePose, RecoversTheExactPoseWithoutNoise) {
  for (const bool disparity : {false, true}) {
    const Scene scene = MakePoseScene(1, {.disparity = disparity});
    const auto result = SolvePose(scene.problem, {.decrement_tolerance = 1e-14});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(Error(result.cam_from_world, scene.truth), 1e-9);
    EXPECT_EQ(result.inlier_points, 200);
    EXPECT_EQ(result.inlier_line_groups, 50);
  }
}

TEST(SolvePose, RecoversThePoseFromPointsAloneAndFromLinesAlone) {
  for (const auto& [points, lines] : {std::pair{100, 0}, std::pair{0, 40}}) {
    const Scene scene = MakePoseScene(2, {.points = points, .lines = lines});
    const auto result = SolvePose(scene.problem, {.decrement_tolerance = 1e-14});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(Error(result.cam_from_world, scene.truth), 1e-9);
  }
}

// A prior beside the truth: the pose moves towards it as far as the two informations say.
TEST(SolvePose, WeighsThePriorAgainstTheMatches) {
  Scene scene = MakePoseScene(2, {.points = 30, .lines = 10});
  const PoseOnlyOptions options{.decrement_tolerance = 1e-14};
  const PoseOnlyResult alone = SolvePose(scene.problem, options);
  Vector6d away;
  away << 2e-4, -1e-4, 1e-4, 1e-3, 2e-3, -1e-3;
  scene.problem.prior.cam_from_world = ExpSe3(away) * scene.truth;
  scene.problem.prior.information = 0.5 * alone.information;
  const PoseOnlyResult both = SolvePose(scene.problem, options);
  const Vector6d moved = LogSe3(both.cam_from_world * Inverse(scene.truth));
  EXPECT_LT((moved - away / 3).norm(), 0.01 * away.norm());
  EXPECT_LT((both.information - 1.5 * alone.information).norm(), 0.01 * alone.information.norm());
}

// The residuals are differentiated by the centre of the camera and the turn about the axes of the
// world, in which the covariance is given out.
TEST(SolvePose, CovarianceOfThePoseIsTheInverseOfTheNormalMatrix) {
  const Scene scene = MakePoseScene(4, {.points = 12, .lines = 5, .disparity = true});
  const PoseOnlyResult result = SolvePose(scene.problem, {.decrement_tolerance = 1e-14});
  ASSERT_TRUE(result.converged);
  ASSERT_EQ(result.inlier_points, 12);
  const Rigid3 world_from_cam = Inverse(result.cam_from_world);
  const auto residuals = [&](const Vector6d& error) {
    const Rigid3 cam_from_world = Inverse({ExpSo3(error.tail<3>()) * world_from_cam.rotation,
                                           world_from_cam.translation + error.head<3>()});
    std::vector<double> rows;
    for (const auto& match : scene.problem.points) {
      const auto at = EvaluatePoint(
          scene.problem.camera, cam_from_world, match.point_in_world, match.measurement);
      for (const double r : at->r) rows.push_back(r);
    }
    for (const auto& match : scene.problem.lines) {
      const auto at = EvaluateLine(scene.problem.camera,
                                   cam_from_world,
                                   ToOrthonormal(match.line_in_world),
                                   match.measurement);
      for (const double r : at->r) rows.push_back(r);
    }
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(rows.data(), std::ssize(rows)));
  };
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd J(residuals(Vector6d::Zero()).size(), 6);
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    J.col(i) = (residuals(step) - residuals(-step)) / (2 * kStep);
  }
  const Matrix6d expected = (J.transpose() * J).inverse();
  const Matrix6d found = PoseCovarianceInWorld(result.cam_from_world, result.information.inverse());
  EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm());
}

TEST(SolvePose, PriorStandsInForWhatMatchesLeaveOpen) {
  Scene scene = MakePoseScene(2, {.points = 2, .lines = 0});
  EXPECT_FALSE(SolvePose(scene.problem).converged);
  scene.problem.prior = {scene.truth, 1e4 * Matrix6d::Identity()};
  const PoseOnlyResult result = SolvePose(scene.problem);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(Error(result.cam_from_world, scene.truth), 1e-4);
}

// Every other point is not where the map has it, by as much as its covariance says: with it the
// pose is better, and its information says how good it is.
TEST(SolvePose, WeighsPointsByTheCovarianceOfTheirPlaces) {
  constexpr int kSeeds = 100;
  double chi2 = 0;
  double with_covariance = 0;
  double without = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    Scene scene = MakePoseScene(seed, {.points = 100, .lines = 0, .sigma = 1});
    testing::Random random(1000 + seed);
    const Rigid3 world_from_cam = Inverse(scene.truth);
    for (std::size_t i = 0; i < scene.problem.points.size(); i += 2) {
      auto& match = scene.problem.points[i];
      const Eigen::Vector3d ray = match.point_in_world - world_from_cam.translation;
      const Eigen::Vector3d off =
          0.03 * (ray + 0.5 * ray.norm() * random.NormalVector(1).normalized());
      match.point_in_world += random.Normal(1) * off;
      match.point_covariance = off * off.transpose();
    }
    const auto with = SolvePose(scene.problem);
    EXPECT_TRUE(with.converged) << seed;
    const Vector6d error = LogSe3(with.cam_from_world * Inverse(scene.truth));
    chi2 += error.dot(with.information * error) / kSeeds;
    for (auto& match : scene.problem.points) match.point_covariance.setZero();
    with_covariance += error.squaredNorm();
    const Rigid3 alone = SolvePose(scene.problem).cam_from_world;
    without += LogSe3(alone * Inverse(scene.truth)).squaredNorm();
  }
  EXPECT_NEAR(chi2, 6, 1.2);
  EXPECT_LT(with_covariance, 0.7 * without);
}

// Its residual has no covariance at the initial pose; it must not pass for exact at a better one.
TEST(SolvePose, UncertainPointsBehindTheInitialPoseDoNotCount) {
  Scene scene = MakePoseScene(3, {.points = 100, .lines = 0});
  auto& match = scene.problem.points[0];
  match.point_covariance = 0.1 * Eigen::Matrix3d::Identity();
  match.point_in_world = Inverse(scene.problem.cam_from_world) * Eigen::Vector3d(0, 0, -0.01);
  match.measurement.px =
      scene.problem.camera.Project(scene.truth * scene.problem.points[1].point_in_world);
  const auto result = SolvePose(scene.problem);
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.point_inliers[0]);
  EXPECT_EQ(result.inlier_points, 99);
  EXPECT_LT(Error(result.cam_from_world, scene.truth), 1e-4);
}

// Every seed: 30 % gross outliers, start several tens of pixels off.
TEST(SolvePose, FindsThePoseAmongGrossOutliersFromAFarStart) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Scene scene = MakePoseScene(
        seed, {.sigma = 1, .outliers = 0.3, .rotation_error = 0.05, .translation_error = 0.2});
    const auto result = SolvePose(scene.problem);
    EXPECT_TRUE(result.converged) << seed;
    const Vector6d error = LogSe3(result.cam_from_world * Inverse(scene.truth));
    EXPECT_LT(error.dot(result.information * error), 30) << seed;  // chi2, 6 dof: 22.5 at 99.9 %
    for (std::size_t i = 0; i < scene.point_outlier.size(); ++i) {
      if (!scene.point_outlier[i]) continue;
      // A gross outlier may fall near its own landmark by chance.
      const auto r = EvaluatePoint(scene.problem.camera,
                                   scene.truth,
                                   scene.problem.points[i].point_in_world,
                                   scene.problem.points[i].measurement);
      EXPECT_TRUE(r->r.norm() <= 5 || !result.point_inliers[i]) << seed << " point " << i;
    }
    for (std::size_t i = 0; i < scene.line_outlier.size(); ++i) {
      const auto r = EvaluateLine(scene.problem.camera,
                                  scene.truth,
                                  ToOrthonormal(scene.problem.lines[i].line_in_world),
                                  scene.problem.lines[i].measurement);
      EXPECT_TRUE(r->r.norm() <= 5 || !scene.line_outlier[i] || !result.line_inliers[i])
          << seed << " line " << i;
    }
    EXPECT_GT(result.inlier_points, 0.85 * 0.6 * 200);
    EXPECT_GT(result.inlier_line_groups, 0.85 * 0.6 * 50);
  }
}

TEST(SolvePose, AcceptsNinetyFivePercentOfCorrectMatches) {
  int points = 0;
  int groups = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto result = SolvePose(MakePoseScene(seed, {.sigma = 1}).problem);
    points += result.inlier_points;
    groups += result.inlier_line_groups;
  }
  EXPECT_NEAR(points / (20.0 * 200), 0.95, 0.015);
  EXPECT_NEAR(groups / (20.0 * 50), 0.95, 0.02);
}

TEST(SolvePose, MeasurementsOfOneLineAreKeptOrRejectedTogether) {
  Scene scene = MakePoseScene(3, {.sigma = 1, .outliers = 0});
  scene.problem.lines[7].measurement.segment.start += Eigen::Vector2d(40, 40);
  const auto result = SolvePose(scene.problem);
  EXPECT_FALSE(result.line_inliers[6]);
  EXPECT_FALSE(result.line_inliers[7]);
}

TEST(SolvePose, InformationIsTheSumOfSquaredJacobiansOfTheInliers) {
  const Scene scene = MakePoseScene(4, {.sigma = 1, .outliers = 0.1});
  const auto result = SolvePose(scene.problem);
  Matrix6d H = Matrix6d::Zero();
  double cost = 0;
  for (std::size_t i = 0; i < scene.problem.points.size(); ++i) {
    if (!result.point_inliers[i]) continue;
    const auto& match = scene.problem.points[i];
    const auto r = EvaluatePoint(
        scene.problem.camera, result.cam_from_world, match.point_in_world, match.measurement);
    H += r->J_pose.transpose() * r->J_pose;
    cost += 0.5 * r->r.squaredNorm();
  }
  for (std::size_t i = 0; i < scene.problem.lines.size(); ++i) {
    if (!result.line_inliers[i]) continue;
    const auto& match = scene.problem.lines[i];
    const auto r = EvaluateLine(scene.problem.camera,
                                result.cam_from_world,
                                ToOrthonormal(match.line_in_world),
                                match.measurement);
    H += r->J_pose.transpose() * r->J_pose;
    cost += 0.5 * r->r.squaredNorm();
  }
  EXPECT_LT((H - result.information).norm(), 1e-9 * H.norm());
  EXPECT_NEAR(cost, result.cost, 1e-9 * cost);
}

TEST(SolvePose, PointsBehindTheCameraAreOutliers) {
  Scene scene = MakePoseScene(5, {.sigma = 1});
  scene.problem.points[0].point_in_world = Inverse(scene.truth) * Eigen::Vector3d(0.1, 0.1, -3);
  const auto result = SolvePose(scene.problem);
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.point_inliers[0]);
}

TEST(SolvePose, DoesNotClaimConvergenceWhenThePoseIsNotFixed) {
  EXPECT_FALSE(SolvePose(MakePoseScene(6, {.points = 0, .lines = 0}).problem).converged);
  EXPECT_FALSE(
      SolvePose(MakePoseScene(6, {.points = 2, .lines = 0, .disparity = false}).problem).converged);
}

TEST(SolvePose, RepeatsTheSameBytes) {
  const Scene scene = MakePoseScene(7, {.sigma = 1, .outliers = 0.2});
  const auto a = SolvePose(scene.problem);
  const auto b = SolvePose(scene.problem);
  EXPECT_EQ(a.cam_from_world.rotation.coeffs(), b.cam_from_world.rotation.coeffs());
  EXPECT_EQ(a.cam_from_world.translation, b.cam_from_world.translation);
  EXPECT_EQ(a.information, b.information);
}

}  // namespace pose_optimization_test
}  // namespace plumbline
