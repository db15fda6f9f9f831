// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/place_index.h"

#include <functional>
#include <string>
#include <vector>

namespace plumbline {

// A method of finding the keyframes most similar to an image.
struct PlaceMethod {
  std::string name;
  std::function<void(KeyFrameId, const Features&)> add;
  std::function<std::vector<PlaceCandidate>(const Features&)> query;  // all, best first
};

// PlaceIndex itself, optionally restricted to points or lines.
PlaceMethod OurIndex(bool points, bool lines);

// Compares every feature with every one of every keyframe, and counts those with one partner
// clearly nearer than all others (at most 50 of 256 bits, 0.85 of the second best).
PlaceMethod BruteForce();

// Locality-sensitive hashing (Indyk and Motwani 1998): `tables` tables, each by `bits` bits drawn
// at random; the words are weighted by tf-idf. Descriptors are not compared.
PlaceMethod HashedWords(int tables, int bits);

// A tree split by the bit nearest to one half of its leaf's descriptors, which are stored in full;
// a vote for each keyframe with a descriptor within 25 bits (after Schlegel and Grisetti, HBST,
// RA-L 2018).
PlaceMethod BinarySearchTree();

}  // namespace plumbline
