// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {

// Shape of a long drive that revisits places. Ten parts in all shapes with revisits.
enum class DriveShape {
  kStraight,  // no revisits
  kChain,     // each part is a circuit, its last sixth driven twice; the next begins there
  kHub,       // each part begins with the same street
  kRounds,    // all parts are rounds through the same streets
};

constexpr int kDriveParts = 10;

// Returns the place of each keyframe of a drive. Neighbouring places are a metre apart; a place of
// several keyframes was driven through as often, in the same direction.
inline std::vector<int> DrivePlaces(DriveShape shape, int keyframes) {
  const int part = std::max(1, keyframes / kDriveParts);
  const int circuit = part - part / 6;
  const int street = std::max(1, part / 10);
  std::vector<int> places;
  for (int k = 0; k < keyframes; ++k) {
    const int round = k / part, step = k % part;
    int place = k;
    if (shape == DriveShape::kChain) place = round * circuit + step % circuit;
    if (shape == DriveShape::kHub && step < street) place = step;
    if (shape == DriveShape::kRounds) place = step;
    places.push_back(place);
  }
  return places;
}

// Returns the keyframes at each place, ascending.
inline std::vector<std::vector<int>> DriveVisits(const std::vector<int>& places) {
  const int most = places.empty() ? 0 : *std::max_element(places.begin(), places.end()) + 1;
  std::vector<std::vector<int>> visits(static_cast<std::size_t>(most));
  for (std::size_t k = 0; k < places.size(); ++k) {
    visits[static_cast<std::size_t>(places[k])].push_back(static_cast<int>(k));
  }
  return visits;
}

}  // namespace plumbline
