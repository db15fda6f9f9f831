// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/basis_across.h"

#include "plumbline/base/random.h"

#include "tests/support/random_geometry.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(BasisAcross, IsOrthonormal) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d t = RandomVector<3>(rng).normalized();
    Eigen::Matrix3d all;
    all << t, BasisAcross(t);
    EXPECT_LT((all.transpose() * all - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST(BasisAcross, IsDefinedAlongTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d t = -Eigen::Vector3d::Unit(axis);
    EXPECT_LT((t.transpose() * BasisAcross(t)).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace plumbline
