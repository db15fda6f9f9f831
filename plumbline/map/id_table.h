// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace plumbline {

// Entries by ids that are given one after the other: a std::map, for its order and because entries
// stay where they are, and an index of it that finds an id without a search. Memory: a pointer for
// every id up to the largest there ever was.
template <class Id, class T>
class IdTable {
 public:
  IdTable() = default;
  IdTable(const IdTable& other) : entries_(other.entries_) { IndexAll(); }
  IdTable(IdTable&&) noexcept = default;
  IdTable& operator=(IdTable other) noexcept {
    entries_.swap(other.entries_);
    index_.swap(other.index_);
    return *this;
  }
  ~IdTable() = default;

  const std::map<Id, T>& entries() const { return entries_; }
  std::map<Id, T>& entries() { return entries_; }

  // nullptr where there is none, also of an id that is not valid. O(1).
  const T* Find(Id id) const { return Contains(id) ? index_[Place(id)] : nullptr; }
  T* Find(Id id) { return Contains(id) ? index_[Place(id)] : nullptr; }

  // An id that is there already keeps its entry.
  void Insert(Id id, T entry) {
    IndexOne(id, entries_.emplace(id, std::move(entry)).first->second);
  }

  void Erase(Id id) {
    if (!Contains(id)) return;
    index_[Place(id)] = nullptr;
    entries_.erase(id);
  }

 private:
  static std::size_t Place(Id id) { return static_cast<std::size_t>(id.value); }

  bool Contains(Id id) const { return id.valid() && Place(id) < index_.size(); }

  void IndexOne(Id id, T& entry) {
    if (index_.size() <= Place(id)) index_.resize(Place(id) + 1, nullptr);
    index_[Place(id)] = &entry;
  }

  void IndexAll() {
    for (auto& [id, entry] : entries_) IndexOne(id, entry);
  }

  std::map<Id, T> entries_;
  std::vector<T*> index_;  // into entries_, by id
};

}  // namespace plumbline
