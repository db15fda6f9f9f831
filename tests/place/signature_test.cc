// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/place/signature.h"

#include "plumbline/base/random.h"

#include <set>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

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
