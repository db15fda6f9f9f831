// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/plucker.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Some landmarks of a map, by id. Some may have left the map.
struct LandmarkIds {
  std::vector<PointId> points;
  std::vector<LineId> lines;
};

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
  // Returns the memory in bytes beside the object itself.
  std::size_t Bytes() const { return entries_.capacity() * sizeof(value_type); }

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

// Model of a point for search in images: position and appearance.
struct PointModel {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        // in the world
  Eigen::Vector3d view_direction = Eigen::Vector3d::Zero();  // mean unit vector from the cameras
  // Distance from the camera at which the point appears in octave reference_octave.
  double reference_distance = 0;
  int reference_octave = 0;  // octave at reference_distance
  Descriptor descriptor{};   // the most typical descriptor of its observations
};

// Model of a line for search in images. Optimization works on the infinite line; the interval
// [start, end] of parameters along it (PluckerLine::PointAt) is for search and display only.
struct LineModel {
  PluckerLine line;  // in the world; direction by its brighter side (LineFeature)
  double start = 0;
  double end = 0;
  // Information matrix of the orthonormal tangent, with fixed poses.
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector3d view_direction = Eigen::Vector3d::Zero();
  Descriptor descriptor{};

  Segment3 Interval() const { return {line.PointAt(start), line.PointAt(end)}; }
};

// Number of frames in which the tracker expected a landmark, and in which it found it.
struct TrackingScore {
  int visible = 1;
  int found = 1;

  double Ratio() const { return static_cast<double>(found) / visible; }
};

// Scores accumulated over several frames.
struct TrackingScores {
  std::map<PointId, TrackingScore> points;
  std::map<LineId, TrackingScore> lines;
};

// A landmark of a map.
template <class Model, class Id>
struct MapLandmark : Model {
  Id id;
  KeyFrameId created_by;
  Observations observations;
  TrackingScore score;
};
using MapPoint = MapLandmark<PointModel, PointId>;
using MapLine = MapLandmark<LineModel, LineId>;

}  // namespace plumbline
