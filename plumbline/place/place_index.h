// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/types.h"
#include "plumbline/place/signature_table.h"
#include "plumbline/place/signature_tree.h"

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
  // Which part of what the image shows it shows too, 0 to 1, rare things counting more: comparable
  // between images and between indices.
  double score = 0;
};

// Keyframes by what they show: finds those that show the place of an image, without a vocabulary
// and with nothing to load.
//
// The index keeps the strongest points and lines of each keyframe as half of the bits of their
// descriptors (Signature), and sorted into kTrees trees for each kind, which ask different bits
// (SignatureTree): neighbours that differ in one of the bits that a tree asks meet in another one.
// A feature of the image votes for the keyframes that have one in the leaf it falls into, in any
// tree, with at most kPointReach or kLineReach bits that differ: for each keyframe once, by how
// near the best is, and the more the fewer keyframes there are (inverse document frequency, Sparck
// Jones 1972: log(1 + N / (1 + n))). The score of a keyframe is the sum of its votes, divided by
// that of a keyframe that shows it all. What was chosen by measurement, and against what:
// docs/methods/places.md.
//
// The answer is a function of the keyframes in the index and of the image: an index that is made
// anew from the same keyframes, in any order, answers the same, digit by digit.
//
// One thread may change it, or many ask it. A keyframe takes less than 20 kB; with
// 1,000 keyframes 0.3 ms to add one and 1.4 ms a query, with 100,000 2.4 and 2.9 ms.
class PlaceIndex {
 public:
  static constexpr std::size_t kPoints = 400;  // of a keyframe, and of an image
  static constexpr std::size_t kLines = 100;
  static constexpr std::size_t kTrees = 3;
  static constexpr int kPointReach = 24;  // of the 128 bits; so many or fewer differ
  static constexpr int kLineReach = 24;

  // BugError where the keyframe is there already.
  void Add(KeyFrameId id, const Features& features);
  // Does nothing where the keyframe is not there.
  void Remove(KeyFrameId id);
  bool Contains(KeyFrameId id) const { return slots_.contains(id); }
  std::size_t size() const { return slots_.size(); }
  // Ascending.
  std::vector<KeyFrameId> Ids() const;
  // The greatest id; invalid where there is none.
  KeyFrameId Newest() const { return slots_.empty() ? KeyFrameId{} : slots_.rbegin()->first; }

  // The `most` best of those that are allowed, best first, the older of two that are equal; none
  // that nothing speaks for. What is not allowed does not count as alike either: the surroundings
  // of the camera would make everything it sees look common. `allowed` is called at most once for
  // each keyframe.
  std::vector<PlaceCandidate> Query(const Features& features,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  // Asks for what a keyframe of the index shows, as it is kept there. BugError where it is not.
  std::vector<PlaceCandidate> Query(KeyFrameId id,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  // Bytes.
  std::size_t Memory() const;

 private:
  using KindsOfSignatures = std::array<std::span<const Signature>, 2>;
  // Points, or lines.
  struct Kind {
    explicit Kind(std::size_t features);
    SignatureTable signatures;
    std::array<SignatureTree, kTrees> trees;
  };

  std::vector<PlaceCandidate> Query(const KindsOfSignatures& signatures,
                                    std::size_t most,
                                    const std::function<bool(KeyFrameId)>& allowed) const;

  std::map<KeyFrameId, std::uint32_t> slots_;
  std::vector<KeyFrameId> by_slot_;        // invalid: free
  std::vector<std::uint32_t> free_slots_;  // to be used again
  std::array<Kind, 2> kinds_ = {Kind(kPoints), Kind(kLines)};
};

}  // namespace plumbline
