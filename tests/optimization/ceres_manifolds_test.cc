// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/ceres_manifolds.h"

#include "plumbline/geometry/plucker.h"

#include "tests/optimization/ceres_numbers.h"
#include "tests/optimization/random_scene.h"

#include <ceres/manifold_test_utils.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using namespace ceres;  // NOLINT: the macro for manifolds uses unqualified names
using plumbline::testing::LineNumbers;
using plumbline::testing::PoseNumbers;
using plumbline::testing::Random;

OrthonormalLine RandomLine(Random& random) {
  return ToOrthonormal(LineThroughPoints(random.NormalVector(2), random.NormalVector(2)));
}

// q and -q are one rotation; the invariants compare numbers, so y is written on the side of x.
Vector OnTheSideOf(const Vector& x, Vector y) {
  if (x.head<4>().dot(y.head<4>()) < 0) y.head<4>() *= -1;
  return y;
}

TEST(LeftRigid3Manifold, ObeysTheInvariantsOfManifolds) {
  Random random(1);
  const LeftRigid3Manifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = PoseNumbers(ExpSe3(random.Twist(1, 3)));
    const Vector y = OnTheSideOf(x, PoseNumbers(ExpSe3(random.Twist(1, 3))));
    const Vector delta = random.Twist(0.4, 1);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

TEST(LeftRigid3Manifold, PlusIsTheLeftPerturbation) {
  Random random(2);
  const Rigid3 pose = ExpSe3(random.Twist(1, 3));
  const Vector6d delta = random.Twist(0.3, 1);
  Vector out(7);
  LeftRigid3Manifold().Plus(PoseNumbers(pose).data(), delta.data(), out.data());
  EXPECT_LT((out - PoseNumbers(RetractLeft(pose, delta))).norm(), 1e-14);
}

TEST(OrthonormalLineManifold, ObeysTheInvariantsOfManifolds) {
  Random random(3);
  const OrthonormalLineManifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = LineNumbers(RandomLine(random));
    const Vector y = OnTheSideOf(x, LineNumbers(RandomLine(random)));
    Vector delta(4);
    delta << random.NormalVector(0.3), random.Normal(0.3);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

TEST(LeftOrthonormalLineManifold, ObeysTheInvariantsOfManifolds) {
  Random random(7);
  const LeftOrthonormalLineManifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = LineNumbers(RandomLine(random));
    const Vector y = OnTheSideOf(x, LineNumbers(RandomLine(random)));
    Vector delta(4);
    delta << random.NormalVector(0.3), random.Normal(0.3);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

}  // namespace
}  // namespace plumbline
