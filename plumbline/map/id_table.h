// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/copy_on_write.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace plumbline {

// Entries keyed by ids that are assigned consecutively. Read like a std::map, in the order of the
// ids, but finds an id without a search: a table of pages of kPage ids each, allocated while one of
// its ids exists. Memory beside the entries: at most a page for each entry, and a pointer for every
// kPage ids up to the largest ever used.
//
// Copies share pages and entries until one of them changes them (CopyOnWrite). A copy costs a
// pointer for each page, and may be read in another thread while the original changes. The address
// of an entry is stable until it is changed after a copy was made.
//
// Each page records when it last changed, so that readers of a large table visit only pages changed
// since their last visit. An entry counts as changed when it is added, removed, or returned by a
// non-const function.
//
// If a function throws (std::bad_alloc), no entry has changed. An Undo makes several changes happen
// together or not at all.
template <class Id, class T>
class IdTable {
 public:
  using Entry = std::pair<const Id, T>;
  static constexpr std::size_t kPage = 64;

  // Iterates over the entries in the order of their ids.
  class Iterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = Entry;
    using difference_type = std::ptrdiff_t;
    using pointer = const Entry*;
    using reference = const Entry&;

    Iterator() = default;
    reference operator*() const { return *table_->pages_[place_ / kPage]->entries[place_ % kPage]; }
    pointer operator->() const { return &**this; }
    Iterator& operator++() {
      place_ = table_->NextPlace(place_ + 1);
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    Iterator& operator--() {
      place_ = table_->PlaceBefore(place_);
      return *this;
    }
    Iterator operator--(int) {
      const Iterator before = *this;
      --*this;
      return before;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.place_ == b.place_; }

   private:
    friend class IdTable;
    Iterator(const IdTable* table, std::size_t place) : table_(table), place_(place) {}

    const IdTable* table_ = nullptr;
    std::size_t place_ = 0;  // id of an entry, or kEnd
  };
  using ReverseIterator = std::reverse_iterator<Iterator>;

 private:
  struct Page;

 public:
  // Restores the table to its state at construction, unless Keep() is called before destruction.
  // Each page and entry that changes meanwhile is copied once, so that earlier pointers to it are
  // invalid. One at a time; meanwhile the table must not be moved, assigned to or swapped.
  class Undo {
   public:
    explicit Undo(IdTable& table)
        : table_(table),
          first_page_(table.first_page_),
          size_(table.size_),
          changes_(table.changes_) {
      table_.undo_ = this;
    }
    ~Undo() {
      table_.undo_ = nullptr;
      if (!keep_) PutBack();
    }
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;

    void Keep() { keep_ = true; }

   private:
    friend class IdTable;

    // Call before a page changes.
    void Remember(std::size_t page) {
      const CopyOnWrite<Page>& now = table_.pages_[page];
      const bool known = now && now->changed > changes_;
      if (!known) pages_.emplace_back(page, now);
    }
    void PutBack() noexcept {
      for (auto page = pages_.rbegin(); page != pages_.rend(); ++page) {
        table_.pages_[page->first] = std::move(page->second);
      }
      table_.first_page_ = first_page_;
      table_.size_ = size_;
    }

    IdTable& table_;
    std::size_t first_page_, size_;
    std::uint64_t changes_;
    std::vector<std::pair<std::size_t, CopyOnWrite<Page>>> pages_;  // in the order of the changes
    bool keep_ = false;
  };

