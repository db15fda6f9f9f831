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
