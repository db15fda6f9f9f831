// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/edit.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/id_table.h"
#include "plumbline/map/keyframe_pose.h"
#include "plumbline/map/landmarks.h"
#include "plumbline/map/map_identity.h"
#include "plumbline/map/map_record.h"
#include "plumbline/map/removed_keyframes.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Keyframes, points and lines of one connected world, keyed by id. Many read it, only Apply changes
// it. A copy shares with the other map what neither has changed since. Copying takes some
// microseconds for a thousand landmarks, and the copy may be read in another thread.
class Map {
 public:
  explicit Map(MapId id = MapId{0}) : id_(id) {}

  MapId id() const { return id_; }
  // Those who keep what they computed of a map hold this token, too. A map that has it is the one
  // they looked at, and the pages of its tables tell what has changed since. Copies have tokens of
  // their own; a map that was moved away has none (nullptr).
  const std::shared_ptr<const char>& token() const { return identity_.token(); }
  // The tables, in the order of the ids. Their pages tell when they last changed, so that those who
  // show a large map need not compare all of it.
  const IdTable<KeyFrameId, KeyFrame>& keyframes() const { return keyframes_; }
  const IdTable<PointId, MapPoint>& points() const { return points_; }
  const IdTable<LineId, MapLine>& lines() const { return lines_; }

  // Returns nullptr where there is no such object (any more). The pointer is valid until the map
  // changes.
  const KeyFrame* Find(KeyFrameId id) const;
  const MapPoint* Find(PointId id) const;
  const MapLine* Find(LineId id) const;

  // Number of merges of each kind that are remembered. Matches that are on their way into the map
  // are those of the last few keyframes. When there are more merges, that of the oldest landmark is
  // forgotten.
  static constexpr std::size_t kMostMerges = std::size_t{1} << 16U;

  // Returns the landmark that `id` is today: itself, the one it was merged into, or an invalid id.
  PointId Current(PointId id) const;
  LineId Current(LineId id) const;

  // Returns the place of a keyframe that is or was in the map: a removed one moves with its parent.
  KeyFramePose PlaceOf(KeyFrameId id) const;
  Rigid3 PoseOf(KeyFrameId id) const { return PlaceOf(id).cam_from_world; }
  // Whether a keyframe is or was in the map.
  bool Knows(KeyFrameId id) const;
  // Returns KeyFrame::parent, even of a removed keyframe; invalid for one that the map does not
  // know.
  KeyFrameId ParentOf(KeyFrameId id) const;
  // Returns KeyFrame::number, even of a removed keyframe.
  std::int64_t NumberOf(KeyFrameId id) const;

  // Grows with every edit that is applied.
  std::int64_t version() const { return version_; }

  // Makes new landmarks get at least these ids, since an atlas uses an id only once in all its
  // maps.
  void ReserveIds(PointId next_point, LineId next_line);

  // Ids for new objects, higher than any used before.
  KeyFrameId NextKeyFrameId() const { return next_keyframe_; }
  PointId NextPointId() const { return next_point_; }
  LineId NextLineId() const { return next_line_; }

  // The correction that is applied to the features of all keyframes.
  const FeatureCorrection& correction() const { return correction_; }

  // Returns what has to be saved beside keyframes and landmarks. A MapBuilder makes the map of all
  // of it.
  MapRecord Record() const;

  // Makes several changes happen together or not at all: puts the map back as it was when this was
  // made, unless Keep() is called before the end. Each page and entry that changes meanwhile is
  // copied once. The map may be copied meanwhile, not moved. Within another one of the same map, it
  // leaves that to the other.
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
    std::unique_ptr<Before> before_;  // null within another one
    bool keep_ = false;
  };

  // Carries out the changes in order. Changes that name an object that an earlier change removed
  // are skipped. Where anything is thrown, the map is as it was.
  void Apply(const MapEdit& edit);

  // Takes in all of another map of the same atlas, which uses none of this map's ids. The other map
  // is moved by `this_from_other` (from world to world; scale 1 where depth is measured). The
  // keyframes of the map that took in the newest one count as taken in after those of the other.
  // Features of the other map get this map's correction; where it has no lens correction, both get
  // that of the other map. Landmarks that both maps have are there twice until they are fused.
  // Where anything is thrown, this map is as it was. O(size of both maps).
  void Absorb(Map other, const Similarity3& this_from_other);

  // Throws BugError when observations and matches disagree or a landmark has none.
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
  // key: the landmark that is gone; value: the one it became
  IdTable<PointId, PointId> merged_points_;
  IdTable<LineId, LineId> merged_lines_;
};

// Returns the places of the points of a map in the world, in the order of their ids.
std::vector<Eigen::Vector3d> PointPositions(const Map& map);

}  // namespace plumbline
