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

TEST(TriangulatePoint, IsExactWithoutNoise) {
  Rng rng(2);
  for (const bool stereo : {false, true}) {
    for (const int count : {2, 3, 8}) {
      const Eigen::Vector3d p = RandomVector<3>(rng, 0.5);
      const auto result =
          TriangulatePoint(TestCamera(), ViewsOf(p, LookingAtTheOrigin(count, 0.1), stereo));
      ASSERT_TRUE(result);
      EXPECT_LT((result->position - p).norm(), 1e-9);
      EXPECT_LT(result->chi2, 1e-12);
      EXPECT_EQ(result->residuals, count * (stereo ? 3 : 2));
    }
  }
}

TEST(TriangulatePoint, OneStereoViewIsTheStereoPoint) {
  const RectifiedCamera camera = TestCamera();
  const auto views = ViewsOf({0.3, 0.2, 0}, LookingAtTheOrigin(1, 0), true);
  const auto result = TriangulatePoint(camera, views, {.min_angle = 0.01});
  ASSERT_TRUE(result);
  const auto point_of = [&](const Eigen::Vector3d& measured) -> Eigen::Vector3d {
    const double depth = camera.DepthFromDisparity(measured.z());
    return Inverse(views[0].cam_from_world) * (depth * camera.Unproject(measured.head<2>()));
  };
  const Disparity& disparity = *views[0].disparity;
  const Eigen::Vector3d measured(views[0].px.x(), views[0].px.y(), disparity.px);
  EXPECT_LT((result->position - point_of(measured)).norm(), 1e-9);
  const Eigen::Matrix3d J = NumericJacobian(point_of, measured, 1e-4);
  const double variance = disparity.sigma_px * disparity.sigma_px;
  const Eigen::Matrix3d expected = J * Eigen::Vector3d(1, 1, variance).asDiagonal() * J.transpose();
  EXPECT_LT((result->covariance - expected).norm(), 1e-6 * expected.norm());
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
    sum += Mahalanobis(result->position - p, result->covariance);
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
    const Eigen::Vector3d& point = result->position;
    EXPECT_NEAR(result->chi2, Chi2(views, point), 1e-9);
    const Eigen::RowVector3d slope =
        NumericJacobian([&](const Eigen::Vector3d& x) { return Value(Chi2(views, x)); }, point);
    // In units of the standard deviations.
    const double change = std::sqrt(slope.dot(slope * result->covariance));
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

namespace line_triangulation_test {

// Cameras about 5 m in front of the world point (0, 0, 20), far from the world's origin.
std::vector<Rigid3> CamerasNear(Rng& rng, int count) {
  std::vector<Rigid3> poses;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d centre(0, 0, 15);
    centre += RandomVector<3>(rng, 0.7);
    const Eigen::Quaterniond rotation = ExpSo3(RandomVector<3>(rng, 0.05));
    poses.push_back({rotation, -(rotation * centre)});
  }
  return poses;
}

Segment3 LineInView(Rng& rng) {
  const Eigen::Vector3d middle = Eigen::Vector3d(0, 0, 20) + RandomVector<3>(rng, 0.3);
  const Eigen::Vector3d half = 0.8 * RandomVector<3>(rng).normalized();
  return {middle - half, middle + half};
}

LineView ViewOf(const Segment3& segment, const Rigid3& pose, double sigma_px = 1) {
  const RectifiedCamera camera = TestCamera();
  return {
      pose, {camera.Project(pose * segment.start), camera.Project(pose * segment.end)}, sigma_px};
}

std::vector<LineView> ViewsOf(const Segment3& segment, const std::vector<Rigid3>& poses) {
  std::vector<LineView> views;
  for (const Rigid3& pose : poses) views.push_back(ViewOf(segment, pose));
  return views;
}

void AddNoise(Rng& rng, LineView& view) {
  view.segment.start += RandomVector<2>(rng, view.sigma_px);
  view.segment.end += RandomVector<2>(rng, view.sigma_px);
}

double Distance(const PluckerLine& line, const Segment3& truth) {
  return std::max(line.DistanceTo(truth.start), line.DistanceTo(truth.end));
}

// The tangent that takes `from` to `to`, for nearby lines.
Eigen::Vector4d TangentTo(const PluckerLine& from, const PluckerLine& to) {
  Eigen::Vector4d delta = Eigen::Vector4d::Zero();
  for (int i = 0; i < 10; ++i) {
    const OrthonormalLine at = Retract(ToOrthonormal(from), delta);
    // The step is taken at `at` but added to delta: only its zero matters.
    const Eigen::Matrix<double, 6, 1> difference =
        ToOrthonormal(to).Homogeneous() - at.Homogeneous();
    const Eigen::Matrix<double, 6, 4> J = NumericJacobian(
        [&](const Eigen::Vector4d& d) { return Retract(ToOrthonormal(from), d).Homogeneous(); },
        delta);
    delta += (J.transpose() * J).ldlt().solve(J.transpose() * difference);
  }
  return delta;
}

TEST(InterpretationPlane, HoldsTheCentreAndTheLine) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose = CamerasNear(rng, 1)[0];
    const Segment3 truth = LineInView(rng);
    const auto plane = InterpretationPlane(TestCamera(), ViewOf(truth, pose));
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->head<3>().norm(), 1, 1e-14);
    EXPECT_NEAR(plane->dot(Inverse(pose).translation.homogeneous()), 0, 1e-12);
    EXPECT_NEAR(plane->dot(truth.start.homogeneous()), 0, 1e-11);
    EXPECT_NEAR(plane->dot(truth.end.homogeneous()), 0, 1e-11);
  }
  EXPECT_FALSE(InterpretationPlane(TestCamera(), {{}, {{5, 5}, {5, 5}}, 1}));
}

