// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/features/feature_correction.h"
#include "plumbline/map/edit.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/id_table.h"
#include "plumbline/map/keyframe_pose.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/removed_keyframes.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// All of a map except its keyframes and landmarks. MapBuilder restores the map from both.
struct MapRecord {
  MapId id{0};
  std::int64_t version = 0;
  std::int64_t keyframes_taken_in = 0;
  KeyFrameId next_keyframe{0};
  PointId next_point{0};
  LineId next_line{0};
  FeatureCorrection correction;
  std::map<KeyFrameId, RemovedKeyFrame> removed_keyframes;
  // key: the removed landmark; value: the one it was merged into
  std::map<PointId, PointId> merged_points;
  std::map<LineId, LineId> merged_lines;
};

// Distinguishes a map from its copies, which have the same id but may diverge. A copy gets an
// identity of its own; a moved map keeps its identity.
class MapIdentity {
 public:
  MapIdentity() : token_(std::make_shared<const char>('\0')) {}
  MapIdentity(const MapIdentity&) : MapIdentity() {}
  MapIdentity(MapIdentity&&) noexcept = default;
  MapIdentity& operator=(MapIdentity other) noexcept {
    token_ = std::move(other.token_);
    return *this;
  }
  ~MapIdentity() = default;

  // Returns a pointer that is unique while anyone holds it; nullptr after a move.
  const std::shared_ptr<const char>& token() const { return token_; }

 private:
  std::shared_ptr<const char> token_;
};

// Keyframes, points and lines of one connected world, keyed by id. Only Apply changes it. Copies
// share unchanged parts. Copying takes some microseconds per thousand landmarks, and the copy may
// be read in another thread.
class Map {
 public:
  explicit Map(MapId id = MapId{0}) : id_(id) {}

  MapId id() const { return id_; }
  // Identity of this object, for caches of values computed from a map: equal tokens mean the same
  // map, and the pages of its tables tell what has changed since. Copies have tokens of their own;
  // a moved-from map has none (nullptr).
  const std::shared_ptr<const char>& token() const { return identity_.token(); }
  // The tables, in the order of the ids. Their pages record when they last changed, so that a
  // viewer of a large map need not compare all of it.
  const IdTable<KeyFrameId, KeyFrame>& keyframes() const { return keyframes_; }
  const IdTable<PointId, MapPoint>& points() const { return points_; }
  const IdTable<LineId, MapLine>& lines() const { return lines_; }

  // Returns nullptr for an unknown or removed object. The pointer is valid until the map changes.
  const KeyFrame* Find(KeyFrameId id) const;
  const MapPoint* Find(PointId id) const;
  const MapLine* Find(LineId id) const;

  // Largest number of remembered merges of each kind. Only matches of the last few keyframes, not
  // yet in the map, need them. Beyond it, the merge of the oldest landmark is forgotten.
  static constexpr std::size_t kMostMerges = std::size_t{1} << 16U;

  // Returns the current id of a landmark: `id`, the one it was merged into, or an invalid id.
  PointId Current(PointId id) const;
  LineId Current(LineId id) const;

  // Returns the pose of a keyframe that is or was in the map: a removed one moves with its parent.
  KeyFramePose PlaceOf(KeyFrameId id) const;
  Rigid3 PoseOf(KeyFrameId id) const { return PlaceOf(id).cam_from_world; }
  // Returns true if a keyframe is or was in the map.
  bool Knows(KeyFrameId id) const;
  // Returns KeyFrame::parent, even of a removed keyframe; invalid for an unknown one.
  KeyFrameId ParentOf(KeyFrameId id) const;
  // Returns KeyFrame::number, even of a removed keyframe.
  std::int64_t NumberOf(KeyFrameId id) const;

  // Increases with every applied edit.
  std::int64_t version() const { return version_; }

  // Makes new landmarks get at least these ids, since ids are unique in all maps of an atlas.
  void ReserveIds(PointId next_point, LineId next_line);

  // Ids for new objects, higher than all earlier ones.
  KeyFrameId NextKeyFrameId() const { return next_keyframe_; }
  PointId NextPointId() const { return next_point_; }
  LineId NextLineId() const { return next_line_; }

  // Correction applied to the features of all keyframes.
  const FeatureCorrection& correction() const { return correction_; }

  // Returns the data to be saved beside keyframes and landmarks. MapBuilder restores the map from
  // all of it.
  MapRecord Record() const;

  // Makes several changes happen together or not at all: restores the map's state at construction,
  // unless Keep() is called before destruction. Each page and entry that changes meanwhile is
  // copied once. Meanwhile the map may be copied, but not moved. Nested in another Undo of the same
  // map, it does nothing.
  class Undo {
   public:
    explicit Undo(Map& map);
    ~Undo();
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;
    void Keep();

   private:
    struct Before;

    Map& map_;
    std::unique_ptr<Before> before_;  // null if nested in another one
    bool keep_ = false;
  };

  // Applies the changes in order. Changes of objects that an earlier change removed are skipped. If
  // it throws, the map is unchanged.
  void Apply(const MapEdit& edit);

  // Absorbs another map of the same atlas, whose ids are disjoint from this map's. The other map is
  // moved by `this_from_other` (from world to world; scale 1 if depth is measured). Keyframes are
  // renumbered (KeyFrame::number): those of the map that made the newest one come last. Features of
  // the other map get this map's correction; if this map has no lens correction, both get that of
  // the other map. Landmarks of both maps are duplicates until they are fused. If it throws, this
  // map is unchanged. O(size of both maps).
  void Absorb(Map other, const Similarity3& this_from_other);

  // Throws BugError if observations and matches disagree or a landmark has no observation.
  void CheckInvariants() const;

 private:
  // Has one overload for each kind of change; points and lines share the templates behind them.
  friend struct MapChanger;
  friend class MapBuilder;

  void ShiftNumbers(std::int64_t shift);

  MapId id_;
  MapIdentity identity_;
  std::int64_t version_ = 0;
  std::int64_t keyframes_taken_in_ = 0;
  KeyFrameId next_keyframe_{0};
  PointId next_point_{0};
  LineId next_line_{0};
  FeatureCorrection correction_;
  IdTable<KeyFrameId, KeyFrame> keyframes_;
  IdTable<PointId, MapPoint> points_;
  IdTable<LineId, MapLine> lines_;
  RemovedKeyFrames removed_keyframes_;
  // key: the removed landmark; value: the one it was merged into
  IdTable<PointId, PointId> merged_points_;
  IdTable<LineId, LineId> merged_lines_;
};

// Returns the positions of a map's points in the world, in the order of their ids.
std::vector<Eigen::Vector3d> PointPositions(const Map& map);

}  // namespace plumbline
