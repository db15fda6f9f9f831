// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/strong_covisibility.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
namespace {

constexpr std::size_t kIdsOfPage = IdTable<KeyFrameId, KeyFrame>::kPage;

std::size_t PlaceOf(KeyFrameId id) { return static_cast<std::size_t>(id.value); }
std::size_t PageOf(KeyFrameId id) { return PlaceOf(id) / kIdsOfPage; }

// Counts the landmarks that keyframes share, one keyframe after the other.
class PairCounter {
 public:
  PairCounter(const Map& map, std::size_t ids) : map_(map), shared_(ids, 0) {}

  // Returns the other keyframes before `end` that share at least `strong` landmarks with a
  // keyframe, ascending.
  std::vector<KeyFrameId> StrongBefore(KeyFrameId end, const KeyFrame& keyframe, int strong) {
    Count(end, keyframe.frame.points);
    Count(end, keyframe.frame.lines);
    std::vector<KeyFrameId> found;
    for (const KeyFrameId other : touched_) {
      if (shared_[PlaceOf(other)] >= strong && other != keyframe.id) found.push_back(other);
      shared_[PlaceOf(other)] = 0;
    }
    touched_.clear();
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  template <class LandmarkId>
  void Count(KeyFrameId end, const std::vector<LandmarkId>& matches) {
    for (const LandmarkId match : matches) {
      if (!match.valid()) continue;
      for (const auto& [other, feature] : map_.Find(match)->observations) {
        if (!(other < end)) break;
        if (shared_[PlaceOf(other)]++ == 0) touched_.push_back(other);
      }
    }
  }

  const Map& map_;
  std::vector<int> shared_;          // landmarks shared with the present keyframe, by id
  std::vector<KeyFrameId> touched_;  // keyframes whose entry in shared_ is not zero
};

// Returns which pages have changed since the table had made so many changes. A page without
// keyframes counts as changed.
std::vector<bool> ChangedPages(const IdTable<KeyFrameId, KeyFrame>& keyframes,
                               std::uint64_t changes) {
  std::vector<bool> changed(keyframes.page_count());
  for (std::size_t page = 0; page < changed.size(); ++page) {
    const std::uint64_t last = keyframes.PageChanged(page);
    changed[page] = last == 0 || last > changes;
  }
  return changed;
}

// Returns the first id after all pages that have not changed.
KeyFrameId EndOfUnchanged(const std::vector<bool>& changed) {
  std::size_t page = changed.size();
  while (page > 0 && changed[page - 1]) --page;
  return KeyFrameId{static_cast<std::int64_t>(page * kIdsOfPage)};
}

}  // namespace

void StrongCovisibility::Follow(const Map& map) {
  if (map.token() == nullptr || map.token() != token_) Forget();
  const auto& keyframes = map.keyframes();
  if (token_ != nullptr && keyframes.changes() == changes_) return;
  const std::vector<bool> changed = ChangedPages(keyframes, changes_);
  const KeyFrameId end_of_unchanged = EndOfUnchanged(changed);
  earlier_of_.resize(changed.size() * kIdsOfPage);
  Drop(changed);
  PairCounter counter(map, earlier_of_.size());
  for (std::size_t page = 0; page < changed.size(); ++page) {
    if (!changed[page]) continue;
    keyframes.ForEachOfPage(page, [&](KeyFrameId id, const KeyFrame& keyframe) {
      const KeyFrameId end = std::max(id, end_of_unchanged);
      for (const KeyFrameId other : counter.StrongBefore(end, keyframe, strong_)) {
        // A later keyframe of a page that has changed counts this one when it is its turn.
        if (other < id) Take(other, id);
        if (id < other && !changed[PageOf(other)]) Take(id, other);
      }
    });
  }
  token_ = map.token();
  changes_ = keyframes.changes();
}

void StrongCovisibility::Forget() {
  token_ = nullptr;
  changes_ = 0;
  earlier_of_.clear();
}

const std::vector<KeyFrameId>& StrongCovisibility::EarlierOf(KeyFrameId id) const {
  return earlier_of_.at(PlaceOf(id));
}

// Drops the pairs of which a keyframe is in a page that has changed.
void StrongCovisibility::Drop(const std::vector<bool>& changed) {
  const auto is_dropped = [&](KeyFrameId id) { return changed[PageOf(id)]; };
  const auto first = std::find(changed.begin(), changed.end(), true);
  // No pair of an earlier page has a keyframe of this one or a later one.
  auto place = static_cast<std::size_t>(first - changed.begin()) * kIdsOfPage;
  for (; place < earlier_of_.size(); ++place) {
    std::vector<KeyFrameId>& earlier = earlier_of_[place];
    if (changed[place / kIdsOfPage]) {
      earlier.clear();
    } else {
      std::erase_if(earlier, is_dropped);
    }
  }
}

void StrongCovisibility::Take(KeyFrameId earlier, KeyFrameId later) {
  std::vector<KeyFrameId>& list = earlier_of_[PlaceOf(later)];
  list.insert(std::upper_bound(list.begin(), list.end(), earlier), earlier);
}

}  // namespace plumbline
