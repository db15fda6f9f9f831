// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/plucker.h"

#include "plumbline/geometry/rectified_camera.h"

#include "tests/support/jacobian.h"
#include "tests/support/random_geometry.h"
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace plucker_test {

using Vector6 = Eigen::Matrix<double, 6, 1>;

double Difference(const PluckerLine& a, const PluckerLine& b) {
  return (a.moment - b.moment).norm() + (a.direction - b.direction).norm();
}

std::vector<PluckerLine> RandomLines(std::uint64_t seed, int count) {
  Rng rng(seed);
  std::vector<PluckerLine> lines;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d a = RandomVector<3>(rng, 3);
    lines.push_back(LineThroughPoints(a, a + RandomVector<3>(rng)));
  }
  return lines;
}

TEST(PluckerLine, HoldsBothPointsItWasMadeFrom) {
  Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d a = RandomVector<3>(rng, 4);
    const Eigen::Vector3d b = RandomVector<3>(rng, 4);
    const PluckerLine line = LineThroughPoints(a, b);
    EXPECT_NEAR(line.direction.norm(), 1, 1e-15);
    EXPECT_NEAR(line.moment.dot(line.direction), 0, 1e-14);
    EXPECT_LT(line.DistanceTo(a), 1e-13);
    EXPECT_LT(line.DistanceTo(b), 1e-13);
    EXPECT_LT((line.PointAt(line.ParameterOf(a)) - a).norm(), 1e-13);
    // Directed from a to b, moment = X x direction.
    EXPECT_GT(line.ParameterOf(b), line.ParameterOf(a));
    EXPECT_LT((a.cross(line.direction) - line.moment).norm(), 1e-13);
    EXPECT_NEAR(line.ParameterOf(b) - line.ParameterOf(a), (b - a).norm(), 1e-12);
  }
}

TEST(PluckerLine, FootIsTheNearestPointToTheOrigin) {
  for (const PluckerLine& line : RandomLines(2, 20)) {
    EXPECT_NEAR(line.Foot().dot(line.direction), 0, 1e-14);
    EXPECT_NEAR(line.Foot().norm(), line.moment.norm(), 1e-13);
    EXPECT_LT(line.DistanceTo(line.Foot()), 1e-13);
  }
}

TEST(PluckerLine, DistanceOfAKnownPoint) {
  const PluckerLine line = LineThroughPoints({0, 1, 0}, {1, 1, 0});
  EXPECT_NEAR(line.DistanceTo({7, 1, 3}), 3, 1e-15);
  EXPECT_NEAR(line.DistanceTo({-4, 5, 3}), 5, 1e-14);
}

TEST(LineFromPlanes, IsTheLineThatBothPlanesShare) {
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector4d plane1 = RandomVector<4>(rng);
    const Eigen::Vector4d plane2 = RandomVector<4>(rng);
    const auto line = LineFromPlanes(plane1, plane2);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->direction.norm(), 1, 1e-14);
    EXPECT_NEAR(line->moment.dot(line->direction), 0, 1e-12);
    for (const double t : {-3.0, 0.0, 2.0}) {
      const Eigen::Vector4d X = line->PointAt(t).homogeneous();
      EXPECT_NEAR(plane1.dot(X), 0, 1e-11);
      EXPECT_NEAR(plane2.dot(X), 0, 1e-11);
    }
  }
}

TEST(LineFromPlanes, RefusesParallelPlanes) {
  EXPECT_FALSE(LineFromPlanes({0, 0, 1, -1}, {0, 0, 2, -5}));
  EXPECT_FALSE(LineFromPlanes({0, 0, 1, -1}, {0, 1e-11, 1, -5}));
  EXPECT_TRUE(LineFromPlanes({0, 0, 1, -1}, {0, 1e-7, 1, -5}));
}

