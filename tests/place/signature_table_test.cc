// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/place/signature_table.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

std::vector<Signature> Numbered(std::uint32_t first, std::size_t count) {
  std::vector<Signature> signatures(count);
  for (std::size_t i = 0; i < count; ++i) {
    signatures[i] = {first + static_cast<std::uint32_t>(i), 0, 0, 0};
  }
  return signatures;
}

TEST(FeatureName, NamesSlotAndFeature) {
  for (const std::uint32_t slot : {0U, 1U, FeatureName::kMaxSlots - 1}) {
    for (const std::uint32_t feature : {0U, 7U, FeatureName::kMaxFeatures - 1}) {
      const FeatureName name = FeatureName::Of(slot, feature);
      EXPECT_EQ(name.slot(), slot);
      EXPECT_EQ(name.feature(), feature);
    }
  }
}

TEST(SignatureTable, GivesWhatWasSet) {
  SignatureTable table(10);
  table.Set(40, Numbered(400, 10));
  table.Set(3, Numbered(30, 4));
  table.Set(4, Numbered(40, 0));
  EXPECT_EQ(table.Count(40), 10U);
  EXPECT_EQ(table.Count(3), 4U);
  EXPECT_EQ(table.Count(4), 0U);
  EXPECT_EQ(table.Count(5), 0U);
  EXPECT_EQ(table[FeatureName::Of(40, 9)][0], 409U);
  EXPECT_EQ(table[FeatureName::Of(3, 2)][0], 32U);
  table.Set(3, Numbered(90, 1));
  EXPECT_EQ(table.Count(3), 1U);
  EXPECT_EQ(table[FeatureName::Of(3, 0)][0], 90U);
}

TEST(SignatureTable, ReadsSeveral) {
  SignatureTable table(10);
  for (std::uint32_t slot = 0; slot < 30; ++slot) table.Set(slot, Numbered(100 * slot, 10));
  std::vector<Signature> read = Numbered(0, 7);
  table.Read(std::vector<FeatureName>{FeatureName::Of(20, 3), FeatureName::Of(1, 9)}, &read);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0][0], 2003U);
  EXPECT_EQ(read[1][0], 109U);
}

TEST(SignatureTable, RefusesMoreThanItHasRoomOrNamesFor) {
  SignatureTable table(10);
  EXPECT_THROW(table.Set(0, Numbered(0, 11)), BugError);
  EXPECT_THROW(table.Set(FeatureName::kMaxSlots, Numbered(0, 1)), BugError);
  EXPECT_THROW(SignatureTable(FeatureName::kMaxFeatures + 1), BugError);
}

TEST(SignatureTable, TakesTheRoomThatWasAskedFor) {
  SignatureTable table(100);
  const std::size_t empty = table.Memory();
  for (std::uint32_t slot = 0; slot < 64; ++slot) table.Set(slot, {});
  EXPECT_GE(table.Memory() - empty, 64 * 100 * sizeof(Signature));
  EXPECT_LE(table.Memory() - empty, 65 * 100 * sizeof(Signature));
}

TEST(Signature, HasEachOfItsBitsOfADescriptorOnce) {
  for (const auto& to_signature : {PointSignature, LineSignature}) {
    std::set<int> places;
    for (std::size_t bit = 0; bit < 256; ++bit) {
      Descriptor descriptor{};
      descriptor[bit / 64] = std::uint64_t{1} << (bit % 64);
      const Signature signature = to_signature(descriptor);
      int set = 0;
      for (int i = 0; i < kSignatureBits; ++i) {
        if (!BitOf(signature, i)) continue;
        ++set;
        places.insert(i);
      }
      EXPECT_LE(set, 1) << bit;
    }
    EXPECT_EQ(places.size(), static_cast<std::size_t>(kSignatureBits));
  }
}

TEST(Signature, DiffersInTheBitsThatDescriptorsDifferIn) {
  Rng rng(3, "signatures");
  Descriptor a{}, b{};
  for (std::uint64_t& word : a) word = rng.Next();
  for (std::uint64_t& word : b) word = rng.Next();
  int differing = 0;
  for (int i = 0; i < kSignatureBits; ++i) {
    differing += BitOf(PointSignature(a), i) != BitOf(PointSignature(b), i);
  }
  EXPECT_EQ(HammingDistance(PointSignature(a), PointSignature(b)), differing);
  EXPECT_LE(differing, HammingDistance(a, b));
  EXPECT_EQ(HammingDistance(LineSignature(a), LineSignature(a)), 0);
}

}  // namespace

}  // namespace plumbline