  IdTable() = default;
  // The whole copy counts as changed, later than all changes of the original. O(pages).
  IdTable(const IdTable& other)
      : pages_(other.pages_),
        first_page_(other.first_page_),
        size_(other.size_),
        changes_(other.changes_ + 1),
        copied_at_(changes_) {}
  IdTable(IdTable&& other) noexcept { Swap(other); }
  IdTable& operator=(IdTable other) noexcept {
    Swap(other);
    return *this;
  }
  ~IdTable() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Iterator begin() const { return {this, NextPlace(first_page_ * kPage)}; }
  Iterator end() const { return {this, kEnd}; }
  ReverseIterator rbegin() const { return ReverseIterator(end()); }
  ReverseIterator rend() const { return ReverseIterator(begin()); }
  // Returns the entry of an id, or end().
  Iterator find(Id id) const { return {this, Find(id) == nullptr ? kEnd : PlaceOf(id)}; }
  bool contains(Id id) const { return Find(id) != nullptr; }
  // Throws std::out_of_range if the id has no entry.
  const T& at(Id id) const {
    const T* entry = Find(id);
    if (entry == nullptr) throw std::out_of_range("no entry of this id");
    return *entry;
  }
  // Returns the first entry with an id not less than `id` (lower_bound), or greater (upper_bound).
  Iterator lower_bound(Id id) const { return {this, NextPlace(id.valid() ? PlaceOf(id) : 0)}; }
  Iterator upper_bound(Id id) const { return {this, NextPlace(id.valid() ? PlaceOf(id) + 1 : 0)}; }

  // Returns nullptr if the id is invalid or has no entry. O(1).
  const T* Find(Id id) const {
    if (!id.valid() || PageOf(id) >= pages_.size()) return nullptr;
    const CopyOnWrite<Page>& page = pages_[PageOf(id)];
    if (!page) return nullptr;
    const CopyOnWrite<Entry>& entry = page->entries[PlaceInPage(id)];
    return entry ? &entry->second : nullptr;
  }
  // Returns the entry for changes, or nullptr if the id has none. Changes through the pointer are
  // allowed until the table is copied.
  T* Find(Id id) {
    if (!contains(id)) return nullptr;
    return &ToChange(PageOf(id)).entries[PlaceInPage(id)].Own().second;
  }

  // Calls change(id, entry) for all entries, in the order of their ids.
  template <class Change>
  void ForEach(const Change& change) {
    for (std::size_t n = 0; n < pages_.size(); ++n) {
      if (!pages_[n]) continue;
      Page& page = ToChange(n);
      for (std::uint64_t taken = page.taken; taken != 0; taken &= taken - 1) {
        Entry& entry = page.entries[static_cast<std::size_t>(std::countr_zero(taken))].Own();
        change(entry.first, entry.second);
      }
    }
  }

  // Adds an entry; an existing entry of the id is kept.
  void Insert(Id id, T entry) {
    if (contains(id)) return;
    CopyOnWrite<Entry> added(Entry(id, std::move(entry)));
    if (pages_.size() <= PageOf(id)) pages_.resize(PageOf(id) + 1);
    Page& page = ToChange(PageOf(id));
    page.entries[PlaceInPage(id)] = std::move(added);
    page.taken |= Bit(PlaceInPage(id));
    if (size_ == 0 || PageOf(id) < first_page_) first_page_ = PageOf(id);
    ++size_;
  }

  void Erase(Id id) {
    if (!contains(id)) return;
    if (pages_[PageOf(id)]->taken == Bit(PlaceInPage(id))) {
      if (undo_ != nullptr) undo_->Remember(PageOf(id));
      pages_[PageOf(id)] = {};
      ++changes_;
      --size_;
      SkipEmptyPages();
      return;
    }
    Page& page = ToChange(PageOf(id));
    page.entries[PlaceInPage(id)] = {};
    page.taken &= ~Bit(PlaceInPage(id));
    --size_;
  }

