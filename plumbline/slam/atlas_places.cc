// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_places.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace plumbline {
namespace {

using KeyFrames = IdTable<KeyFrameId, KeyFrame>;
static_assert(KeyFrames::kPage == PlaceIndex::kPage);

// Calls take(id) for each id of a page whose bit is set, ascending.
template <class Take>
void ForEachId(std::size_t page, std::uint64_t bits, const Take& take) {
  for (; bits != 0; bits &= bits - 1) {
    const std::size_t place = page * KeyFrames::kPage;
    take(KeyFrameId{static_cast<std::int64_t>(place) + std::countr_zero(bits)});
  }
}

// Brings the ids of one page up to date.
void FollowPage(const Atlas& atlas, std::size_t page, PlaceIndex* index) {
  std::uint64_t there = 0;
  for (const auto& [map_id, map] : atlas.maps()) there |= map.keyframes().TakenOfPage(page);
  const std::uint64_t known = index->TakenOfPage(page);
  if (there == known) return;
  ForEachId(page, known & ~there, [&](KeyFrameId id) { index->Remove(id); });
  for (const auto& entry : atlas.maps()) {
    const Map& map = entry.second;
    const std::uint64_t fresh = map.keyframes().TakenOfPage(page) & ~index->TakenOfPage(page);
    ForEachId(page, fresh, [&](KeyFrameId id) { index->Add(id, map.Find(id)->frame.features()); });
  }
}

}  // namespace

const Map* MapOf(const Atlas& atlas, KeyFrameId id) {
  for (const auto& [map_id, map] : atlas.maps()) {
    if (map.Find(id) != nullptr) return &map;
  }
  return nullptr;
}

void Follow(const Atlas& atlas, PlaceIndex* index) {
  std::size_t pages = index->page_count();
  for (const auto& [id, map] : atlas.maps()) pages = std::max(pages, map.keyframes().page_count());
  for (std::size_t page = 0; page < pages; ++page) FollowPage(atlas, page, index);
}

std::vector<KeyFrameId> MostAlike(const PlaceIndex& index,
                                  const Map& map,
                                  const Features& features,
                                  std::size_t most) {
  const auto in_map = [&](KeyFrameId id) { return map.Find(id) != nullptr; };
  std::vector<KeyFrameId> ids;
  for (const PlaceCandidate& candidate : index.Query(features, most, in_map)) {
    ids.push_back(candidate.id);
  }
  return ids;
}

}  // namespace plumbline
