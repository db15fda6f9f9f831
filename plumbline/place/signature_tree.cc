// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/place/signature_tree.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

std::uint32_t RoundedUp(std::uint32_t count, std::uint32_t step) {
  return (count + step - 1) / step * step;
}

}  // namespace

SignatureTree::SignatureTree(int first_bit, int step) : first_bit_(first_bit), step_(step) {
  PLUMBLINE_CHECK(first_bit >= 0 && step > 0 && first_bit + (kMaxDepth - 1) * step < kSignatureBits,
                  "a tree that asks more bits than there are");
}

void SignatureTree::Add(FeatureName feature, const SignatureTable& table) {
  std::uint32_t node = kRoot;
  int depth = 0;
  for (; nodes_[node].children != 0; ++depth) {
    ++nodes_[node].count;
    node = Child(node, depth, table[feature]);
  }
  Put(nodes_[node], feature);
  Split(node, depth, table);
}

void SignatureTree::Remove(FeatureName feature, const SignatureTable& table) {
  std::vector<std::uint32_t> path{kRoot};
  while (nodes_[path.back()].children != 0) {
    path.push_back(Child(path.back(), static_cast<int>(path.size()) - 1, table[feature]));
  }
  const Node& leaf = nodes_[path.back()];
  FeatureName* const end = leaf.leaf.get() + leaf.count;
  FeatureName* const gone = std::find(leaf.leaf.get(), end, feature);
  PLUMBLINE_CHECK(gone != end, "a feature is missing in its tree");
  *gone = *(end - 1);
  for (const std::uint32_t node : path) --nodes_[node].count;
  const auto joined = std::find_if(path.begin(), path.end(), [&](std::uint32_t node) {
    return nodes_[node].children != 0 && nodes_[node].count <= kLeafCapacity;
  });
  if (joined != path.end()) Join(*joined);
}

std::span<const FeatureName> SignatureTree::Alike(const Signature& signature) const {
  std::uint32_t node = kRoot;
  for (int depth = 0; nodes_[node].children != 0; ++depth) node = Child(node, depth, signature);
  return Telling(nodes_[node]);
}

std::vector<std::span<const FeatureName>> SignatureTree::Alike(
    std::span<const Signature> signatures) const {
  std::vector<std::uint32_t> nodes(signatures.size(), kRoot);
  bool deeper = true;
  for (int depth = 0; deeper; ++depth) {
    deeper = false;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes_[nodes[i]].children == 0) continue;
      nodes[i] = Child(nodes[i], depth, signatures[i]);
      deeper = true;
    }
  }
  std::vector<std::span<const FeatureName>> leaves;
  leaves.reserve(nodes.size());
  for (const std::uint32_t node : nodes) leaves.push_back(Telling(nodes_[node]));
  return leaves;
}

std::span<const FeatureName> SignatureTree::Telling(const Node& leaf) const {
  if (leaf.count > kTooCommon) return {};
  return {leaf.leaf.get(), leaf.count};
}

std::size_t SignatureTree::Memory() const {
  constexpr std::size_t kBlock = 8;  // overhead of an allocation
  std::size_t bytes =
      nodes_.capacity() * sizeof(Node) + free_pairs_.capacity() * sizeof(std::uint32_t);
  for (const Node& node : nodes_) {
    if (node.leaf == nullptr) continue;
    bytes += RoundedUp(node.count, kStep) * sizeof(FeatureName) + kBlock;
  }
  return bytes;
}

std::uint32_t SignatureTree::NewPair() {
  if (!free_pairs_.empty()) {
    const std::uint32_t first = free_pairs_.back();
    free_pairs_.pop_back();
    return first;
  }
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  return first;
}

// Leaves grow by few at a time: there are many, and doubling would waste a third.
void SignatureTree::Put(Node& leaf, FeatureName feature) {
  if (leaf.count % kStep == 0) {
    auto larger = std::make_unique<FeatureName[]>(leaf.count + kStep);
    std::copy_n(leaf.leaf.get(), leaf.count, larger.get());
    leaf.leaf = std::move(larger);
  }
  leaf.leaf[leaf.count++] = feature;
}

void SignatureTree::Split(std::uint32_t node, int depth, const SignatureTable& table) {
  while (nodes_[node].count > kLeafCapacity && depth < kMaxDepth) {
    const std::uint32_t children = NewPair();
    nodes_[node].children = children;
    const auto features = std::exchange(nodes_[node].leaf, nullptr);
    for (std::uint32_t i = 0; i < nodes_[node].count; ++i) {
      Put(nodes_[Child(node, depth, table[features[i]])], features[i]);
    }
    // At most one of the two children has too many features, which then are all of them.
    node = nodes_[children].count > kLeafCapacity ? children : children + 1;
    ++depth;
  }
}

void SignatureTree::Gather(std::uint32_t node, std::vector<FeatureName>* features) {
  const std::uint32_t children = nodes_[node].children;
  if (children != 0) {
    Gather(children, features);
    Gather(children + 1, features);
    free_pairs_.push_back(children);
  } else {
    const FeatureName* first = nodes_[node].leaf.get();
    features->insert(features->end(), first, first + nodes_[node].count);
  }
  nodes_[node] = Node();
}

// Makes a node a leaf.
void SignatureTree::Join(std::uint32_t node) {
  std::vector<FeatureName> features;
  Gather(node, &features);
  for (const FeatureName feature : features) Put(nodes_[node], feature);
}

}  // namespace plumbline
