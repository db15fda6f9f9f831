// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/grid.h"

#include "plumbline/base/random.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<int> InWindow(const PointGrid& grid,
                          const std::vector<Eigen::Vector2d>& positions,
                          const Eigen::Vector2d& center,
                          const Eigen::Vector2d& radius) {
  std::vector<int> found;
  const auto position_of = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
  grid.InWindow(center, radius, position_of, &found);
  return found;
}

TEST(PointGrid, FindsExactlyWhatACompleteSearchFinds) {
  Rng rng(1, "grid");
  std::vector<Eigen::Vector2d> positions;
  for (int i = 0; i < 500; ++i) {
    const double x = rng.Uniform(-30, 350);  // some outside the image
    positions.emplace_back(x, rng.Uniform(-30, 270));
  }
  const PointGrid grid(positions, 320, 240, 25);
  for (int query = 0; query < 200; ++query) {
    const double x = rng.Uniform(-50, 370);
    const Eigen::Vector2d center(x, rng.Uniform(-50, 290));
    const double radius_x = rng.Uniform(0, 60);
    const Eigen::Vector2d radius(radius_x, rng.Uniform(0, 60));
    std::vector<int> expected;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d d = positions[static_cast<std::size_t>(i)] - center;
      if (std::abs(d.x()) <= radius.x() && std::abs(d.y()) <= radius.y()) expected.push_back(i);
    }
    EXPECT_THAT(InWindow(grid, positions, center, radius),
                testing::UnorderedElementsAreArray(expected));
  }
}

TEST(PointGrid, TakesPlacesThatAreNoNumbers) {
  const double none = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Vector2d> positions{{none, -none}, {infinite, -infinite}, {5, 5}};
  const PointGrid grid(positions, 320, 240, 25);
  EXPECT_THAT(InWindow(grid, positions, {5, 5}, {1, 1}), testing::ElementsAre(2));
  EXPECT_THAT(InWindow(grid, positions, {none, none}, {1, 1}), testing::IsEmpty());
}

TEST(PointGrid, OfNothingFindsNothing) {
  EXPECT_TRUE(InWindow(PointGrid(), {}, {1, 2}, {100, 100}).empty());
  EXPECT_TRUE(InWindow(PointGrid({}, 10, 10), {}, {1, 2}, {100, 100}).empty());
}

}  // namespace
}  // namespace plumbline
