// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace plumbline {

// Distinguishes a map from its copies, which have the same id but may diverge. A copy gets an
// identity of its own; a moved map keeps its identity.
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

  // Returns a pointer that is unique while anyone holds it; nullptr after a move.
  const std::shared_ptr<const char>& token() const { return token_; }

 private:
  std::shared_ptr<const char> token_;
};

}  // namespace plumbline
