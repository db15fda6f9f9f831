// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace plumbline {

// Half of the bits of a descriptor: the most distinctive ones, beginning with the highest bit of
// the first word. The first bits are also hardly correlated, so that they divide features evenly.
// The selection was measured once (docs/methods/places.md).
using Signature = std::array<std::uint32_t, 4>;
inline constexpr int kSignatureBits = 128;

// Return the signature of a point's descriptor (ORB), and of a line's (LBD). Cost: a tenth of a
// microsecond.
Signature PointSignature(const Descriptor& descriptor);
Signature LineSignature(const Descriptor& descriptor);

// Returns bit `index` of a signature, counted from the first.
inline bool BitOf(const Signature& signature, int index) {
  const auto bit = static_cast<unsigned>(index);
  return (signature[bit / 32] >> (31 - bit % 32) & 1U) != 0;
}

// Returns the number of differing bits.
inline int HammingDistance(const Signature& a, const Signature& b) {
  const auto pair = [](std::uint32_t high, std::uint32_t low) {
    return std::uint64_t{high} << 32U | low;
  };
  return CountBits(std::array{pair(a[0] ^ b[0], a[1] ^ b[1]), pair(a[2] ^ b[2], a[3] ^ b[3])});
}

// Identifies a feature of a keyframe in an index, by the keyframe's slot and the feature's index in
// it.
struct FeatureName {
  static constexpr std::uint32_t kFeatureBits = 9;
  static constexpr std::uint32_t kMaxFeatures = 1U << kFeatureBits;
  static constexpr std::uint32_t kMaxSlots = 1U << (32 - kFeatureBits);

  std::uint32_t value = 0;

  static FeatureName Of(std::uint32_t slot, std::size_t feature) {
    return {slot << kFeatureBits | static_cast<std::uint32_t>(feature)};
  }
  std::uint32_t slot() const { return value >> kFeatureBits; }
  std::uint32_t feature() const { return value & (kMaxFeatures - 1); }

  friend auto operator<=>(FeatureName, FeatureName) = default;
};

// Signatures by slot. Each slot has the same capacity, so that the address of a signature follows
// from its name: a query spends most of its time on waiting for signatures.
class SignatureTable {
 public:
  // `room` is the capacity of a slot, at most FeatureName::kMaxFeatures.
  explicit SignatureTable(std::size_t room);

  // Throws BugError for more signatures than the capacity or the number of names.
  void Set(std::uint32_t slot, std::span<const Signature> signatures);

  std::span<const Signature> Of(std::uint32_t slot) const {
    return {blocks_[slot / kBlock].get() + slot % kBlock * room_, counts_[slot]};
  }
  // Returns the number of signatures of a slot.
  std::size_t Count(std::uint32_t slot) const { return counts_[slot]; }
  const Signature& operator[](FeatureName name) const {
    return blocks_[name.slot() / kBlock][name.slot() % kBlock * room_ + name.feature()];
  }
  // Reads the signatures of these features, which lie far apart in memory. Without branches between
  // reads the processor fetches several at once.
  void Read(std::span<const FeatureName> names, std::vector<Signature>* signatures) const {
    signatures->resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) (*signatures)[i] = (*this)[names[i]];
  }

  // Returns the memory in bytes, including reserves.
  std::size_t Memory() const;

 private:
  static constexpr std::uint32_t kBlock = 16;  // slots in a block of memory

  std::size_t room_;
  std::vector<std::unique_ptr<Signature[]>> blocks_;
  std::vector<std::uint16_t> counts_;  // number of signatures of each slot
};

// Sorts features by some bits of their signatures: a binary tree whose node at depth d tests bit
// first_bit + d * step. It stores only the names of the features; a table has their signatures. A
// leaf holds up to kLeafCapacity features, more only at kMaxDepth.
//
// The tree is a function of its content, independent of earlier additions and removals: a node has
// children exactly if more than kLeafCapacity features are below it. A rebuilt tree therefore gives
// the same results.
//
// Memory: about 6 bytes a feature. Adding, removing and finding a leaf take O(depth).
class SignatureTree {
 public:
  static constexpr std::uint32_t kLeafCapacity = 48;
  static constexpr int kMaxDepth = 32;
  static constexpr std::uint32_t kTooCommon = 512;

  // Throws BugError if signatures have too few bits.
  explicit SignatureTree(int first_bit = 0, int step = 1);

  // Adds a feature of the table. The table must be the same in all calls, and still contain a
  // feature at its removal.
  void Add(FeatureName feature, const SignatureTable& table);
  // Removes a feature. Throws BugError if it is not in the tree.
  void Remove(FeatureName feature, const SignatureTable& table);

  // Returns the features of the leaf of a signature, in no particular order; none if these are more
  // than kTooCommon, since ubiquitous features are not distinctive. Valid until the next change.
  std::span<const FeatureName> Alike(const Signature& signature) const;
  // Equals Alike for many signatures, but faster: all of them descend the tree side by side, so
  // that the processor waits for the nodes of several at once.
  std::vector<std::span<const FeatureName>> Alike(std::span<const Signature> signatures) const;

  std::uint32_t size() const { return nodes_[kRoot].count; }
  // Returns the memory of nodes and leaves in bytes, including reserves.
  std::size_t Memory() const;

 private:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr std::uint32_t kStep = 8;  // increment of the capacity of leaves
  struct Node {
    std::uint32_t count = 0;              // features below the node
    std::uint32_t children = 0;           // index of the first of two children; 0: a leaf
    std::unique_ptr<FeatureName[]> leaf;  // capacity: `count` rounded up to kStep
  };

  std::uint32_t Child(std::uint32_t node, int depth, const Signature& signature) const {
    return nodes_[node].children + (BitOf(signature, first_bit_ + depth * step_) ? 1 : 0);
  }
  std::span<const FeatureName> Telling(const Node& leaf) const;
  std::uint32_t NewPair();
  void Put(Node& leaf, FeatureName feature);
  void Split(std::uint32_t node, int depth, const SignatureTable& table);
  void Gather(std::uint32_t node, std::vector<FeatureName>* features);
  void Join(std::uint32_t node);

  int first_bit_;
  int step_;
  std::vector<Node> nodes_ = std::vector<Node>(1);
  std::vector<std::uint32_t> free_pairs_;  // unused pairs of children
};

}  // namespace plumbline
