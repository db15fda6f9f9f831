// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/heap_bytes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace plumbline {

// A list whose entries may have no value, in less memory than a vector of std::optional: the values
// side by side and four bytes for each entry; nothing while no entry has a value.
template <class T>
class OptionalList {
 public:
  // An entry, to be read like a const std::optional. Valid until the list changes.
  class Entry {
   public:
    explicit Entry(const T* value) : value_(value) {}
    explicit operator bool() const { return value_ != nullptr; }
    bool has_value() const { return value_ != nullptr; }
    // Both return the value, which must exist.
    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_; }
    operator std::optional<T>() const {  // NOLINT(google-explicit-constructor)
      return value_ != nullptr ? std::optional<T>(*value_) : std::nullopt;
    }

   private:
    const T* value_;
  };

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Entry;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Entry;

    Iterator(const OptionalList* list, std::size_t place) : list_(list), place_(place) {}
    Entry operator*() const { return (*list_)[place_]; }
    Iterator& operator++() {
      ++place_;
      return *this;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.place_ == b.place_; }

   private:
    const OptionalList* list_;
    std::size_t place_;
  };

  OptionalList() = default;
  OptionalList(std::initializer_list<std::optional<T>> entries) {
    for (const auto& entry : entries) push_back(entry);
  }
  // NOLINTNEXTLINE(google-explicit-constructor): the same in another form
  OptionalList(const std::vector<std::optional<T>>& entries) {
    values_.reserve(static_cast<std::size_t>(std::count_if(
        entries.begin(), entries.end(), [](const auto& entry) { return entry.has_value(); })));
    if (values_.capacity() > 0) places_.reserve(entries.size());
    for (const auto& entry : entries) push_back(entry);
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Entry operator[](std::size_t i) const { return Entry(Find(i)); }
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size_}; }

  // Returns the value of an entry; nullptr if it has none.
  const T* Find(std::size_t i) const {
    return places_.empty() || places_[i] < 0 ? nullptr
                                             : &values_[static_cast<std::size_t>(places_[i])];
  }
  T* Find(std::size_t i) { return const_cast<T*>(std::as_const(*this).Find(i)); }
  // Returns the values of the entries that have one, in the order in which they got it.
  std::span<T> values() { return values_; }
  std::span<const T> values() const { return values_; }

  // Sets or removes the value of an entry. Removing one takes time in proportion to the list.
  void Set(std::size_t i, const std::optional<T>& value) {
    T* const known = Find(i);
    if (value && known != nullptr) {
      *known = *value;
    } else if (value) {
      places_.resize(size_, kNone);
      places_[i] = static_cast<std::int32_t>(values_.size());
      values_.push_back(*value);
    } else if (known != nullptr) {
      const std::int32_t gone = places_[i];
      values_.erase(values_.begin() + gone);
      places_[i] = kNone;
      for (std::int32_t& place : places_) place -= place > gone ? 1 : 0;
    }
  }
  void push_back(const std::optional<T>& value) {
    resize(size_ + 1);
    Set(size_ - 1, value);
  }
  void clear() { *this = {}; }
  // Appends entries without a value, or drops the last ones.
  void resize(std::size_t size) {
    for (std::size_t i = size; i < size_; ++i) Set(i, std::nullopt);
    size_ = size;
    if (!places_.empty()) places_.resize(size, kNone);
  }

  // Returns the memory in bytes beside the object itself.
  std::size_t Bytes() const { return HeapBytes(places_) + HeapBytes(values_); }

 private:
  static constexpr std::int32_t kNone = -1;

  std::size_t size_ = 0;
  std::vector<std::int32_t> places_;  // of each entry in values_; empty while there are no values
  std::vector<T> values_;
};

}  // namespace plumbline
