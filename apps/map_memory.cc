// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_memory.h"

#include "plumbline/base/heap_bytes.h"

namespace plumbline {
namespace {

// Pages of pointers to the entries.
template <class Id, class T>
std::size_t TableBytes(const IdTable<Id, T>& table) {
  std::size_t bytes = table.page_count() * sizeof(void*);
  for (std::size_t page = 0; page < table.page_count(); ++page) {
    if (table.PageChanged(page) != 0) bytes += IdTable<Id, T>::kPage * sizeof(void*);
  }
  return bytes;
}

}  // namespace

std::vector<MemoryOfKind> MemoryOf(const Atlas& atlas) {
  std::size_t point_features = 0, line_features = 0, index = 0, matches = 0, keyframes = 0;
  std::size_t points = 0, lines = 0, observations = 0, tables = 0;
  for (const auto& [map_id, map] : atlas.maps()) {
    for (const auto& [id, keyframe] : map.keyframes()) {
      const Frame& frame = keyframe.frame;
      const Features& features = frame.features();
      point_features += HeapBytes(features.points) + features.point_disparity.Bytes();
      line_features += HeapBytes(features.lines) + features.line_right.Bytes();
      index += frame.indexed->point_grid.Bytes();
      matches += HeapBytes(frame.points) + HeapBytes(frame.lines);
      keyframes += sizeof(KeyFrame) + sizeof(FrameFeatures);
    }
    for (const auto& [id, point] : map.points()) observations += point.observations.Bytes();
    for (const auto& [id, line] : map.lines()) observations += line.observations.Bytes();
    points += map.points().size() * sizeof(MapPoint);
    lines += map.lines().size() * sizeof(MapLine);
    tables += TableBytes(map.keyframes()) + TableBytes(map.points()) + TableBytes(map.lines());
  }
  return {{"point features", point_features},
          {"line features", line_features},
          {"index of features", index},
          {"matches", matches},
          {"keyframes", keyframes},
          {"points", points},
          {"lines", lines},
          {"observations", observations},
          {"tables", tables}};
}

}  // namespace plumbline
