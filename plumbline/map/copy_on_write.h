// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <utility>

namespace plumbline {

// An optional value that copies share until one of them changes it; that copy then gets a value of
// its own. A copy costs as much as a pointer.
//
// Different copies may be used in different threads at once, since a shared value is only read. A
// single copy is not thread-safe, like a plain value.
template <class T>
class CopyOnWrite {
 public:
  CopyOnWrite() = default;
  explicit CopyOnWrite(T value) : shared_(new Shared{std::move(value)}) {}
  CopyOnWrite(const CopyOnWrite& other) noexcept : shared_(other.shared_) {
    if (shared_ != nullptr) shared_->owners.fetch_add(1, std::memory_order_relaxed);
  }
  CopyOnWrite(CopyOnWrite&& other) noexcept : shared_(std::exchange(other.shared_, nullptr)) {}
  CopyOnWrite& operator=(CopyOnWrite other) noexcept {
    std::swap(shared_, other.shared_);
    return *this;
  }
  ~CopyOnWrite() {
    if (shared_ == nullptr) return;
    if (shared_->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete shared_;
  }

  explicit operator bool() const { return shared_ != nullptr; }
  // Both return the value, which must exist.
  const T& operator*() const { return shared_->value; }
  const T* operator->() const { return &shared_->value; }

  // Returns the value for changes, until the next copy is made. A shared value is copied first.
  T& Own() {
    // The acquire orders the reads of former owners before the writes to come.
    if (shared_->owners.load(std::memory_order_acquire) != 1) *this = CopyOnWrite(shared_->value);
    return shared_->value;
  }

 private:
  struct Shared {
    T value;
    std::atomic<int> owners = 1;
  };

  Shared* shared_ = nullptr;
};

}  // namespace plumbline
