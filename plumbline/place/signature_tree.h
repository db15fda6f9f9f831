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

// Features by some bits of their signatures: a binary tree whose node at depth d asks bit
// first_bit + d * step. It keeps only the names of the features; a table has
// their signatures. Leaves hold up to kLeafCapacity of them, more only at kMaxDepth.
//
// The tree is a function of what is in it, whatever came and went before: a node has children
// exactly when more than kLeafCapacity features are below it. So a tree that is made anew answers
// as the one that grew.
//
// Memory: about 6 bytes a feature. Adding, removing and finding a leaf take O(depth).
class SignatureTree {
 public:
  static constexpr std::uint32_t kLeafCapacity = 48;
  static constexpr int kMaxDepth = 32;
  static constexpr std::uint32_t kTooCommon = 512;

  // BugError where the signature has not so many bits.
  explicit SignatureTree(int first_bit = 0, int step = 1);

  // Features of the table, which is the same in all calls and still has them when they are removed.
  void Add(FeatureName feature, const SignatureTable& table);
  // BugError where it is not in the tree.
  void Remove(FeatureName feature, const SignatureTable& table);

  // The features of the leaf that a signature falls into, in no particular order. None where these
  // are more than kTooCommon: what looks the same everywhere tells nothing. Valid until the next
  // change.
  std::span<const FeatureName> Alike(const Signature& signature) const;
  // Alike of many signatures, in less time: all of them go down the tree side by side, so that
  // the processor waits for the nodes of several at once.
  std::vector<std::span<const FeatureName>> Alike(std::span<const Signature> signatures) const;

  std::uint32_t size() const { return nodes_[kRoot].count; }
  // Bytes of the nodes and leaves, with what is set aside for more.
  std::size_t Memory() const;

 private:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr std::uint32_t kStep = 8;  // that leaves grow by
  struct Node {
    std::uint32_t count = 0;              // features below
    std::uint32_t children = 0;           // index of the first of two; 0: a leaf
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
  std::vector<std::uint32_t> free_pairs_;  // pairs of children that are no more
};

}  // namespace plumbline
