// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/types.h"
#include "plumbline/loop_closing/signature_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace plumbline {

// A keyframe that may show the place of an image.
struct PlaceCandidate {
  KeyFrameId id;
  // Share of the image's features that the keyframe shows, too, 0 to 1, weighted by rarity.
  // Comparable between images and between indices.
  double score = 0;
};

// An index of keyframes by the descriptors of their features, for place recognition. It needs no
// vocabulary and loads nothing.
//
// The index stores the strongest points and lines of each keyframe, by half of the bits of their
// descriptors (Signature). They are sorted into kTrees trees for each kind, which test different
// bits (SignatureTree): neighbours separated by one bit in one tree meet in another. A feature of
// the image votes for the keyframes that have a feature in the same leaf, in any tree, with at most
// kPointReach or kLineReach differing bits. Each keyframe gets one vote per feature, which grows
// with the similarity of its nearest feature, and with the rarity of keyframes that have one
// (inverse document frequency, Sparck Jones 1972: log(1 + N / (1 + n))). The score of a keyframe is
// the sum of its votes, divided by that of a keyframe that shows every feature.
// docs/methods/places.md has the measurements behind this choice.
//
// The result is a function of the keyframes in the index and of the image: an index rebuilt from
// the same keyframes, in any order, gives the same result, digit by digit.
//
// Many threads may query it, or one may change it. A keyframe takes less than 20 kB. With 1,000
// keyframes adding one takes 0.3 ms and a query 1.4 ms, with 100,000 2.4 and 2.9 ms.
class PlaceIndex {
 public:
  // Largest number of points and lines used of a keyframe, and of an image.
  static constexpr std::size_t kPoints = 400;
  static constexpr std::size_t kLines = 100;
  static constexpr std::size_t kTrees = 3;
  // Largest Hamming distance of a vote, of 128 bits.
  static constexpr int kPointReach = 24;
  static constexpr int kLineReach = 24;

  // Adds a keyframe. Throws BugError if it is already in the index, and for an invalid id.
  void Add(KeyFrameId id, const Features& features);
  // Removes a keyframe; does nothing if it is not in the index.
  void Remove(KeyFrameId id);
  bool Contains(KeyFrameId id) const { return slots_.contains(id); }
  std::size_t size() const { return slots_.size(); }
  // Returns the occupied ids of a page: bit i is set for id n * kPage + i of page n. Pages from
  // page_count() on are empty.
  static constexpr std::size_t kPage = 64;
  std::uint64_t TakenOfPage(std::size_t page) const {
    return page < taken_.size() ? taken_[page] : 0;
  }
  std::size_t page_count() const { return taken_.size(); }
  // Returns the ids of all keyframes, ascending.
  std::vector<KeyFrameId> Ids() const;

  // Returns the `most` best of the allowed keyframes, the best first (ties: the older one);
  // keyframes without a vote are dropped. Keyframes that are not allowed do not count for rarity
  // either: the camera's surroundings would make everything in its view look common. `allowed` is
  // called at most once for each keyframe.
  std::vector<PlaceCandidate> Query(const Features& features,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  // Queries with the stored features of a keyframe. Throws BugError if it is not in the index.
  std::vector<PlaceCandidate> Query(KeyFrameId id,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  // Returns the memory of the index in bytes.
  std::size_t Memory() const;

 private:
  using KindsOfSignatures = std::array<std::span<const Signature>, 2>;
  // The index of the points, or of the lines.
  struct Kind {
    explicit Kind(std::size_t features);
    SignatureTable signatures;
    std::array<SignatureTree, kTrees> trees;
  };

  std::vector<PlaceCandidate> Query(const KindsOfSignatures& signatures,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  void Mark(KeyFrameId id, bool taken);

  std::map<KeyFrameId, std::uint32_t> slots_;
  std::vector<std::uint64_t> taken_;       // TakenOfPage, by page
  std::vector<KeyFrameId> by_slot_;        // keyframe of each slot; invalid: free
  std::vector<std::uint32_t> free_slots_;  // slots of removed keyframes
  std::array<Kind, 2> kinds_ = {Kind(kPoints), Kind(kLines)};
};

}  // namespace plumbline
