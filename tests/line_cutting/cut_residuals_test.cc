// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/line_cutting/cut_residuals.h"

#include "tests/line_cutting/random_lines.h"
#include "tests/support/jacobian.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;
using Vector1d = Eigen::Matrix<double, 1, 1>;

constexpr double kOffset = 8;  // px; residuals far from zero show terms that vanish with them

double Distance(const CuttableLine& line, const Vector3d& point) {
  return LineDistance(line.image_line, TestCamera().Project(point));
}

TEST(CutResidual, IsTheDistanceOfTheCutPointWithItsDerivatives) {
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const CuttableLine line = RandomLine(rng, 1, kOffset);
    const double ratio = rng.Uniform();
    const Vector3d point = PointAt(line.segment_in_cam, ratio);
    const CutResidual found = EvaluateCutPoint(TestCamera(), line, ratio);
    EXPECT_NEAR(found.r, Distance(line, point), 1e-9);
    const auto by_point =
        NumericJacobian([&](const Vector3d& p) { return Vector1d(Distance(line, p)); }, point);
    EXPECT_LT((found.gradient.transpose() - by_point).norm(), 1e-7 * by_point.norm());
    const auto by_pose = NumericJacobian(
        [&](const Vector6d& x) { return Vector1d(Distance(line, ExpSe3(x) * point)); },
        Vector6d(Vector6d::Zero()));
    EXPECT_LT((found.pose_row.transpose() - by_pose).norm(), 1e-7 * by_pose.norm());
  }
}

TEST(CutResidual, DerivativesByTheRatioAgreeWithDifferences) {
  Rng rng(2);
  for (int trial = 0; trial < 20; ++trial) {
    const CuttableLine line = RandomLine(rng, 1, kOffset);
    const Vector1d ratio(rng.Uniform(0.1, 0.9));
    const CutResidual found = EvaluateCutPoint(TestCamera(), line, ratio(0));
    const auto gradient = NumericJacobian(
        [&](const Vector1d& a) { return EvaluateCutPoint(TestCamera(), line, a(0)).gradient; },
        ratio);
    const auto row = NumericJacobian(
        [&](const Vector1d& a) { return EvaluateCutPoint(TestCamera(), line, a(0)).pose_row; },
        ratio);
    EXPECT_LT((found.gradient_by_ratio - gradient).norm(), 1e-7 * gradient.norm());
    EXPECT_LT((found.pose_row_by_ratio - row).norm(), 1e-7 * row.norm());
  }
}

class Weights : public ::testing::TestWithParam<CuttingInformation> {};

TEST_P(Weights, DerivativesByTheRatiosAgreeWithDifferences) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const CuttableLine line = RandomLine(rng, 1, kOffset);
    const Eigen::Vector2d ratios(rng.Uniform(0.1, 0.4), rng.Uniform(0.6, 0.9));
    const auto weight = [&](const Eigen::Vector2d& a) -> Eigen::Vector4d {
      const Matrix2d w = EvaluateCut(TestCamera(), line, {a(0), a(1)}, GetParam()).weight;
      return Eigen::Map<const Eigen::Vector4d>(w.data());
    };
    const auto numeric = NumericJacobian(weight, ratios);
    const CutResiduals found = EvaluateCut(TestCamera(), line, {ratios(0), ratios(1)}, GetParam());
    for (int k = 0; k < 2; ++k) {
      const Matrix2d& slope = found.weight_by_ratio[static_cast<std::size_t>(k)];
      EXPECT_LT((Eigen::Map<const Eigen::Vector4d>(slope.data()) - numeric.col(k)).norm(),
                1e-6 * numeric.norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         Weights,
                         ::testing::Values(CuttingInformation::kIndependent,
                                           CuttingInformation::kPrinted,
                                           CuttingInformation::kCorrelated),
                         [](const auto& kind) { return NameOf(kind.param); });

// errata of the paper: what the errors of the two ends and of the measured line do to the
// residuals.
TEST(CutWeights, AreInverseCovariancesOfSimulatedResiduals) {
  Rng rng(4);
  const RectifiedCamera camera = TestCamera();
  const CuttableLine line = RandomLine(rng);
  const LineCut cut{0.2, 0.7};
  const Eigen::Matrix3d start = line.start_covariance.llt().matrixL();
  const Eigen::Matrix3d end = line.end_covariance.llt().matrixL();
  const Segment2 image{camera.Project(line.segment_in_cam.start),
                       camera.Project(line.segment_in_cam.end)};
  constexpr int kTrials = 40000;
  constexpr double kSmall = 1e-3;  // of the errors, so that the first order is all
  Matrix2d covariance = Matrix2d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    CuttableLine moved = line;
    moved.segment_in_cam.start += kSmall * start * RandomVector<3>(rng);
    moved.segment_in_cam.end += kSmall * end * RandomVector<3>(rng);
    moved.image_line = LineThrough(
        {image.start + RandomVector<2>(rng, kSmall), image.end + RandomVector<2>(rng, kSmall)});
    Eigen::Vector2d r(EvaluateCutPoint(camera, moved, cut.first).r,
                      EvaluateCutPoint(camera, moved, cut.second).r);
    r /= kSmall;
    covariance += r * r.transpose() / kTrials;
  }
  const Matrix2d correlated =
      EvaluateCut(camera, line, cut, CuttingInformation::kCorrelated).weight.inverse();
  EXPECT_LT((correlated - covariance).norm(), 0.03 * covariance.norm());
  // Independent: the variances of the two points, with the noise of the image line as a floor that
  // is the same everywhere; it is less than that between the ends.
  const Matrix2d independent =
      EvaluateCut(camera, line, cut, CuttingInformation::kIndependent).weight.inverse();
  for (int k = 0; k < 2; ++k) {
    EXPECT_GT(independent(k, k), correlated(k, k));
    EXPECT_LT(independent(k, k), correlated(k, k) + 1);
  }
}

}  // namespace
}  // namespace plumbline