TEST(PluckerLine, TransformMovesItsPoints) {
  Rng rng(4);
  for (const PluckerLine& line : RandomLines(5, 30)) {
    const Rigid3 motion = RandomRigid(rng);
    const PluckerLine moved = Transform(motion, line);
    EXPECT_LT(moved.DistanceTo(motion * line.PointAt(-2)), 1e-13);
    EXPECT_LT(moved.DistanceTo(motion * line.PointAt(5)), 1e-13);
    EXPECT_LT((moved.direction - motion.rotation * line.direction).norm(), 1e-15);
    EXPECT_LT(Difference(Transform(Inverse(motion), moved), line), 1e-13);
  }
}

TEST(PluckerLine, ProjectedMomentHoldsTheProjectedPoints) {
  const RectifiedCamera camera = TestCamera();
  Rng rng(6);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d a(rng.Normal(), rng.Normal(), rng.Uniform(1, 5));
    const Eigen::Vector3d b(rng.Normal(), rng.Normal(), rng.Uniform(1, 5));
    const Eigen::Vector3d l = camera.ProjectMoment(LineThroughPoints(a, b).moment);
    EXPECT_NEAR(l.dot(camera.Project(a).homogeneous()) / l.head<2>().norm(), 0, 1e-9);
    EXPECT_NEAR(l.dot(camera.Project(b).homogeneous()) / l.head<2>().norm(), 0, 1e-9);
    // The sign: the same side as the line through the projections, in their order.
    const Eigen::Vector3d image = LineThrough({camera.Project(a), camera.Project(b)});
    EXPECT_LT((l / l.head<2>().norm() - image).head<2>().norm(), 1e-9);
  }
}

TEST(OrthonormalLine, RoundTripKeepsTheLine) {
  for (const PluckerLine& line : RandomLines(7, 50)) {
    const OrthonormalLine orthonormal = ToOrthonormal(line);
    EXPECT_NEAR(orthonormal.w.norm(), 1, 1e-15);
    EXPECT_NEAR(orthonormal.Homogeneous().norm(), 1, 1e-14);
    EXPECT_LT(Difference(ToPlucker(orthonormal), line), 1e-13);
  }
}

TEST(OrthonormalLine, KeepsLinesThroughAndNearTheOrigin) {
  Rng rng(8);
  for (const double distance : {0.0, 1e-15, 1e-12, 1e-8, 1e-4}) {
    const Eigen::Vector3d direction = RandomVector<3>(rng).normalized();
    const Eigen::Vector3d moment = distance * direction.unitOrthogonal();
    const PluckerLine back = ToPlucker(ToOrthonormal({moment, direction}));
    EXPECT_LT((back.direction - direction).norm(), 1e-14) << distance;
    EXPECT_LT((back.moment - moment).norm(), 1e-15 + 1e-11 * distance) << distance;
  }
}

TEST(OrthonormalLine, KeepsFarLines) {
  const PluckerLine line = LineThroughPoints({1e6, 0, 3}, {1e6, 1, 4});
  const PluckerLine back = ToPlucker(ToOrthonormal(line));
  EXPECT_LT((back.moment - line.moment).norm(), 1e-7);
}

TEST(OrthonormalLine, HomogeneousJacobianIsTheDerivativeOfRetract) {
  for (const PluckerLine& line : RandomLines(9, 30)) {
    const OrthonormalLine at = ToOrthonormal(line);
    const Eigen::Matrix<double, 6, 4> numeric = NumericJacobian(
        [&](const Eigen::Vector4d& delta) { return Retract(at, delta).Homogeneous(); },
        Eigen::Vector4d(Eigen::Vector4d::Zero()));
    EXPECT_LT((HomogeneousJacobian(at) - numeric).norm(), 1e-10);
  }
}

TEST(OrthonormalLine, LeftHomogeneousJacobianIsTheDerivativeOfRetractLeft) {
  for (const PluckerLine& line : RandomLines(17, 30)) {
    const OrthonormalLine at = ToOrthonormal(line);
    const Eigen::Matrix<double, 6, 4> numeric = NumericJacobian(
        [&](const Eigen::Vector4d& delta) { return RetractLeft(at, delta).Homogeneous(); },
        Eigen::Vector4d(Eigen::Vector4d::Zero()));
    EXPECT_LT((LeftHomogeneousJacobian(at) - numeric).norm(), 1e-10);
  }
}

