// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/triangulation.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace triangulation_test {

// Cameras on an arc that look at the origin of the world from 5 m.
std::vector<Rigid3> LookingAtTheOrigin(int count, double spread) {
  std::vector<Rigid3> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = spread * (i - 0.5 * (count - 1));
    poses.push_back({ExpSo3({0.1 * angle, angle, 0.2 * angle}), {0, 0, 5}});
  }
  return poses;
}

std::vector<PointView> ViewsOf(const Eigen::Vector3d& point,
                               const std::vector<Rigid3>& poses,
                               bool with_disparity) {
  const RectifiedCamera camera = TestCamera();
  std::vector<PointView> views;
  for (const Rigid3& pose : poses) {
    const Eigen::Vector3d p = pose * point;
    PointView view{pose, camera.Project(p), 1.0, std::nullopt};
    if (with_disparity) view.disparity = Disparity{camera.DisparityFromDepth(p.z()), 1.4};
    views.push_back(view);
  }
  return views;
}

void AddNoise(Rng& rng, std::vector<PointView>& views) {
  for (PointView& view : views) {
    view.px += RandomVector<2>(rng, view.sigma_px);
    if (view.disparity) view.disparity->px += rng.Normal(view.disparity->sigma_px);
  }
}

double Mahalanobis(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

TEST(PointEstimate, TransformTurnsTheCovariance) {
  const PointEstimate point{{1, 2, 3}, Eigen::Vector3d(1, 4, 9).asDiagonal()};
  const Rigid3 quarter{ExpSo3({0, 0, std::acos(0.0)}), {1, 0, 0}};
  const PointEstimate moved = Transform(quarter, point);
  EXPECT_LT((moved.position - Eigen::Vector3d(-1, 1, 3)).norm(), 1e-14);
  EXPECT_LT((moved.covariance.diagonal() - Eigen::Vector3d(4, 1, 9)).norm(), 1e-13);
}

TEST(TriangulatePoint, IsExactWithoutNoise) {
  Rng rng(2);
  for (const bool stereo : {false, true}) {
    for (const int count : {2, 3, 8}) {
      const Eigen::Vector3d p = RandomVector<3>(rng, 0.5);
      const auto result =
          TriangulatePoint(TestCamera(), ViewsOf(p, LookingAtTheOrigin(count, 0.1), stereo));
      ASSERT_TRUE(result);
      EXPECT_LT((result->point.position - p).norm(), 1e-9);
      EXPECT_LT(result->chi2, 1e-12);
      EXPECT_EQ(result->residuals, count * (stereo ? 3 : 2));
    }
  }
}

TEST(TriangulatePoint, OneStereoViewIsTheStereoPoint) {
  const RectifiedCamera camera = TestCamera();
  const auto views = ViewsOf({0.3, 0.2, 0}, LookingAtTheOrigin(1, 0), true);
  const auto result = TriangulatePoint(camera, views, {.min_parallax = 0.01});
  ASSERT_TRUE(result);
  const auto point_of = [&](const Eigen::Vector3d& measured) -> Eigen::Vector3d {
    const double depth = camera.DepthFromDisparity(measured.z());
    return Inverse(views[0].cam_from_world) * (depth * camera.Unproject(measured.head<2>()));
  };
  const Disparity& disparity = *views[0].disparity;
  const Eigen::Vector3d measured(views[0].px.x(), views[0].px.y(), disparity.px);
  EXPECT_LT((result->point.position - point_of(measured)).norm(), 1e-9);
  const Eigen::Matrix3d J = NumericJacobian(point_of, measured, 1e-4);
  const double variance = disparity.sigma_px * disparity.sigma_px;
  const Eigen::Matrix3d expected = J * Eigen::Vector3d(1, 1, variance).asDiagonal() * J.transpose();
  EXPECT_LT((result->point.covariance - expected).norm(), 1e-6 * expected.norm());
}

TEST(TriangulatePoint, ErrorsFollowTheCovariance) {
  Rng rng(3);
  double sum = 0;
  double chi2 = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d p = RandomVector<3>(rng, 0.5);
    std::vector<PointView> views = ViewsOf(p, LookingAtTheOrigin(4, 0.1), i % 2 == 0);
    AddNoise(rng, views);
    const auto result = TriangulatePoint(TestCamera(), views);
    ASSERT_TRUE(result);
    sum += Mahalanobis(result->point.position - p, result->point.covariance);
    chi2 += result->chi2 / (result->residuals - 3);
  }
  EXPECT_NEAR(sum / kCount, 3, 0.2);
  EXPECT_NEAR(chi2 / kCount, 1, 0.06);
}

