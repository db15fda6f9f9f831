// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/messages.h"
#include "plumbline/view/map_changes.h"
#include "plumbline/view/versioned_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace plumbline {

// The map as viewers are shown it, in versions: what each of them lacks is what changed after the
// version that it has. For one thread.
class ViewedMap {
 public:
  void Take(const MapChanges& changes);

  // Grows with every change; 0: there is nothing yet.
  std::uint64_t version() const { return version_; }
  MapId id() const { return id_; }
  // nullptr where there is none.
  const ShownKeyFrame* FindKeyFrame(ShownId id) const { return keyframes_.Find(id); }

  // The field `map` of plumbline.Update for somebody who has version `from`; 0 asks for everything.
  // from is 0 in the message, too, where what they have is to be forgotten.
  ProtobufWriter DeltaSince(std::uint64_t from) const;

  // x, y, z of all points.
  std::vector<float> PointCloud() const;
  // When the points last changed.
  std::uint64_t points_version() const { return points_version_; }

  // Lines in cubes of space; the cubes that changed after `from`.
  struct Tiles {
    bool all = false;  // and there are no others
    std::vector<LineEntity> entities;
  };
  Tiles TilesSince(std::uint64_t from) const;
  // When the lines last changed.
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
  std::uint64_t begins_ = 0;  // with this version: earlier ones were of another map
  std::uint64_t points_version_ = 0, lines_version_ = 0;
  VersionedTable<ShownPoint> points_;
  VersionedTable<ShownLine> lines_;
  VersionedTable<ShownKeyFrame> keyframes_;
  std::map<std::pair<ShownId, ShownId>, std::uint64_t> edges_;  // with their versions
  float tile_size_ = 1;
  std::uint64_t tiles_begin_ = 0;  // with this version
  std::map<TileKey, Tile> tiles_;
  std::map<ShownId, TileKey> tile_of_;
};

}  // namespace plumbline