// The two updates turn about the same axes, given in the line's frame or outside.
TEST(OrthonormalLine, RetractLeftIsRetractWithTheTurnSeenFromOutside) {
  Rng rng(18);
  for (const PluckerLine& line : RandomLines(19, 30)) {
    const OrthonormalLine at = ToOrthonormal(line);
    const Eigen::Vector4d delta = RandomVector<4>(rng);
    Eigen::Vector4d outside = delta;
    outside.head<3>() = at.U * delta.head<3>();
    EXPECT_LT((RetractLeft(at, outside).Homogeneous() - Retract(at, delta).Homogeneous()).norm(),
              1e-13);
  }
}

TEST(OrthonormalLine, RetractAlwaysGivesALine) {
  Rng rng(10);
  for (const PluckerLine& line : RandomLines(11, 30)) {
    const OrthonormalLine moved = Retract(ToOrthonormal(line), RandomVector<4>(rng));
    EXPECT_NEAR(moved.w.norm(), 1, 1e-14);
    EXPECT_NEAR(moved.U.norm(), 1, 1e-15);
    const Vector6 h = moved.Homogeneous();
    EXPECT_NEAR(h.head<3>().dot(h.tail<3>()), 0, 1e-14);
  }
}

TEST(OrthonormalLine, FourthParameterChangesTheDistanceOnly) {
  const PluckerLine line = LineThroughPoints({0, 2, 0}, {1, 2, 0});
  const PluckerLine moved = ToPlucker(Retract(ToOrthonormal(line), {0, 0, 0, 0.1}));
  EXPECT_LT((moved.direction - line.direction).norm(), 1e-14);
  EXPECT_LT((moved.moment.normalized() - line.moment.normalized()).norm(), 1e-14);
  EXPECT_GT(std::abs(moved.moment.norm() - 2), 0.1);
}

TEST(OrthonormalLine, RetractStraightHasTheDerivativeOfRetract) {
  for (const PluckerLine& line : RandomLines(12, 30)) {
    const OrthonormalLine at = ToOrthonormal(line);
    const Eigen::Matrix<double, 6, 4> numeric = NumericJacobian(
        [&](const Eigen::Vector4d& delta) { return RetractStraight(at, delta).Homogeneous(); },
        Eigen::Vector4d(Eigen::Vector4d::Zero()));
    EXPECT_LT((HomogeneousJacobian(at) - numeric).norm(), 1e-9);
  }
}

// Within the plane through line and origin, (m, d) stays a line all along its derivative.
TEST(OrthonormalLine, RetractStraightIsStraightWithinThePlane) {
  Rng rng(13);
  for (const PluckerLine& line : RandomLines(14, 30)) {
    const OrthonormalLine at = ToOrthonormal(line);
    const Eigen::Vector4d delta(rng.Uniform(-0.5, 0.5), 0, 0, rng.Uniform(-0.5, 0.5));
    const Vector6 meant = at.Homogeneous() + HomogeneousJacobian(at) * delta;
    const Vector6 moved = RetractStraight(at, delta).Homogeneous();
    EXPECT_NEAR(std::abs(moved.dot(meant.normalized())), 1, 1e-12);
  }
}

TEST(OrthonormalLine, RetractStraightAlwaysGivesALine) {
  Rng rng(15);
  for (const PluckerLine& line : RandomLines(16, 30)) {
    const OrthonormalLine moved = RetractStraight(ToOrthonormal(line), 3 * RandomVector<4>(rng));
    EXPECT_NEAR(moved.w.norm(), 1, 1e-14);
    EXPECT_NEAR(moved.U.norm(), 1, 1e-14);
  }
  // A step that ends at infinity: w = (1, 0).
  const OrthonormalLine at{Eigen::Quaterniond::Identity(), {0, 1}};
  const OrthonormalLine infinite = RetractStraight({at.U, {1, 0}}, Eigen::Vector4d::Zero());
  EXPECT_TRUE(infinite.U.coeffs().allFinite());
  EXPECT_TRUE(infinite.w.allFinite());
}

}  // namespace plucker_test
}  // namespace plumbline