  // Returns true while an Undo of this table exists.
  bool undoing() const { return undo_ != nullptr; }
  // Returns the number of changes so far.
  std::uint64_t changes() const { return changes_; }
  // Returns the number of pages. Page n has the ids n * kPage to n * kPage + kPage - 1; no id of a
  // later page was ever used.
  std::size_t page_count() const { return pages_.size(); }
  // Returns the value of changes() after the last change of a page; 0 if the page is empty.
  std::uint64_t PageChanged(std::size_t page) const {
    return page < pages_.size() && pages_[page] ? std::max(pages_[page]->changed, copied_at_) : 0;
  }
  // Returns the occupied ids of a page: bit i is set for id n * kPage + i of page n.
  std::uint64_t TakenOfPage(std::size_t page) const {
    return page < pages_.size() && pages_[page] ? pages_[page]->taken : 0;
  }
  // Calls take(id, entry) for all entries of a page, in the order of their ids.
  template <class Take>
  void ForEachOfPage(std::size_t page, const Take& take) const {
    if (PageChanged(page) == 0) return;
    for (std::uint64_t taken = pages_[page]->taken; taken != 0; taken &= taken - 1) {
      const Entry& entry =
          *pages_[page]->entries[static_cast<std::size_t>(std::countr_zero(taken))];
      take(entry.first, entry.second);
    }
  }

 private:
  struct Page {
    std::array<CopyOnWrite<Entry>, kPage> entries;
    std::uint64_t taken = 0;  // one bit for each existing entry
    // Value of changes_ after its last change, in the table that changed it.
    std::uint64_t changed = 0;
  };

  static constexpr std::size_t kEnd = std::numeric_limits<std::size_t>::max();

  static std::size_t PlaceOf(Id id) { return static_cast<std::size_t>(id.value); }
  static std::size_t PageOf(Id id) { return PlaceOf(id) / kPage; }
  static std::size_t PlaceInPage(Id id) { return PlaceOf(id) % kPage; }
  static std::uint64_t Bit(std::size_t place_in_page) { return std::uint64_t{1} << place_in_page; }

  // Returns a page that is not shared, allocated if necessary.
  Page& ToChange(std::size_t page) {
    if (undo_ != nullptr) undo_->Remember(page);
    CopyOnWrite<Page>& shared = pages_[page];
    if (!shared) shared = CopyOnWrite(Page());
    Page& own = shared.Own();
    own.changed = ++changes_;
    return own;
  }

  // Returns the place of the first entry at or after `place`, or kEnd.
  std::size_t NextPlace(std::size_t place) const {
    std::uint64_t mask = ~std::uint64_t{0} << (place % kPage);
    for (std::size_t page = place / kPage; page < pages_.size(); ++page) {
      const std::uint64_t taken = pages_[page] ? pages_[page]->taken & mask : 0;
      if (taken != 0) return page * kPage + static_cast<std::size_t>(std::countr_zero(taken));
      mask = ~std::uint64_t{0};
    }
    return kEnd;
  }
  // Returns the place of the last entry before `place`, which must exist.
  std::size_t PlaceBefore(std::size_t place) const {
    std::size_t page = std::min(place / kPage, pages_.size());
    std::uint64_t mask = page < pages_.size() ? Bit(place % kPage) - 1 : 0;
    while (true) {
      const std::uint64_t taken =
          page < pages_.size() && pages_[page] ? pages_[page]->taken & mask : 0;
      if (taken != 0)
        return page * kPage + kPage - 1 - static_cast<std::size_t>(std::countl_zero(taken));
      mask = ~std::uint64_t{0};
      --page;
    }
  }

  // Advances first_page_ to the first allocated page. If the oldest entries are erased first, all
  // calls together visit each page once.
  void SkipEmptyPages() {
    while (first_page_ < pages_.size() && !pages_[first_page_]) ++first_page_;
  }

  void Swap(IdTable& other) noexcept {
    pages_.swap(other.pages_);
    std::swap(first_page_, other.first_page_);
    std::swap(size_, other.size_);
    std::swap(changes_, other.changes_);
    std::swap(copied_at_, other.copied_at_);
  }

  std::vector<CopyOnWrite<Page>> pages_;  // null for pages without an entry
  std::size_t first_page_ = 0;            // no page before it is allocated
  std::size_t size_ = 0;
  std::uint64_t changes_ = 0;
  std::uint64_t copied_at_ = 0;  // changes_ when this became a copy
  Undo* undo_ = nullptr;         // not copied
};

}  // namespace plumbline
