// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/geometric_interpolation.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;

struct Case {
  Rigid3 between, current;  // _from_reference
  Eigen::Vector3d point;

  Eigen::Vector2d InReference() const { return point.hnormalized(); }
  Eigen::Vector2d InBetween() const { return (between * point).hnormalized(); }
  Eigen::Vector2d InCurrent() const { return (current * point).hnormalized(); }
};

Case RandomCase(Rng& rng) {
  const auto motion = [&](double turn, double shift) {
    return Rigid3{ExpSo3(RandomVector<3>(rng, turn)), RandomVector<3>(rng, shift)};
  };
  Case c{motion(0.03, 0.1), motion(0.05, 0.2), {}};
  c.point = {rng.Uniform(-1.5, 1.5), rng.Uniform(-1, 1), rng.Uniform(2, 6)};
  return c;
}

TEST(GeometricInterpolation, FindsThePlaceInTheFrameBetween) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Case c = RandomCase(rng);
    const auto found = GeometricInterpolation({c.between, c.current})
                           .Interpolate(c.InReference(), 0, c.InCurrent(), 0);
    ASSERT_TRUE(found);
    if (found->line_angle < 0.01) continue;
    EXPECT_LT((found->point - c.InBetween()).norm(), 1e-9);
    EXPECT_LT(found->covariance.norm(), 1e-12);
  }
}

// Translations of unit length chained as they are, as printed, miss by many pixels (E0.1).
TEST(GeometricInterpolation, NeedsTheRatioOfTheTranslations) {
  Rng rng(2);
  std::vector<double> errors;
  for (int i = 0; i < 500; ++i) {
    const Case c = RandomCase(rng);
    Rigid3 between = c.between;
    Rigid3 current = c.current;
    between.translation.normalize();
    current.translation.normalize();
    const auto found = GeometricInterpolation({between, current})
                           .Interpolate(c.InReference(), 0, c.InCurrent(), 0);
    if (found) errors.push_back(520 * (found->point - c.InBetween()).norm());
  }
  std::nth_element(errors.begin(), errors.begin() + 250, errors.end());
  EXPECT_GT(errors[250], 5);
}

// The place under moved poses and pixels.
Eigen::Vector2d Place(const Case& c, const Vector12d& poses, const Eigen::Vector4d& pixels) {
  const InterpolationPoses moved{RetractLeft(c.between, poses.head<6>()),
                                 RetractLeft(c.current, poses.tail<6>())};
  return GeometricInterpolation(moved)
      .Interpolate(c.InReference() + pixels.head<2>(), 0, c.InCurrent() + pixels.tail<2>(), 0)
      ->point;
}

TEST(GeometricInterpolation, PropagatesTheUncertaintyOfPosesAndPixels) {
  Rng rng(3);
  int checked = 0;
  for (int i = 0; i < 50; ++i) {
    const Case c = RandomCase(rng);
    const Eigen::Matrix<double, 12, 12> root =
        Eigen::Matrix<double, 12, 12>::NullaryExpr([&] { return rng.Normal(1e-3); });
    const Eigen::Matrix<double, 12, 12> covariance = root * root.transpose();
    const auto found = GeometricInterpolation({c.between, c.current, covariance})
                           .Interpolate(c.InReference(), 1e-3, c.InCurrent(), 2e-3);
    ASSERT_TRUE(found);
    if (found->line_angle < 0.2) continue;
    ++checked;
    const auto J_poses =
        NumericJacobian([&](const Vector12d& x) { return Place(c, x, Eigen::Vector4d::Zero()); },
                        Vector12d(Vector12d::Zero()),
                        1e-5);
    const auto J_pixels =
        NumericJacobian([&](const Eigen::Vector4d& x) { return Place(c, Vector12d::Zero(), x); },
                        Eigen::Vector4d(Eigen::Vector4d::Zero()),
                        1e-5);
    const Eigen::Vector4d variances(1e-6, 1e-6, 4e-6, 4e-6);
    const Eigen::Matrix2d expected = J_poses * covariance * J_poses.transpose() +
                                     J_pixels * variances.asDiagonal() * J_pixels.transpose();
    EXPECT_LT((found->covariance - expected).norm(), 1e-5 * expected.norm());
  }
  EXPECT_GT(checked, 20);
}

// Fixed angle against propagated deviation (E1): what the gate of 2 px lets pass is good to 2 px,
// what 5 degrees lets pass is not.
TEST(GeometricInterpolation, TellsWhichPlacesAreGood) {
  Rng rng(4);
  constexpr double kSigma = 0.5 / 520;
  double gated = 0, by_angle = 0;
  int gated_count = 0, angle_count = 0;
  for (int i = 0; i < 4000; ++i) {
    const Case c = RandomCase(rng);
    const auto found = GeometricInterpolation({c.between, c.current})
                           .Interpolate(c.InReference() + RandomVector<2>(rng, kSigma),
                                        kSigma,
                                        c.InCurrent() + RandomVector<2>(rng, kSigma),
                                        kSigma);
    if (!found) continue;
    const double squared = (found->point - c.InBetween()).squaredNorm() * 520 * 520;
    if (std::sqrt(found->covariance.trace()) * 520 < 2) {
      gated += squared;
      ++gated_count;
    }
    if (found->line_angle > 5 * 3.14159 / 180 && found->line_angle < 20 * 3.14159 / 180) {
      by_angle += squared;
      ++angle_count;
    }
  }
  ASSERT_GT(gated_count, 1000);
  ASSERT_GT(angle_count, 300);
  EXPECT_LT(std::sqrt(gated / gated_count), 2);
  EXPECT_GT(std::sqrt(by_angle / angle_count), 3);
}

TEST(GeometricInterpolation, RefusesParallelLines) {
  // Straight on, the point in the plane of all three: both lines are one.
  const Rigid3 between{Eigen::Quaterniond::Identity(), {-0.1, 0, 0}};
  const Rigid3 current{Eigen::Quaterniond::Identity(), {-0.2, 0, 0}};
  const GeometricInterpolation interpolation({between, current});
  EXPECT_FALSE(interpolation.Interpolate({0.1, 0}, 0, {0.05, 0}, 0));
  EXPECT_FALSE(GeometricInterpolation({{}, current}).Interpolate({0.1, 0}, 0, {0.05, 0}, 0));
}

}  // namespace
}  // namespace plumbline