// Sum of squared residuals over their variances, written out again.
double Chi2(const std::vector<PointView>& views, const Eigen::Vector3d& point) {
  const RectifiedCamera camera = TestCamera();
  double sum = 0;
  for (const PointView& view : views) {
    const Eigen::Vector3d p = view.cam_from_world * point;
    sum += ((camera.Project(p) - view.px) / view.sigma_px).squaredNorm();
    if (view.disparity) {
      const double error = camera.DisparityFromDepth(p.z()) - view.disparity->px;
      sum += std::pow(error / view.disparity->sigma_px, 2);
    }
  }
  return sum;
}

TEST(TriangulatePoint, EndsAtTheLeastSquares) {
  Rng rng(9);
  using Value = Eigen::Matrix<double, 1, 1>;
  for (int i = 0; i < 20; ++i) {
    std::vector<PointView> views = ViewsOf({0.3, -0.2, 0.4}, LookingAtTheOrigin(3, 0.1), true);
    for (PointView& view : views) view.disparity->sigma_px = 0.3;
    AddNoise(rng, views);
    const auto result = TriangulatePoint(TestCamera(), views, {.max_iterations = 20});
    ASSERT_TRUE(result);
    const Eigen::Vector3d& point = result->point.position;
    EXPECT_NEAR(result->chi2, Chi2(views, point), 1e-9);
    const Eigen::RowVector3d slope =
        NumericJacobian([&](const Eigen::Vector3d& x) { return Value(Chi2(views, x)); }, point);
    // In units of the standard deviations.
    const double change = std::sqrt(slope.dot(slope * result->point.covariance));
    EXPECT_LT(change, 1e-3);
  }
}

TEST(TriangulatePoint, MeasuresTheParallax) {
  const auto views = ViewsOf({0, 0, 0}, LookingAtTheOrigin(2, 0.3), false);
  const auto result = TriangulatePoint(TestCamera(), views);
  ASSERT_TRUE(result);
  const Eigen::Vector3d a = Inverse(views[0].cam_from_world).translation;
  const Eigen::Vector3d b = Inverse(views[1].cam_from_world).translation;
  EXPECT_NEAR(result->parallax, std::acos(a.dot(b) / 25), 1e-9);
}

TEST(TriangulatePoint, NamesItsFailures) {
  using enum PointTriangulationFailure;
  const RectifiedCamera camera = TestCamera();
  EXPECT_EQ(TriangulatePoint(camera, {}).error(), kTooFewViews);
  std::vector<PointView> views = ViewsOf({0, 0, 0}, LookingAtTheOrigin(1, 0), false);
  EXPECT_EQ(TriangulatePoint(camera, views).error(), kTooFewViews);
  EXPECT_EQ(
      TriangulatePoint(camera, ViewsOf({0, 0, 0}, LookingAtTheOrigin(2, 0.01), false)).error(),
      kSmallParallax);
  views.push_back(views[0]);
  EXPECT_FALSE(TriangulatePoint(camera, views)) << "the same view twice";
  // Rays that part in front of the cameras meet behind them.
  views[0] = {{}, {367 - 50, 252}, 1, std::nullopt};
  views[1] = {{Eigen::Quaterniond::Identity(), {-1, 0, 0}}, {367 + 50, 252}, 1, std::nullopt};
  EXPECT_EQ(TriangulatePoint(camera, views).error(), kBehindCamera);
}

}  // namespace triangulation_test
}  // namespace plumbline
