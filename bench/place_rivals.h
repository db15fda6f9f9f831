// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/place/place_index.h"

#include <functional>
#include <string>
#include <vector>

namespace plumbline {

// A way to find keyframes that look like an image.
struct PlaceMethod {
  std::string name;
  std::function<void(KeyFrameId, const Features&)> add;
  std::function<std::vector<PlaceCandidate>(const Features&)> query;  // all, best first
};

// PlaceIndex itself; what it takes of the features can be restricted.
PlaceMethod OurIndex(bool points, bool lines);

// Every feature against every one of every keyframe: how many have one partner that is clearly
// nearer than all others (at most 50 of 256 bits, 0.85 of the second best).
PlaceMethod BruteForce();

// Locality-sensitive hashing (Indyk and Motwani 1998): `tables` tables, each by `bits` bits drawn
// at random; the words are weighted by tf-idf. Descriptors are not compared.
PlaceMethod HashedWords(int tables, int bits);

// A tree that is split by the bit nearest to one half of its leaf's descriptors, which are kept in
// full; a vote for each keyframe with a descriptor within 25 bits (after Schlegel and Grisetti,
// HBST, RA-L 2018).
PlaceMethod BinarySearchTree();

}  // namespace plumbline
