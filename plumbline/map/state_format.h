// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/byte_format.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/map/state_stream.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Transfer (base/byte_format.h) of frames and snapshots as part of the state of a run (StateWriter,
// StateReader). What is read can be used safely: lists that belong together have one length, and
// lists that are searched are sorted.

[[noreturn]] inline void FailState(const StateReader& archive, const std::string& what) {
  throw InputError(archive.source() + ": expected a state that agrees with itself, found " + what);
}

// Transfers features as they were measured, and the correction that they have.
template <class Archive, Like<IndexedFeatures> T>
void Transfer(Archive& archive, T& indexed) {
  if constexpr (Archive::kReading) {
    Features measured;
    FeatureCorrection correction;
    TransferAll(archive, measured, correction);
    indexed = *IndexFeatures(archive.camera(), std::move(measured), correction);
  } else {
    const Features measured = MeasuredFeatures(indexed);
    TransferAll(archive, measured, indexed.correction);
  }
}

template <class Archive, Like<Frame> T>
void Transfer(Archive& archive, T& frame) {
  TransferPlace(archive, frame);
  TransferAll(archive, frame.indexed, frame.points, frame.lines);
  if constexpr (Archive::kReading) {
    if (frame.indexed == nullptr || frame.points.size() != frame.features().points.size() ||
        frame.lines.size() != frame.features().lines.size()) {
      FailState(archive, "matches of other features");
    }
  }
}

template <class Archive, Like<KeyFrame> T>
void Transfer(Archive& archive, T& k) {
  TransferAll(archive, k.id, k.parent, k.frame, k.unit, k.number, k.session);
}

template <class Archive, Like<PointModel> T>
void Transfer(Archive& archive, T& p) {
  TransferAll(archive, p.position, p.view_direction, p.reference_distance, p.reference_octave);
  Transfer(archive, p.descriptor);
}
template <class Archive, Like<LineModel> T>
void Transfer(Archive& archive, T& l) {
  TransferAll(archive, l.line, l.start, l.end, l.information, l.view_direction, l.descriptor);
}

// Returns the part of a landmark that is a model, const if the landmark is.
template <class Model, class Landmark>
auto& ModelOf(Landmark& landmark) {
  return static_cast<std::conditional_t<std::is_const_v<Landmark>, const Model, Model>&>(landmark);
}

template <class Archive, Like<SnapshotPoint> T>
void Transfer(Archive& archive, T& point) {
  Transfer(archive, ModelOf<PointModel>(point));
  TransferAll(archive, point.id, point.observation_count);
}
template <class Archive, Like<SnapshotLine> T>
void Transfer(Archive& archive, T& line) {
  Transfer(archive, ModelOf<LineModel>(line));
  TransferAll(archive, line.id, line.observation_count);
}

template <class Landmark>
bool AscendById(const std::vector<Landmark>& landmarks) {
  return std::adjacent_find(landmarks.begin(), landmarks.end(), [](const auto& a, const auto& b) {
           return !(a.id < b.id);
         }) == landmarks.end();
}

template <class Archive, Like<MapSnapshot> T>
void Transfer(Archive& archive, T& s) {
  TransferAll(archive, s.map, s.centre, s.correction, s.cam_from_world, s.places, s.reference);
  TransferAll(archive, s.points, s.lines, s.withdrawn);
  if constexpr (Archive::kReading) {
    if (s.reference == nullptr || !s.places.contains(s.centre)) {
      FailState(archive, "a snapshot without its centre");
    }
    if (!AscendById(s.points) || !AscendById(s.lines)) {
      FailState(archive, "landmarks out of order");
    }
  }
}

template <class Archive, Like<TrackingScores> T>
void Transfer(Archive& archive, T& scores) {
  TransferAll(archive, scores.points, scores.lines);
}

}  // namespace plumbline
