// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/limap_lines.h"

#include "plumbline/io/atomic_file.h"
#include "plumbline/io/colmap_model.h"

#include <cstddef>

#include <fmt/core.h>

namespace plumbline {
namespace {

std::string ImageList(const Map& map, const std::map<KeyFrameId, std::string>& names) {
  std::string text = fmt::format("{}\n", map.keyframes().size());
  for (const auto& [id, keyframe] : map.keyframes()) {
    text += fmt::format("{} {}\n", ColmapImageId(id), names.at(id));
  }
  return text;
}

std::string Detections(const Map& map) {
  constexpr double kHalfPixel = 0.5;
  std::string text = fmt::format("{}\n", map.keyframes().size());
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::vector<LineFeature>& lines = keyframe.frame.features().lines;
    text += fmt::format("{} {}\n", ColmapImageId(id), lines.size());
    for (const LineFeature& line : lines) {
      text += fmt::format("{} {} {} {}\n",
                          line.segment.start.x() + kHalfPixel,
                          line.segment.start.y() + kHalfPixel,
                          line.segment.end.x() + kHalfPixel,
                          line.segment.end.y() + kHalfPixel);
    }
  }
  return text;
}

std::string Tracks(const Map& map) {
  std::string text = fmt::format("{}\n", map.lines().size());
  std::size_t index = 0;
  for (const auto& [id, line] : map.lines()) {
    // A keyframe shows a line with one segment.
    const std::size_t views = line.observations.size();
    text += fmt::format("{} {} {}\n", index++, views, views);
    const Segment3 segment = line.Interval();
    for (const Eigen::Vector3d& end : {segment.start, segment.end}) {
      text += fmt::format("{} {} {}\n", end.x(), end.y(), end.z());
    }
    std::string images, segments;
    for (const auto& [keyframe, feature] : line.observations) {
      const char* blank = images.empty() ? "" : " ";
      images += fmt::format("{}{}", blank, ColmapImageId(keyframe));
      segments += fmt::format("{}{}", blank, feature);
    }
    text += images + "\n" + segments + "\n";
  }
  return text;
}

}  // namespace

void WriteLimapLines(const std::filesystem::path& folder,
                     const Map& map,
                     const std::map<KeyFrameId, std::string>& names) {
  WriteFileAtomically(folder / "image_list.txt", ImageList(map, names));
  WriteFileAtomically(folder / "detections.txt", Detections(map));
  WriteFileAtomically(folder / "alltracks.txt", Tracks(map));
}

}  // namespace plumbline
