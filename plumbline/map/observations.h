// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

namespace plumbline {

// Observations of a landmark: the index of its feature in each keyframe. Used like a std::map, but
// contiguous in memory, since mapping iterates over the observations of thousands of landmarks for
// every keyframe. Keyframes are added mostly at the end.
class Observations {
 public:
  using value_type = std::pair<KeyFrameId, int>;
  using const_iterator = std::vector<value_type>::const_iterator;

  Observations() = default;
  Observations(std::initializer_list<value_type> entries) {
    for (const auto& [keyframe, feature] : entries) emplace(keyframe, feature);
  }

  const_iterator begin() const { return entries_.begin(); }
  const_iterator end() const { return entries_.end(); }
  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }
  const value_type& newest() const { return entries_.back(); }

  const_iterator find(KeyFrameId keyframe) const {
    const auto place = LowerBound(keyframe);
    return place != end() && place->first == keyframe ? place : end();
  }
  bool contains(KeyFrameId keyframe) const { return find(keyframe) != end(); }
  int at(KeyFrameId keyframe) const {
    const auto place = find(keyframe);
    if (place == end()) throw std::out_of_range("no observation by this keyframe");
    return place->second;
  }

  // Adds an observation; an existing one of the keyframe is kept.
  void emplace(KeyFrameId keyframe, int feature) {
    const auto place = LowerBound(keyframe);
    if (place == end() || place->first != keyframe) entries_.insert(place, {keyframe, feature});
  }
  void erase(const_iterator place) { entries_.erase(place); }
  void erase(KeyFrameId keyframe) {
    const auto place = find(keyframe);
    if (place != end()) erase(place);
  }

  friend bool operator==(const Observations&, const Observations&) = default;

 private:
  const_iterator LowerBound(KeyFrameId keyframe) const {
    return std::lower_bound(begin(), end(), keyframe, [](const value_type& entry, KeyFrameId id) {
      return entry.first < id;
    });
  }

  std::vector<value_type> entries_;  // ordered by keyframe
};

}  // namespace plumbline
