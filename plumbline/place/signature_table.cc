// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/place/signature_table.h"

#include "plumbline/base/error.h"

#include <algorithm>

namespace plumbline {

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

}  // namespace plumbline
