// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/viewer/map_comparison.h"
#include "plumbline/viewer/messages.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// A table of objects by id, with the version of the last change of each, to find the changes since
// a version without visiting the rest. Removed objects are remembered until they outnumber the
// others. A receiver with a version older than `forgotten()` needs everything.
template <class T>
class VersionedTable {
 public:
  // Sets a value. Versions must ascend from call to call.
  void Set(ShownId id, const T& value, std::uint64_t version) {
    Entry& entry = entries_[id];
    if (!entry.value && entry.version > 0) --gone_;
    live_ += !entry.value;
    entry = {value, version};
    Log(id, version);
  }
  void Remove(ShownId id, std::uint64_t version) {
    const auto it = entries_.find(id);
    if (it == entries_.end() || !it->second.value) return;
    it->second = {std::nullopt, version};
    --live_;
    ++gone_;
    Log(id, version);
    if (gone_ > std::max(live_, kAlwaysRemembered)) ForgetGone(version);
  }

  // Returns nullptr for an unknown id.
  const T* Find(ShownId id) const {
    const auto it = entries_.find(id);
    return it == entries_.end() || !it->second.value ? nullptr : &*it->second.value;
  }
  std::size_t size() const { return live_; }
  std::uint64_t forgotten() const { return forgotten_; }

  // Calls take(id, value) for all objects, in the order of their ids.
  template <class Take>
  void ForEach(const Take& take) const {
    for (const auto& [id, entry] : entries_) {
      if (entry.value) take(id, *entry.value);
    }
  }
  // Calls take(id, value or nullptr) for the objects changed after `version`, in the order of their
  // last changes.
  template <class Take>
  void ForEachSince(std::uint64_t version, const Take& take) const {
    const auto first = std::partition_point(
        log_.begin(), log_.end(), [&](const auto& change) { return change.first <= version; });
    for (auto it = first; it != log_.end(); ++it) {
      const auto entry = entries_.find(it->second);
      // Only the last of several changes counts.
      if (entry == entries_.end() || entry->second.version != it->first) continue;
      take(it->second, entry->second.value ? &*entry->second.value : nullptr);
    }
  }

 private:
  static constexpr std::size_t kAlwaysRemembered = 1000;

  struct Entry {
    std::optional<T> value;  // nullopt: removed
    std::uint64_t version = 0;
  };

  void Log(ShownId id, std::uint64_t version) {
    log_.emplace_back(version, id);
    if (log_.size() <= 2 * entries_.size() + kAlwaysRemembered) return;
    std::erase_if(log_, [&](const auto& change) {
      const auto entry = entries_.find(change.second);
      return entry == entries_.end() || entry->second.version != change.first;
    });
  }
  void ForgetGone(std::uint64_t version) {
    std::erase_if(entries_, [](const auto& entry) { return !entry.second.value; });
    gone_ = 0;
    forgotten_ = version;
  }

  std::map<ShownId, Entry> entries_;
  std::vector<std::pair<std::uint64_t, ShownId>> log_;  // ascending
  std::size_t live_ = 0, gone_ = 0;
  std::uint64_t forgotten_ = 0;
};

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
