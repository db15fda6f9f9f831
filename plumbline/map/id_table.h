// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace plumbline {

// Entries by ids that are given one after the other: a std::map, for its order and because entries
// stay where they are, and an index of it that finds an id without a search. The index is a table
// of pages of kPage ids each; a page is there while one of its ids is. Memory beside the entries:
// at most a page for each entry, and a pointer for kPage ids up to the largest there ever was.
//
// Each page knows when it last changed, so that whoever follows a large table looks at the pages
// that changed since the last look. A change is an entry that was added, removed, or handed out by
// a function that is not const, whatever became of it.
template <class Id, class T>
class IdTable {
 public:
  IdTable() = default;
  // The whole copy counts as changed after all changes of the other one.
  IdTable(const IdTable& other) : entries_(other.entries_), changes_(other.changes_) { IndexAll(); }
  IdTable(IdTable&&) noexcept = default;
  IdTable& operator=(IdTable other) noexcept {
    entries_.swap(other.entries_);
    pages_.swap(other.pages_);
    changes_ = other.changes_;
    return *this;
  }
  ~IdTable() = default;

  const std::map<Id, T>& entries() const { return entries_; }
  std::map<Id, T>& entries() {
    for (const auto& page : pages_) {
      if (page != nullptr) page->changed = changes_ + 1;
    }
    ++changes_;
    return entries_;
  }

  // nullptr where there is none, also of an id that is not valid. O(1).
  const T* Find(Id id) const { return Indexed(id); }
  T* Find(Id id) {
    T* entry = Indexed(id);
    if (entry != nullptr) pages_[PageOf(id)]->changed = ++changes_;
    return entry;
  }

  // An id that is there already keeps its entry.
  void Insert(Id id, T entry) {
    const auto [place, is_new] = entries_.emplace(id, std::move(entry));
    if (is_new) IndexOne(id, place->second);
  }

  void Erase(Id id) {
    if (Indexed(id) == nullptr) return;
    std::unique_ptr<Page>& page = pages_[PageOf(id)];
    page->entries[PlaceInPage(id)] = nullptr;
    page->changed = ++changes_;
    if (--page->count == 0) page.reset();
    entries_.erase(id);
  }

  // How many changes there were.
  std::uint64_t changes() const { return changes_; }
  // Page n has the ids n * kPage to n * kPage + kPage - 1; those from this number on never were.
  std::size_t page_count() const { return pages_.size(); }
  // The value of changes() after the last change of a page; 0 where none of its ids is there.
  std::uint64_t PageChanged(std::size_t page) const {
    return page < pages_.size() && pages_[page] != nullptr ? pages_[page]->changed : 0;
  }
  // Calls take(id, entry) for all of a page, by id.
  template <class Take>
  void ForEachOfPage(std::size_t page, const Take& take) const {
    if (PageChanged(page) == 0) return;
    for (std::size_t i = 0; i < kPage; ++i) {
      const T* entry = pages_[page]->entries[i];
      if (entry != nullptr) take(Id{static_cast<std::int64_t>(page * kPage + i)}, *entry);
    }
  }

  // Pages that are there, for those who want to know what the index takes.
  std::size_t pages() const {
    std::size_t count = 0;
    for (const auto& page : pages_) count += page != nullptr;
    return count;
  }

  static constexpr std::size_t kPage = 64;

 private:
  struct Page {
    std::array<T*, kPage> entries{};  // into entries_
    std::size_t count = 0;            // ids of the page that are not null
    std::uint64_t changed = 0;        // changes_ after its last change
  };

  static std::size_t PageOf(Id id) { return static_cast<std::size_t>(id.value) / kPage; }
  static std::size_t PlaceInPage(Id id) { return static_cast<std::size_t>(id.value) % kPage; }

  T* Indexed(Id id) const {
    if (!id.valid() || PageOf(id) >= pages_.size()) return nullptr;
    const std::unique_ptr<Page>& page = pages_[PageOf(id)];
    return page == nullptr ? nullptr : page->entries[PlaceInPage(id)];
  }

  void IndexOne(Id id, T& entry) {
    if (pages_.size() <= PageOf(id)) pages_.resize(PageOf(id) + 1);
    std::unique_ptr<Page>& page = pages_[PageOf(id)];
    if (page == nullptr) page = std::make_unique<Page>();
    page->entries[PlaceInPage(id)] = &entry;
    ++page->count;
    page->changed = ++changes_;
  }

  void IndexAll() {
    for (auto& [id, entry] : entries_) IndexOne(id, entry);
  }

  std::map<Id, T> entries_;
  std::vector<std::unique_ptr<Page>> pages_;  // by id; null where none of the ids is there
  std::uint64_t changes_ = 0;
};

}  // namespace plumbline
