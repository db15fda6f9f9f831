// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/messages.h"
#include "plumbline/viewer/map_changes.h"
#include "plumbline/viewer/versioned_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace plumbline {

// The displayed map, in versions. A viewer needs the changes after the version that it has. Not
// thread-safe.
class ViewedMap {
 public:
  void Take(const MapChanges& changes);

  // Returns a number that grows with every change; 0 before the first.
  std::uint64_t version() const { return version_; }
  MapId id() const { return id_; }
  // Returns nullptr for an unknown keyframe.
  const ShownKeyFrame* FindKeyFrame(ShownId id) const { return keyframes_.Find(id); }

  // Returns the field `map` of plumbline.Update for a receiver that has version `from`; 0 requests
  // everything. In the message `from` is 0, too, if the receiver must discard its content.
  ProtobufWriter DeltaSince(std::uint64_t from) const;

  // Returns x, y, z of all points.
  std::vector<float> PointCloud() const;
  // Returns the version of the last change of points.
  std::uint64_t points_version() const { return points_version_; }

  // Lines in cubes of space (tiles), for the cubes that changed after a version.
  struct Tiles {
    // True if these are all cubes, which replace all earlier ones.
    bool all = false;
    std::vector<LineEntity> entities;
  };
  Tiles TilesSince(std::uint64_t from) const;
  // Returns the version of the last change of lines.
  std::uint64_t lines_version() const { return lines_version_; }

 private:
  static constexpr std::size_t kMostTiles = 256;

  using TileKey = std::array<int, 3>;
  struct Tile {
    std::set<ShownId> lines;
    std::uint64_t version = 0;
  };

  TileKey KeyOf(const ShownLine& line) const;
  void PutIntoTile(ShownId id, const ShownLine& line);
  void TakeFromTile(ShownId id);
  void DivideAnew();
  bool NeedsEverything(std::uint64_t from) const;

  MapId id_;
  std::uint64_t version_ = 0;
  // First version of this map; earlier ones belong to another map.
  std::uint64_t begins_ = 0;
  std::uint64_t points_version_ = 0, lines_version_ = 0;
  VersionedTable<ShownPoint> points_;
  VersionedTable<ShownLine> lines_;
  VersionedTable<ShownKeyFrame> keyframes_;
  std::map<std::pair<ShownId, ShownId>, std::uint64_t> edges_;  // version of each edge
  float tile_size_ = 1;
  std::uint64_t tiles_begin_ = 0;  // first version of the current tiles
  std::map<TileKey, Tile> tiles_;
  std::map<ShownId, TileKey> tile_of_;
};

}  // namespace plumbline
