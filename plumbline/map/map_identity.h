// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace plumbline {

// Tells a map from its copies, which have the same id but may go on differently. A copy gets an
// identity of its own; a map that is moved takes its identity along.
class MapIdentity {
 public:
  MapIdentity() : token_(std::make_shared<const char>('\0')) {}
  MapIdentity(const MapIdentity&) : MapIdentity() {}
  MapIdentity(MapIdentity&&) noexcept = default;
  MapIdentity& operator=(MapIdentity other) noexcept {
    token_ = std::move(other.token_);
    return *this;
  }
  ~MapIdentity() = default;

  // Returns what no other identity has while somebody holds it; nullptr after a move.
  const std::shared_ptr<const char>& token() const { return token_; }

 private:
  std::shared_ptr<const char> token_;
};

}  // namespace plumbline
