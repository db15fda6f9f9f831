// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/polynomial.h"

#include "plumbline/base/random.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Coefficients of the polynomial with these roots and, beside them, x^2 + 1.
std::vector<double> WithRoots(const std::vector<double>& roots, bool with_complex_pair) {
  std::vector<double> c{1};
  for (const double root : roots) {
    c.insert(c.begin(), 0);
    for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= root * c[i + 1];
  }
  if (!with_complex_pair) return c;
  std::vector<double> product(c.size() + 2, 0.0);
  for (std::size_t i = 0; i < c.size(); ++i) {
    product[i] += c[i];
    product[i + 2] += c[i];
  }
  return product;
}

TEST(RealRoots, FindsAllOfThemInsideAndOutsideTheUnitInterval) {
  Rng rng(1);
  for (int run = 0; run < 100; ++run) {
    std::vector<double> roots;
    for (int i = 0; i < 8; ++i) roots.push_back(i - 3.5 + rng.Uniform(-0.4, 0.4));
    roots.back() = rng.Uniform(20, 100);
    const std::vector<double> found = RealRoots(WithRoots(roots, run % 2 == 0));
    std::sort(roots.begin(), roots.end());
    ASSERT_EQ(found.size(), roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) EXPECT_NEAR(found[i] / roots[i], 1, 1e-6);
  }
}

TEST(RealRoots, NoneWhereThereIsNone) {
  EXPECT_TRUE(RealRoots(std::array{1.0, 0.0, 1.0}).empty());
  EXPECT_TRUE(RealRoots(std::array{3.0}).empty());
  EXPECT_TRUE(RealRoots(std::array<double, 0>{}).empty());
}

TEST(RealRoots, ZeroLeadingAndConstantCoefficients) {
  const auto roots = RealRoots(std::array{0.0, -2.0, 1.0, 0.0, 0.0});  // x (x - 2)
  ASSERT_EQ(roots.size(), 2U);
  EXPECT_NEAR(roots[0], 0, 1e-12);
  EXPECT_NEAR(roots[1], 2, 1e-12);
}

}  // namespace
}  // namespace plumbline
