// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/map.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace plumbline {

// The pairs of keyframes of a map that share many landmarks, kept up to date as the map changes.
//
// How many landmarks a pair shares depends on the matches of these two keyframes alone, since a
// landmark is observed by exactly the keyframes that match it (Map::CheckInvariants). A change of
// one of them changes its page of the table of keyframes, but not the page of the other one. Pairs
// are therefore counted anew where either of the two is in a page that has changed.
class StrongCovisibility {
 public:
  // strong: fewest points and lines that both keyframes of a pair show.
  explicit StrongCovisibility(int strong) : strong_(strong) {}

  // Brings the pairs up to date with a map. They are the same, whatever was followed before: what
  // was counted is used only where the map has the token of the last call.
  //
  //   cost  nothing where no keyframe has changed; otherwise the observations of the landmarks that
  //         the keyframes of changed pages show, and a look at each pair and each page
  void Follow(const Map& map);

  // Forgets what was counted, so that Follow() begins anew.
  void Forget();

  // Returns the earlier keyframes that share many landmarks with a keyframe of the map, ascending.
  const std::vector<KeyFrameId>& EarlierOf(KeyFrameId id) const;

 private:
  void Drop(const std::vector<bool>& changed);
  void Take(KeyFrameId earlier, KeyFrameId later);

  int strong_;
  std::shared_ptr<const char> token_;                // Map::token() of the map that is followed
  std::uint64_t changes_ = 0;                        // IdTable::changes() of its keyframes
  std::vector<std::vector<KeyFrameId>> earlier_of_;  // by id
};

}  // namespace plumbline
