// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/place/signature_table.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace plumbline {

// Sorts features by some bits of their signatures: a binary tree whose node at depth d asks bit
// first_bit + d * step. It keeps only the names of the features; a table has their signatures. A
// leaf holds up to kLeafCapacity features, more only at kMaxDepth.
//
// The tree is a function of what is in it, whatever came and went before: a node has children
// exactly when more than kLeafCapacity features are below it. A tree that is made anew therefore
// answers like the one that grew.
//
// Memory: about 6 bytes a feature. Adding, removing and finding a leaf take O(depth).
class SignatureTree {
 public:
  static constexpr std::uint32_t kLeafCapacity = 48;
  static constexpr int kMaxDepth = 32;
  static constexpr std::uint32_t kTooCommon = 512;

  // Throws BugError where signatures have too few bits.
  explicit SignatureTree(int first_bit = 0, int step = 1);

  // Adds a feature of the table. The table must be the same in all calls, and still have a feature
  // when it is removed.
  void Add(FeatureName feature, const SignatureTable& table);
  // Removes a feature. Throws BugError where it is not in the tree.
  void Remove(FeatureName feature, const SignatureTable& table);

  // Returns the features of the leaf into which a signature falls, in no particular order. Returns
  // none where these are more than kTooCommon, since what looks the same everywhere tells nothing.
  // Valid until the next change.
  std::span<const FeatureName> Alike(const Signature& signature) const;
  // Does Alike for many signatures, in less time: all of them go down the tree side by side, so
  // that the processor waits for the nodes of several at once.
  std::vector<std::span<const FeatureName>> Alike(std::span<const Signature> signatures) const;

  std::uint32_t size() const { return nodes_[kRoot].count; }
  // Returns the bytes of nodes and leaves, reserves included.
  std::size_t Memory() const;

 private:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr std::uint32_t kStep = 8;  // number of entries by which leaves grow
  struct Node {
    std::uint32_t count = 0;              // features below the node
    std::uint32_t children = 0;           // index of the first of two children; 0: a leaf
    std::unique_ptr<FeatureName[]> leaf;  // room for `count`, rounded up to kStep
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
  std::vector<std::uint32_t> free_pairs_;  // pairs of children that are not used any more
};

}  // namespace plumbline
