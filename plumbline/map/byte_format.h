// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/byte_format.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/keyframe_pose.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/map.h"
#include "plumbline/map/saved_atlas.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// Transfer (base/byte_format.h) of maps and their parts.

template <class Archive, Like<KeyFramePose> T>
void Transfer(Archive& archive, T& place) {
  TransferAll(archive, place.cam_from_world, place.scale);
}
template <class Archive, Like<RelativePose> T>
void Transfer(Archive& archive, T& relative) {
  TransferAll(archive, relative.cam_from_keyframe, relative.scale);
}
template <class Archive, Like<Uuid> T>
void Transfer(Archive& archive, T& uuid) {
  Transfer(archive, uuid.bytes);
}
template <class Archive, Like<Session> T>
void Transfer(Archive& archive, T& s) {
  TransferAll(archive, s.uuid, s.program, s.data, s.first_stamp_ns, s.last_stamp_ns);
}
template <class Archive, Like<LandmarkIds> T>
void Transfer(Archive& archive, T& young) {
  TransferAll(archive, young.points, young.lines);
}
template <class Archive, Like<RemovedKeyFrame> T>
void Transfer(Archive& archive, T& k) {
  TransferAll(archive, k.parent, k.from_parent, k.scale, k.number);
}
template <class Archive, Like<MapRecord> T>
void Transfer(Archive& archive, T& r) {
  TransferAll(archive, r.id, r.version, r.keyframes_taken_in, r.next_keyframe, r.next_point);
  TransferAll(archive, r.next_line, r.correction.stereo, r.removed_keyframes, r.merged_points);
  TransferAll(archive, r.merged_lines);
}
template <class Archive, Like<MapContext> T>
void Transfer(Archive& archive, T& context) {
  TransferAll(archive, context.uuid, context.young);
}
template <class Archive, Like<AtlasContext> T>
void Transfer(Archive& archive, T& c) {
  // Version 0.2.0 kept a number made of the calibration and the options of the front end as well.
  std::uint64_t calibration = 0;
  std::map<std::string, std::string> front_end;
  TransferAll(archive, c.camera, c.rectified_from_left, c.octave_scale, calibration);
  TransferAll(archive, c.stereo_evidence, c.feature_format, front_end, c.options_yaml);
  TransferAll(archive, c.sessions, c.maps);
}
template <class Archive, Like<TrackingScore> T>
void Transfer(Archive& archive, T& score) {
  TransferAll(archive, score.visible, score.found);
}

// Transfers a frame without its features and matches.
template <class Archive, Like<Frame> T>
void TransferPlace(Archive& archive, T& frame) {
  TransferAll(archive, frame.id, frame.stamp_ns, frame.cam_from_world);
}

// Transfers a keyframe of a map without its features and matches; the matches follow from the
// observations of the landmarks.
template <class Archive, Like<KeyFrame> T>
void TransferPlace(Archive& archive, T& k) {
  TransferAll(archive, k.id, k.parent, k.number, k.scale, k.session);
  TransferPlace(archive, k.frame);
}

// Pointers to the landmarks to be written or filled in.
template <class Landmark>
using LandmarkList = std::vector<Landmark*>;

// Transfers vectors of three numbers, one for each item.
template <class Archive, class Items, class Get>
void TransferVectors(Archive& archive, Items& items, const Get& get) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    TransferColumn(
        archive, items, [&](auto& item) -> auto& { return get(item)(i); });
  }
}

// Transfers observations: first their number for each landmark, then the keyframes, each as the
// difference to the one before (the first: to the keyframe that created the landmark), then the
// features.
template <class Archive, class Landmark>
void TransferObservations(Archive& archive, LandmarkList<Landmark>& landmarks) {
  std::vector<std::int32_t> counts;
  std::vector<std::pair<std::int64_t, int>> entries;
  if constexpr (!Archive::kReading) {
    for (const Landmark* landmark : landmarks) {
      counts.push_back(static_cast<std::int32_t>(landmark->observations.size()));
      std::int64_t before = landmark->created_by.value;
      for (const auto& [keyframe, feature] : landmark->observations) {
        entries.emplace_back(keyframe.value - before, feature);
        before = keyframe.value;
      }
    }
  }
  counts.resize(landmarks.size());
  TransferColumn(
      archive, counts, [](auto& count) -> auto& { return count; });
  const std::size_t total = TransferCount(archive, entries.size(), 2);
  entries.resize(total);
  TransferColumn(
      archive, entries, [](auto& entry) -> auto& { return entry.first; });
  TransferColumn(
      archive, entries, [](auto& entry) -> auto& { return entry.second; });
  if constexpr (Archive::kReading) {
    const auto fail = [&] {
      throw InputError(archive.source() + ": expected observations in order");
    };
    std::size_t next = 0;
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      // Unsigned numbers wrap around instead of overflowing where a file has wild numbers.
      auto id = static_cast<std::uint64_t>(landmarks[i]->created_by.value);
      for (std::int32_t k = 0; k < counts[i]; ++k) {
        if (next == total) fail();
        id += static_cast<std::uint64_t>(entries[next].first);
        const KeyFrameId keyframe{static_cast<std::int64_t>(id)};
        const auto& before = landmarks[i]->observations;
        if (!before.empty() && !(before.newest().first < keyframe)) fail();
        landmarks[i]->observations.emplace(keyframe, entries[next++].second);
      }
    }
    if (next != total) fail();
  }
}

