// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/signature_tree.h"

#include "plumbline/base/error.h"
#include "plumbline/base/random.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr std::size_t kRoom = 100;  // features of a slot

// Clumps, so that some parts of the tree are deep.
SignatureTable Table(std::uint32_t slots) {
  Rng rng(7, "signatures");
  SignatureTable table(kRoom);
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    std::vector<Signature> signatures(kRoom);
    for (std::size_t i = 0; i < kRoom; ++i) {
      for (std::uint32_t& word : signatures[i]) word = static_cast<std::uint32_t>(rng.Next());
      if (i % 2 == 0) signatures[i][0] = 0x5a5a0000U | signatures[i][0] >> 22U;
    }
    table.Set(slot, signatures);
  }
  return table;
}

void AddSlot(std::uint32_t slot, const SignatureTable& table, SignatureTree& tree) {
  for (std::size_t i = 0; i < table.Count(slot); ++i) tree.Add(FeatureName::Of(slot, i), table);
}

void RemoveSlot(std::uint32_t slot, const SignatureTable& table, SignatureTree& tree) {
  for (std::size_t i = 0; i < table.Count(slot); ++i) tree.Remove(FeatureName::Of(slot, i), table);
}

std::vector<FeatureName> Sorted(std::span<const FeatureName> features) {
  std::vector<FeatureName> sorted(features.begin(), features.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

bool Shows(std::span<const FeatureName> features, FeatureName feature) {
  return std::find(features.begin(), features.end(), feature) != features.end();
}

TEST(SignatureTree, FindsWhatIsInIt) {
  const SignatureTable table = Table(50);
  SignatureTree tree;
  for (std::uint32_t slot = 0; slot < 50; ++slot) AddSlot(slot, table, tree);
  EXPECT_EQ(tree.size(), 50 * kRoom);
  for (std::uint32_t slot = 0; slot < 50; ++slot) {
    const FeatureName feature = FeatureName::Of(slot, slot);
    const auto alike = tree.Alike(table[feature]);
    EXPECT_TRUE(Shows(alike, feature));
    EXPECT_LE(alike.size(), SignatureTree::kLeafCapacity);
  }
}

// Whatever a tree does not ask may differ.
TEST(SignatureTree, AsksItsBitsAlone) {
  constexpr int kStep = 3;
  const SignatureTable table = Table(50);
  for (int first = 0; first < kStep; ++first) {
    SignatureTree tree(first, kStep);
    for (std::uint32_t slot = 0; slot < 50; ++slot) AddSlot(slot, table, tree);
    const FeatureName feature = FeatureName::Of(20, 5);
    Signature other = table[feature];
    for (int bit = 0; bit < kSignatureBits; ++bit) {
      const auto place = static_cast<unsigned>(bit);
      if (bit % kStep != first) other[place / 32] ^= 1U << (31 - place % 32);
    }
    EXPECT_EQ(Sorted(tree.Alike(other)), Sorted(tree.Alike(table[feature])));
    other[0] ^= 1U << (31 - static_cast<unsigned>(first));  // the bit of the root
    EXPECT_FALSE(Shows(tree.Alike(other), feature));
  }
  EXPECT_THROW(SignatureTree(40, kStep), BugError);
}

TEST(SignatureTree, IsAFunctionOfWhatIsInIt) {
  const SignatureTable table = Table(40);
  SignatureTree grown;  // all, and half of them leave
  for (std::uint32_t slot = 0; slot < 40; ++slot) AddSlot(slot, table, grown);
  for (std::uint32_t slot = 0; slot < 20; ++slot) RemoveSlot(slot, table, grown);
  SignatureTree anew;  // the other half, in another order
  for (std::uint32_t slot = 39; slot >= 20; --slot) AddSlot(slot, table, anew);
  EXPECT_EQ(grown.size(), anew.size());
  for (std::uint32_t slot = 0; slot < 40; ++slot) {
    for (std::size_t i = 0; i < kRoom; i += 7) {
      const Signature& signature = table[FeatureName::Of(slot, i)];
      EXPECT_EQ(Sorted(grown.Alike(signature)), Sorted(anew.Alike(signature)));
    }
  }
}

TEST(SignatureTree, AnswersForManyAsForEach) {
  const SignatureTable table = Table(50);
  SignatureTree tree;
  for (std::uint32_t slot = 0; slot < 50; ++slot) AddSlot(slot, table, tree);
  std::vector<Signature> signatures;
  for (std::uint32_t slot = 0; slot < 50; ++slot) {
    signatures.push_back(table[FeatureName::Of(slot, slot)]);
  }
  const auto all = tree.Alike(std::span<const Signature>(signatures));
  ASSERT_EQ(all.size(), signatures.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(Sorted(all[i]), Sorted(tree.Alike(signatures[i])));
  }
  EXPECT_TRUE(tree.Alike(std::span<const Signature>()).empty());
}

TEST(SignatureTree, RemovesOneFeatureOnly) {
  SignatureTable table(2);
  table.Set(0, std::vector<Signature>(2, Signature{1, 2, 3, 4}));
  SignatureTree tree;
  tree.Add(FeatureName::Of(0, 0), table);
  EXPECT_THROW(tree.Remove(FeatureName::Of(0, 1), table), BugError);
  tree.Add(FeatureName::Of(0, 1), table);
  tree.Remove(FeatureName::Of(0, 0), table);
  EXPECT_EQ(Sorted(tree.Alike(Signature{1, 2, 3, 4})),
            std::vector<FeatureName>{FeatureName::Of(0, 1)});
}

TEST(SignatureTree, SaysNothingOfWhatIsEverywhere) {
  SignatureTable table(1);
  const Signature common{5, 6, 7, 8};
  SignatureTree tree;
  for (std::uint32_t slot = 0; slot <= SignatureTree::kTooCommon; ++slot) {
    table.Set(slot, std::vector<Signature>{common});
    EXPECT_EQ(tree.Alike(common).size(), slot);
    tree.Add(FeatureName::Of(slot, 0), table);
  }
  EXPECT_TRUE(tree.Alike(common).empty());
  tree.Remove(FeatureName::Of(0, 0), table);
  EXPECT_EQ(tree.Alike(common).size(), SignatureTree::kTooCommon);
}

TEST(SignatureTree, GivesBackItsRoom) {
  const SignatureTable table = Table(200);
  SignatureTree tree;
  for (std::uint32_t slot = 0; slot < 200; ++slot) AddSlot(slot, table, tree);
  const std::size_t full = tree.Memory();
  EXPECT_LT(full, 8 * 200 * kRoom);
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t slot = 0; slot < 200; ++slot) RemoveSlot(slot, table, tree);
    EXPECT_EQ(tree.size(), 0U);
    EXPECT_TRUE(tree.Alike(table[FeatureName::Of(0, 0)]).empty());
    for (std::uint32_t slot = 0; slot < 200; ++slot) AddSlot(slot, table, tree);
  }
  EXPECT_LT(tree.Memory(), full + full / 10);
}

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
