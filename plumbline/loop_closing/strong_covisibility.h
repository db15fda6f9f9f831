// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace plumbline {

// Pairs of keyframes of a map that share many landmarks, updated as the map changes.
//
// The number of landmarks that a pair shares depends on the matches of these two keyframes alone,
// since a landmark is observed by exactly the keyframes that match it (Map::CheckInvariants). A
// change of one of them changes its page of the table of keyframes, but not the page of the other
// one. Pairs are therefore counted again if either of the two is in a changed page.
class StrongCovisibility {
 public:
  // strong: least number of points and lines shown by both keyframes of a pair.
  explicit StrongCovisibility(int strong) : strong_(strong) {}

  // Updates the pairs for a map. The result does not depend on earlier calls: earlier counts are
  // used only if the map has the token of the last call.
  //
  //   cost  none if no keyframe has changed; otherwise the observations of the landmarks of the
  //         keyframes of changed pages, and a visit of each pair and each page
  void Follow(const Map& map);

  // Discards all counts, so that Follow() begins anew.
  void Forget();

  // Returns the earlier keyframes that share many landmarks with a keyframe of the map, ascending.
  const std::vector<KeyFrameId>& EarlierOf(KeyFrameId id) const;

 private:
  void Drop(const std::vector<bool>& changed);
  void Take(KeyFrameId earlier, KeyFrameId later);

  int strong_;
  std::shared_ptr<const char> token_;                // Map::token() of the followed map
  std::uint64_t changes_ = 0;                        // IdTable::changes() of its keyframes
  std::vector<std::vector<KeyFrameId>> earlier_of_;  // by id
};

}  // namespace plumbline