// Transfers the descriptors of landmarks. A descriptor that equals that of an observed feature, the
// usual case, is stored as the index of that observation. `descriptor_of(keyframe, feature)`
// returns the descriptor of a feature, null for an unknown feature.
template <class Archive, class Landmark, class DescriptorOf>
void TransferLandmarkDescriptors(Archive& archive,
                                 LandmarkList<Landmark>& landmarks,
                                 const DescriptorOf& descriptor_of) {
  std::vector<std::int32_t> sources;
  LandmarkList<Landmark> others;
  if constexpr (!Archive::kReading) {
    for (Landmark* landmark : landmarks) {
      std::int32_t source = -1;
      std::int32_t place = 0;
      for (const auto& [keyframe, feature] : landmark->observations) {
        const Descriptor* descriptor = descriptor_of(keyframe, feature);
        if (source < 0 && descriptor != nullptr && *descriptor == landmark->descriptor) {
          source = place;
        }
        ++place;
      }
      sources.push_back(source);
    }
  }
  sources.resize(landmarks.size());
  TransferColumn(
      archive, sources, [](auto& source) -> auto& { return source; });
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (sources[i] < 0) {
      others.push_back(landmarks[i]);
    } else if constexpr (Archive::kReading) {
      const auto& observations = landmarks[i]->observations;
      const auto place = static_cast<std::size_t>(sources[i]);
      const auto at = observations.begin() +
                      static_cast<std::ptrdiff_t>(place < observations.size() ? place : 0);
      const Descriptor* descriptor =
          place < observations.size() ? descriptor_of(at->first, at->second) : nullptr;
      if (descriptor == nullptr) {
        throw InputError(archive.source() +
                         ": expected a descriptor, found a feature that is not there");
      }
      landmarks[i]->descriptor = *descriptor;
    }
  }
  TransferDescriptors(
      archive, others, [](auto* landmark) -> auto& { return landmark->descriptor; });
}

// Transfers the common members of points and lines, after the specific ones: descriptors need the
// observations.
template <class Archive, class Landmark, class DescriptorOf>
void TransferLandmarks(Archive& archive,
                       LandmarkList<Landmark>& landmarks,
                       const DescriptorOf& descriptor_of) {
  TransferColumn(
      archive, landmarks, [](auto* l) -> auto& { return l->id.value; });
  TransferColumn(
      archive, landmarks, [](auto* l) -> auto& { return l->created_by.value; });
  TransferColumn(
      archive, landmarks, [](auto* l) -> auto& { return l->score.visible; });
  TransferColumn(
      archive, landmarks, [](auto* l) -> auto& { return l->score.found; });
  TransferVectors(
      archive, landmarks, [](auto* l) -> auto& { return l->view_direction; });
  TransferObservations(archive, landmarks);
  TransferLandmarkDescriptors(archive, landmarks, descriptor_of);
}

template <class Archive, Like<MapPoint> Point, class DescriptorOf>
void TransferAllOf(Archive& archive,
                   LandmarkList<Point>& points,
                   const DescriptorOf& descriptor_of) {
  TransferVectors(
      archive, points, [](auto* p) -> auto& { return p->position; });
  TransferColumn(
      archive, points, [](auto* p) -> auto& { return p->reference_distance; });
  TransferColumn(
      archive, points, [](auto* p) -> auto& { return p->reference_octave; });
  TransferLandmarks(archive, points, descriptor_of);
}

inline bool IsSymmetric(const Eigen::Matrix4d& matrix) {
  const auto bits = [&](Eigen::Index row, Eigen::Index column) {
    return std::bit_cast<std::uint64_t>(matrix(row, column));
  };
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < row; ++column) {
      if (bits(row, column) != bits(column, row)) return false;
    }
  }
  return true;
}

// Information matrices are symmetric, usually to the last bit; then only the upper half is stored.
template <class Archive, Like<MapLine> Line, class DescriptorOf>
void TransferAllOf(Archive& archive, LandmarkList<Line>& lines, const DescriptorOf& descriptor_of) {
  TransferVectors(
      archive, lines, [](auto* l) -> auto& { return l->line.moment; });
  TransferVectors(
      archive, lines, [](auto* l) -> auto& { return l->line.direction; });
  TransferColumn(
      archive, lines, [](auto* l) -> auto& { return l->start; });
  TransferColumn(
      archive, lines, [](auto* l) -> auto& { return l->end; });
  bool symmetric = true;
  for (const auto* line : lines) symmetric = symmetric && IsSymmetric(line->information);
  Transfer(archive, symmetric);
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = symmetric ? row : 0; column < 4; ++column) {
      TransferColumn(
          archive, lines, [&](auto* l) -> auto& { return l->information(row, column); });
    }
  }
  if constexpr (Archive::kReading) {
    for (Eigen::Index row = 1; symmetric && row < 4; ++row) {
      for (Eigen::Index column = 0; column < row; ++column) {
        for (auto* l : lines) l->information(row, column) = l->information(column, row);
      }
    }
  }
  TransferLandmarks(archive, lines, descriptor_of);
}

}  // namespace plumbline
