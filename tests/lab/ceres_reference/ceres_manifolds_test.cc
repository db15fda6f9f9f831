// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/ceres_reference/ceres_manifolds.h"

#include "plumbline/geometry/plucker.h"

#include "tests/lab/ceres_reference/ceres_numbers.h"
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

// `make` gives the numbers of a random element, `step` a random tangent vector.
template <class Manifold, class Make, class Step>
void ExpectInvariants(const Make& make, const Step& step) {
  const Manifold manifold;
  for (int i = 0; i < 20; ++i) {
    const Vector x = make();
    const Vector y = OnTheSideOf(x, make());
    const Vector delta = step();
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-6);
  }
}

template <class Manifold>
void ExpectInvariantsOfLines(Random& random) {
  ExpectInvariants<Manifold>([&] { return LineNumbers(RandomLine(random)); },
                             [&]() -> Vector {
                               Vector delta(4);
                               delta << random.NormalVector(0.3), random.Normal(0.3);
                               return delta;
                             });
}

TEST(LeftRigid3Manifold, ObeysTheInvariantsOfManifolds) {
  Random random(1);
  ExpectInvariants<LeftRigid3Manifold>([&] { return PoseNumbers(ExpSe3(random.Twist(1, 3))); },
                                       [&]() -> Vector { return random.Twist(0.4, 1); });
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
  ExpectInvariantsOfLines<OrthonormalLineManifold>(random);
}

TEST(LeftOrthonormalLineManifold, ObeysTheInvariantsOfManifolds) {
  Random random(7);
  ExpectInvariantsOfLines<LeftOrthonormalLineManifold>(random);
}

}  // namespace
}  // namespace plumbline
