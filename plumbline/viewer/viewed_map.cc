// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/viewed_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumbline {
namespace {

template <class T>
void Apply(const ShownChanges<T>& changes, std::uint64_t version, VersionedTable<T>& table) {
  for (const auto& [id, value] : changes.set) table.Set(id, value, version);
  for (const ShownId id : changes.gone) table.Remove(id, version);
}

// Ids and numbers of one kind of things, for packed fields.
struct Columns {
  std::vector<ShownId> ids, gone;
  std::vector<float> numbers;
  std::vector<std::uint32_t> frames, flags;

  void Add(const ShownPoint& point) { numbers.insert(numbers.end(), point.begin(), point.end()); }
  void Add(const ShownLine& line) {
    numbers.insert(numbers.end(), line.ends.begin(), line.ends.end());
    flags.push_back(line.established ? 1 : 0);
  }
  void Add(const ShownKeyFrame& keyframe) {
    numbers.insert(numbers.end(), keyframe.pose.begin(), keyframe.pose.end());
    frames.push_back(keyframe.frame);
  }
};

template <class T>
Columns ColumnsSince(const VersionedTable<T>& table, std::uint64_t from) {
  Columns columns;
  if (from == 0) {
    table.ForEach([&](ShownId id, const T& value) {
      columns.ids.push_back(id);
      columns.Add(value);
    });
    return columns;
  }
  table.ForEachSince(from, [&](ShownId id, const T* value) {
    if (value == nullptr) return columns.gone.push_back(id);
    columns.ids.push_back(id);
    columns.Add(*value);
  });
  return columns;
}

}  // namespace

void ViewedMap::Take(const MapChanges& changes) {
  if (changes.empty()) return;
  const std::uint64_t version = version_ + 1;
  if (changes.everything) {
    *this = ViewedMap();
    begins_ = tiles_begin_ = version;
  }
  id_ = changes.map;
  version_ = version;
  Apply(changes.points, version_, points_);
  Apply(changes.lines, version_, lines_);
  Apply(changes.keyframes, version_, keyframes_);
  for (const auto& edge : changes.edges) edges_[edge] = version_;
  for (const ShownId gone : changes.keyframes.gone) {
    std::erase_if(edges_, [&](const auto& entry) {
      return entry.first.first == gone || entry.first.second == gone;
    });
  }
  if (changes.everything || !changes.points.empty()) points_version_ = version_;
  if (changes.everything || !changes.lines.empty()) lines_version_ = version_;
  for (const auto& [id, line] : changes.lines.set) PutIntoTile(id, line);
  for (const ShownId id : changes.lines.gone) TakeFromTile(id);
  while (tiles_.size() > kMostTiles) DivideAnew();
}

bool ViewedMap::NeedsEverything(std::uint64_t from) const {
  return from < begins_ || from < points_.forgotten() || from < lines_.forgotten() ||
         from < keyframes_.forgotten();
}

ProtobufWriter ViewedMap::DeltaSince(std::uint64_t from) const {
  if (NeedsEverything(from)) from = 0;
  const Columns points = ColumnsSince(points_, from);
  const Columns lines = ColumnsSince(lines_, from);
  const Columns keyframes = ColumnsSince(keyframes_, from);
  std::vector<ShownId> edges;
  for (const auto& [edge, version] : edges_) {
    if (version > from) edges.insert(edges.end(), {edge.first, edge.second});
  }
  const std::uint64_t map = id_.valid() ? static_cast<std::uint64_t>(id_.value) : 0;
  ProtobufWriter delta;
  delta.Varint(1, map)
      .Varint(2, from)
      .Varint(3, version_)
      .Packed<std::uint32_t>(4, points.ids)
      .Packed<float>(5, points.numbers)
      .Packed<std::uint32_t>(6, points.gone)
      .Packed<std::uint32_t>(7, lines.ids)
      .Packed<float>(8, lines.numbers)
      .Packed<std::uint32_t>(9, lines.gone)
      .Packed<std::uint32_t>(10, keyframes.ids)
      .Packed<std::uint32_t>(11, keyframes.frames)
      .Packed<float>(12, keyframes.numbers)
      .Packed<std::uint32_t>(13, keyframes.gone)
      .Packed<std::uint32_t>(14, edges)
      .Packed<std::uint32_t>(15, lines.flags);
  return delta;
}

std::vector<float> ViewedMap::PointCloud() const {
  std::vector<float> xyz;
  xyz.reserve(3 * points_.size());
  points_.ForEach(
      [&](ShownId, const ShownPoint& point) { xyz.insert(xyz.end(), point.begin(), point.end()); });
  return xyz;
}

ViewedMap::Tiles ViewedMap::TilesSince(std::uint64_t from) const {
  Tiles tiles;
  tiles.all = from < tiles_begin_;
  for (const auto& [key, tile] : tiles_) {
    if (!tiles.all && tile.version <= from) continue;
    LineEntity entity{fmt::format("{},{},{}", key[0], key[1], key[2]), {}};
    for (const ShownId id : tile.lines) {
      const ShownLine& line = *lines_.Find(id);
      entity.ends.insert(entity.ends.end(), line.ends.begin(), line.ends.end());
    }
    tiles.entities.push_back(std::move(entity));
  }
  return tiles;
}

ViewedMap::TileKey ViewedMap::KeyOf(const ShownLine& line) const {
  constexpr float kFarthest = 1e6F;  // in tiles; also used for coordinates that are NaN
  TileKey key{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float middle = 0.5F * (line.ends[axis] + line.ends[axis + 3]) / tile_size_;
    key[axis] = std::isfinite(middle)
                    ? static_cast<int>(std::floor(std::clamp(middle, -kFarthest, kFarthest)))
                    : 0;
  }
  return key;
}

void ViewedMap::PutIntoTile(ShownId id, const ShownLine& line) {
  const TileKey key = KeyOf(line);
  const auto before = tile_of_.find(id);
  if (before != tile_of_.end() && before->second != key) TakeFromTile(id);
  tile_of_[id] = key;
  Tile& tile = tiles_[key];
  tile.lines.insert(id);
  tile.version = version_;
}

void ViewedMap::TakeFromTile(ShownId id) {
  const auto place = tile_of_.find(id);
  if (place == tile_of_.end()) return;
  Tile& tile = tiles_[place->second];
  tile.lines.erase(id);
  tile.version = version_;
  tile_of_.erase(place);
}

// Divides space again, into cubes of twice the size.
void ViewedMap::DivideAnew() {
  tile_size_ *= 2;
  tiles_begin_ = version_;
  tiles_.clear();
  tile_of_.clear();
  lines_.ForEach([&](ShownId id, const ShownLine& line) { PutIntoTile(id, line); });
}

}  // namespace plumbline
