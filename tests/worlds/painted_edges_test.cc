// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/painted_edges.h"

#include "worlds/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr double kWidth = 1.1, kHeight = 0.9;
constexpr std::array kDrawn{Material::kPlanks,
                            Material::kTiles,
                            Material::kBrick,
                            Material::kConcrete,
                            Material::kPoster,
                            Material::kCardboard,
                            Material::kSpine,
                            Material::kScreen,
                            Material::kCarpet};

// Mean reflectance along a line parallel to the edge, `offset` metres to its left.
double MeanBeside(const TextureRecipe& recipe, const Segment2& edge, double offset) {
  constexpr int kPlaces = 60;
  const Vector2d along = edge.end - edge.start;
  const Vector2d across = Vector2d(-along.y(), along.x()).normalized();
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const Vector2d at = edge.start + (i + 0.5) / kPlaces * along + offset * across;
    sum += EvaluateTexture(recipe, at.x(), at.y(), kWidth, kHeight);
  }
  return sum / kPlaces;
}

TEST(PaintedEdges, TheReflectanceStepsWithinAFractionOfAMillimetre) {
  constexpr double kStride = 0.0002;
  for (const Material material : kDrawn) {
    int far = 0, count = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const TextureRecipe recipe{material, 0.5, seed};
      for (const Segment2& edge : PaintedEdges(recipe, kWidth, kHeight)) {
        // Beside the edge from 2 mm at the right to 2 mm at the left, and where the five to the
        // right differ most from the five to the left.
        std::array<double, 20> beside{};
        for (std::size_t i = 0; i < beside.size(); ++i) {
          beside[i] = MeanBeside(recipe, edge, (static_cast<double>(i) - 9.5) * kStride);
        }
        double place = 0, largest = 0;
        for (std::size_t i = 5; i + 5 <= beside.size(); ++i) {
          const auto middle = beside.begin() + static_cast<std::ptrdiff_t>(i);
          const double step = std::abs(std::accumulate(middle - 5, middle, 0.0) -
                                       std::accumulate(middle, middle + 5, 0.0)) /
                              5;
          if (step <= largest) continue;
          largest = step;
          place = (static_cast<double>(i) - 10) * kStride;
        }
        ++count;
        if (std::abs(place) > 1.01 * kStride || largest < 0.025) ++far;
      }
    }
    EXPECT_GE(count, 3) << static_cast<int>(material);
    // What is printed on a window below another one comes up to the edge of the upper one.
    const int allowed = material == Material::kScreen ? count / 4 : count / 50;
    EXPECT_LE(far, allowed) << static_cast<int>(material) << " of " << count;
  }
}

TEST(PaintedEdges, GrownMaterialsHaveNone) {
  for (const Material material : {Material::kPaint,
                                  Material::kPlaster,
                                  Material::kWood,
                                  Material::kMetal,
                                  Material::kFabric,
                                  Material::kAcoustic,
                                  Material::kMural,
                                  Material::kBlank}) {
    EXPECT_TRUE(PaintedEdges({material, 0.5, 1}, kWidth, kHeight).empty());
  }
}

TEST(PaintedEdges, APieceOfASheetHasThoseOfTheSheetThere) {
  const Vector2d corner(0.4, 0.25), size(0.5, 0.45);
  for (const Material material : kDrawn) {
    const TextureRecipe whole{material, 0.5, 4};
    TextureRecipe part = whole;
    part.sheet_u = corner.x();
    part.sheet_v = corner.y();
    part.sheet_width = kWidth;
    part.sheet_height = kHeight;
    const auto sheet = PaintedEdges(whole, kWidth, kHeight);
    for (const Segment2& edge : PaintedEdges(part, size.x(), size.y())) {
      for (const Vector2d& end : {edge.start, edge.end}) {
        EXPECT_TRUE(Eigen::AlignedBox2d(Vector2d::Constant(-1e-9), size + Vector2d::Constant(1e-9))
                        .contains(end));
      }
      const Vector2d middle = corner + edge.Midpoint();
      const bool found = std::any_of(sheet.begin(), sheet.end(), [&](const Segment2& other) {
        const double length = other.Length();
        return (middle - other.start).norm() + (middle - other.end).norm() < length + 1e-6;
      });
      EXPECT_TRUE(found) << static_cast<int>(material) << ": " << middle.transpose();
    }
  }
}

TEST(PaintedEdges, AJointHasTwoSidesAndRunsThroughCrossings) {
  // Tiles of 0.3 m: joints of 6 mm that begin at 0 (whose first side is the rim), 0.3, 0.6, 0.9 m.
  const TextureRecipe tiles{Material::kTiles, 0.6, 3};
  std::set<double> upright;
  double longest = 0;
  for (const Segment2& edge : PaintedEdges(tiles, kWidth, kHeight)) {
    if (edge.start.x() != edge.end.x()) continue;
    upright.insert(edge.start.x());
    longest = std::max(longest, edge.Length());
  }
  const std::vector<double> places(upright.begin(), upright.end());
  EXPECT_THAT(
      places,
      testing::Pointwise(testing::DoubleNear(1e-12), {0.006, 0.3, 0.306, 0.6, 0.606, 0.9, 0.906}));
  EXPECT_NEAR(longest, 0.9 - 0.006, 0.01);
}

TEST(PaintedEdges, ThoseShorterThanAskedAreLeftOut) {
  for (const Material material : kDrawn) {
    for (const Segment2& edge :
         PaintedEdges({material, 0.5, 1}, kWidth, kHeight, {.min_length = 0.15})) {
      EXPECT_GE(edge.Length(), 0.15);
    }
  }
}

}  // namespace
}  // namespace plumbline
