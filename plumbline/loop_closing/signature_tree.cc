// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/signature_tree.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <utility>

namespace plumbline {
namespace {

std::uint32_t RoundedUp(std::uint32_t count, std::uint32_t step) {
  return (count + step - 1) / step * step;
}

// The indices of bits in a descriptor of 256 bits.
using BitOrder = std::array<std::uint8_t, kSignatureBits>;

constexpr BitOrder kPointBits = {
    150, 1,   235, 126, 167, 237, 65,  20,  27,  92,  163, 30,  242, 71,  103, 197, 133, 225, 115,
    16,  200, 42,  11,  31,  145, 176, 32,  214, 199, 39,  252, 21,  169, 186, 93,  48,  75,  185,
    58,  14,  89,  246, 241, 40,  85,  155, 43,  86,  22,  51,  23,  144, 76,  96,  107, 95,  77,
    72,  125, 111, 182, 113, 204, 171, 63,  233, 146, 104, 15,  194, 139, 110, 33,  25,  141, 101,
    7,   127, 19,  202, 56,  83,  69,  138, 117, 211, 116, 105, 230, 136, 223, 97,  207, 191, 209,
    208, 81,  119, 128, 84,  52,  151, 178, 124, 98,  55,  183, 13,  203, 249, 221, 35,  60,  147,
    121, 100, 190, 5,   47,  99,  152, 216, 135, 220, 62,  149, 159, 134};

constexpr BitOrder kLineBits = {
    144, 113, 192, 115, 162, 66,  59,  233, 219, 149, 49,  234, 65,  197, 20,  248, 2,   15,  255,
    254, 100, 32,  142, 214, 141, 0,   54,  239, 253, 5,   124, 88,  45,  177, 182, 143, 181, 46,
    102, 191, 39,  236, 62,  95,  215, 225, 251, 37,  3,   55,  6,   84,  105, 153, 106, 129, 172,
    212, 92,  135, 134, 18,  198, 71,  206, 93,  30,  31,  94,  207, 231, 22,  52,  249, 17,  250,
    23,  238, 14,  246, 7,   108, 112, 116, 176, 160, 136, 156, 140, 145, 180, 64,  125, 128, 216,
    188, 68,  178, 139, 24,  99,  56,  35,  151, 202, 86,  224, 78,  150, 158, 167, 126, 118, 204,
    220, 79,  211, 183, 218, 210, 28,  91,  77,  70,  60,  228, 190, 103};

Signature Select(const Descriptor& descriptor, const BitOrder& order) {
  Signature signature{};
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint64_t bit = descriptor[order[i] / 64U] >> (order[i] % 64U) & 1U;
    signature[i / 32] = signature[i / 32] << 1U | static_cast<std::uint32_t>(bit);
  }
  return signature;
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

SignatureTable::SignatureTable(std::size_t room) : room_(room) {
  PLUMBLINE_CHECK(room <= FeatureName::kMaxFeatures, "more features than names");
}

void SignatureTable::Set(std::uint32_t slot, std::span<const Signature> signatures) {
  PLUMBLINE_CHECK(slot < FeatureName::kMaxSlots && signatures.size() <= room_,
                  "more keyframes than names, or more features than there is room for");
  while (blocks_.size() <= slot / kBlock) {
    blocks_.push_back(std::make_unique<Signature[]>(kBlock * room_));
  }
  if (counts_.size() <= slot) counts_.resize(slot + 1);
  counts_[slot] = static_cast<std::uint16_t>(signatures.size());
  std::copy(
      signatures.begin(), signatures.end(), blocks_[slot / kBlock].get() + slot % kBlock * room_);
}

std::size_t SignatureTable::Memory() const {
  return blocks_.size() * kBlock * room_ * sizeof(Signature) +
         blocks_.capacity() * sizeof(blocks_[0]) + counts_.capacity() * sizeof(counts_[0]);
}

Signature PointSignature(const Descriptor& descriptor) { return Select(descriptor, kPointBits); }

Signature LineSignature(const Descriptor& descriptor) { return Select(descriptor, kLineBits); }

}  // namespace plumbline