TEST(TriangulateLine, IsExactWithoutNoise) {
  Rng rng(2);
  int done = 0;
  for (int i = 0; i < 60; ++i) {
    const Segment3 truth = LineInView(rng);
    const auto views = ViewsOf(truth, CamerasNear(rng, 2 + i % 4));
    for (const int iterations : {0, 6}) {
      const auto result =
          TriangulateLine(TestCamera(), views, {.min_angle = 0.05, .max_iterations = iterations});
      if (!result) continue;
      ++done;
      EXPECT_LT(Distance(result->line, truth), 1e-8);
      EXPECT_NEAR(result->line.direction.norm(), 1, 1e-12);
      EXPECT_GT(result->line.direction.dot(truth.Direction()), 0.99);
      EXPECT_LT(result->chi2, 1e-9);
      EXPECT_EQ(result->residuals, 2 * static_cast<int>(views.size()));
    }
  }
  EXPECT_GT(done, 80);
}

TEST(TriangulateLine, DirectionIsThatOfTheFirstSegment) {
  Rng rng(3);
  const Segment3 truth = LineInView(rng);
  auto views = ViewsOf(truth, CamerasNear(rng, 3));
  views[0].segment = views[0].segment.Reversed();
  const auto result = TriangulateLine(TestCamera(), views);
  ASSERT_TRUE(result);
  EXPECT_LT(result->line.direction.dot(truth.Direction()), -0.99);
}

TEST(TriangulateLine, ErrorsFollowTheCovariance) {
  Rng rng(4);
  double sum = 0;
  double chi2 = 0;
  int done = 0;
  for (int i = 0; i < 600; ++i) {
    const Segment3 truth = LineInView(rng);
    auto views = ViewsOf(truth, CamerasNear(rng, 4));
    for (LineView& view : views) {
      view.sigma_px = 0.1;
      AddNoise(rng, view);
    }
    const auto result =
        TriangulateLine(TestCamera(), views, {.min_angle = 0.15, .max_residual_sigma = 100});
    if (!result) continue;
    ++done;
    PluckerLine exact = LineThroughPoints(truth.start, truth.end);
    if (exact.direction.dot(result->line.direction) < 0) {
      exact = {-exact.moment, -exact.direction};
    }
    const Eigen::Vector4d error = TangentTo(result->line, exact);
    sum += error.dot(result->covariance.ldlt().solve(error));
    chi2 += result->chi2 / (result->residuals - 4);
  }
  EXPECT_GT(done, 300);
  EXPECT_NEAR(sum / done, 4, 0.5);
  EXPECT_NEAR(chi2 / done, 1, 0.1);
}

TEST(TriangulateLine, RefinementBeatsTheLinearSolution) {
  Rng rng(5);
  double linear = 0;
  double refined = 0;
  for (int i = 0; i < 200; ++i) {
    const Segment3 truth = LineInView(rng);
    auto views = ViewsOf(truth, CamerasNear(rng, 5));
    for (LineView& view : views) AddNoise(rng, view);
    const TriangulationOptions options{.min_angle = 0.1, .max_residual_sigma = 100};
    TriangulationOptions no_steps = options;
    no_steps.max_iterations = 0;
    const auto a = TriangulateLine(TestCamera(), views, no_steps);
    const auto b = TriangulateLine(TestCamera(), views, options);
    if (!a || !b) continue;
    EXPECT_LE(b->chi2, a->chi2 * (1 + 1e-9));
    linear += Distance(a->line, truth);
    refined += Distance(b->line, truth);
  }
  EXPECT_LT(refined, linear);
  EXPECT_LT(linear, 2 * refined) << "the linear solution is a good start";
}

TEST(TriangulateLine, NamesItsFailures) {
  using enum LineTriangulationFailure;
  const RectifiedCamera camera = TestCamera();
  Rng rng(6);
  const Segment3 truth{{-0.5, -0.5, 20}, {0.4, 0.6, 20.5}};
  const Rigid3 first{Eigen::Quaterniond::Identity(), {0, 0, -15}};
  const Rigid3 right{Eigen::Quaterniond::Identity(), {-1, 0, -15}};
  std::vector<LineView> views = {ViewOf(truth, first)};
  EXPECT_EQ(TriangulateLine(camera, views).error(), kTooFewViews);
  views.push_back(ViewOf(truth, right));
  ASSERT_TRUE(TriangulateLine(camera, views));

  auto empty = views;
  empty[1].segment.end = empty[1].segment.start;
  EXPECT_EQ(TriangulateLine(camera, empty).error(), kEmptySegment);

  // A horizontal line and a horizontal displacement: the two planes are one.
  const Segment3 horizontal{{-0.5, 0.3, 20}, {0.5, 0.3, 20}};
  EXPECT_EQ(TriangulateLine(camera, ViewsOf(horizontal, {first, right})).error(), kParallelPlanes);

  // Swapped images: the planes meet behind the cameras.
  auto swapped = views;
  std::swap(swapped[0].segment, swapped[1].segment);
  EXPECT_EQ(TriangulateLine(camera, swapped).error(), kBehindCamera);

  // A third segment of something else.
  auto inconsistent = views;
  inconsistent.push_back(ViewOf(truth, CamerasNear(rng, 1)[0]));
  ASSERT_TRUE(TriangulateLine(camera, inconsistent));
  inconsistent[2].segment.start.x() += 20;
  EXPECT_EQ(TriangulateLine(camera, inconsistent).error(), kInconsistentViews);
}

}  // namespace line_triangulation_test

}  // namespace plumbline
