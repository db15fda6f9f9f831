// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/place/signature.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace plumbline {

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

}  // namespace plumbline
