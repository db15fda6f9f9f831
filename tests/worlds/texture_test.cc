// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/texture.h"

#include "worlds/noise.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr Material kMaterials[] = {Material::kPaint,
                                   Material::kPlaster,
                                   Material::kPlanks,
                                   Material::kWood,
                                   Material::kTiles,
                                   Material::kCarpet,
                                   Material::kPoster,
                                   Material::kCardboard,
                                   Material::kBrick,
                                   Material::kSpine,
                                   Material::kMetal,
                                   Material::kConcrete,
                                   Material::kFabric,
                                   Material::kAcoustic,
                                   Material::kScreen,
                                   Material::kMural};

TEST(Noise, NormalHasUnitVarianceAndNoMean) {
  double sum = 0, squares = 0;
  constexpr int kCount = 200'000;
  for (int i = 0; i < kCount; ++i) {
    const double value = NormalFromHash(HashCell(i % 500, i / 500, 3));
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.015);
}

TEST(Noise, NeighbouringCellsAreNotCorrelated) {
  double product = 0;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    product += static_cast<double>(NormalFromHash(HashCell(i, 0, 3))) *
               static_cast<double>(NormalFromHash(HashCell(i + 1, 0, 3)));
  }
  EXPECT_NEAR(product / kCount, 0, 0.015);
}

TEST(Noise, ValueNoiseIsContinuousAndMeetsItsGrid) {
  for (int i = -40; i < 40; ++i) {
    const double x = 0.37 * i, y = -0.21 * i;
    EXPECT_NEAR(ValueNoise(x, y, 1), ValueNoise(x + 1e-6, y - 1e-6, 1), 2e-5);
    EXPECT_NEAR(ValueNoise(i, -i, 1), 2 * UnitFromHash(HashCell(i, -i, 1)) - 1, 1e-15);
    EXPECT_LE(std::abs(FractalNoise(x, y, 4, 0.8, 1)), 1);
  }
}

TEST(Texture, ReflectanceStaysInRangeAndVaries) {
  for (const Material material : kMaterials) {
    double low = 1, high = 0;
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) {
        const double value =
            EvaluateTexture({material, 0.5, 7, 0.2}, 0.6 * i / 60, 0.8 * j / 60, 0.6, 0.8);
        ASSERT_TRUE(value >= 0 && value <= 1);
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    EXPECT_GT(high - low, 0.05) << static_cast<int>(material);
  }
}

TEST(Texture, SeedsMakeDifferentSurfaces) {
  for (const Material material : kMaterials) {
    double difference = 0;
    for (int i = 0; i < 400; ++i) {
      const double u = 0.03 * (i % 20), v = 0.03 * (i / 20);
      difference += std::abs(EvaluateTexture({material, 0.5, 1, 0}, u, v, 0.6, 0.6) -
                             EvaluateTexture({material, 0.5, 2, 0}, u, v, 0.6, 0.6));
    }
    EXPECT_GT(difference / 400, 0.01) << static_cast<int>(material);
  }
}

TEST(Texture, SamplesAreTheRecipe) {
  const TextureRecipe recipe{Material::kPlaster, 0.9, 5, 0};
  constexpr double kSize = 0.48;
  const Texture texture = Texture::Bake(recipe, kSize, kSize, 0.01);
  ASSERT_EQ(texture.width(), 48);
  for (int y = 0; y < texture.height(); ++y) {
    for (int x = 0; x < texture.width(); ++x) {
      const double a = (x + 0.5) / 48, b = (y + 0.5) / 48;
      const double expected = 255 * EvaluateTexture(recipe, kSize * a, kSize * b, kSize, kSize);
      EXPECT_NEAR(texture.Sample(static_cast<float>(a), static_cast<float>(b), 0), expected, 0.51);
    }
  }
}

TEST(Texture, CellsOnAnEdgeAreMeansOverTheCell) {
  // A joint of form boards from 1.2 to 1.206 m, which no cell meets exactly.
  const TextureRecipe recipe{Material::kConcrete, 0.6, 5, 0};
  constexpr double kWidth = 0.64, kHeight = 1.6;
  constexpr int kFine = 40;
  for (const double texel : {0.003, 0.005, 0.0073}) {
    const Texture texture = Texture::Bake(recipe, kWidth, kHeight, texel);
    for (int y = 0; y < texture.height(); ++y) {
      const double b = (y + 0.5) / texture.height();
      if (std::abs(kHeight * b - 1.203) > 0.03) continue;
      double baked = 0, mean = 0;  // over the row, for the grain is not averaged over cells
      for (int x = 0; x < texture.width(); ++x) {
        const double a = (x + 0.5) / texture.width();
        baked +=
            static_cast<double>(texture.Sample(static_cast<float>(a), static_cast<float>(b), 0));
        for (int k = 0; k < kFine; ++k) {
          const double v = kHeight * (y + (k + 0.5) / kFine) / texture.height();
          mean += 255.0 / kFine * EvaluateTexture(recipe, kWidth * a, v, kWidth, kHeight);
        }
      }
      EXPECT_NEAR(baked / texture.width(), mean / texture.width(), 1.2) << texel << ' ' << y;
    }
  }
}

TEST(Texture, HalvedLevelsStayInPlace) {
  const Texture texture = Texture::Bake({Material::kPoster, 0.9, 5, 0}, 0.64, 0.32, 0.01);
  ASSERT_EQ(texture.width(), 64);
  for (int y = 0; y < texture.height() / 2; ++y) {
    for (int x = 0; x < texture.width() / 2; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      float mean = 0;
      for (const float dy : {0.5F, 1.5F}) {
        for (const float dx : {0.5F, 1.5F}) {
          mean += 0.25F * texture.Sample((2 * fx + dx) / 64, (2 * fy + dy) / 32, 0);
        }
      }
      EXPECT_NEAR(texture.Sample((fx + 0.5F) / 32, (fy + 0.5F) / 16, 1), mean, 0.6);
    }
  }
  EXPECT_EQ(texture.LevelFor(0.5F), 0);
  EXPECT_EQ(texture.LevelFor(2.0F), 1);
  EXPECT_EQ(texture.LevelFor(1e9F), 6);
}

}  // namespace
}  // namespace plumbline
