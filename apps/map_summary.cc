// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_summary.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/reprojection.h"
#include "plumbline/mapping/options.h"

#include "apps/map_memory.h"
#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Json = nlohmann::ordered_json;

std::uintmax_t SizeOf(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": " + error.message());
  return size;
}

// A keyframe without a parent begins a path of its own.
double PathAlongKeyFrames(const Map& map) {
  double length = 0;
  std::optional<Eigen::Vector3d> previous;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Eigen::Vector3d centre = Inverse(keyframe.frame.cam_from_world).translation;
    if (previous && keyframe.parent.valid()) length += (centre - *previous).norm();
    previous = centre;
  }
  return length;
}

// The box that leaves out `share` of the places at each end of each axis.
Eigen::AlignedBox3d BoxOf(const std::vector<Eigen::Vector3d>& places, double share) {
  Eigen::AlignedBox3d box;
  if (places.empty()) return box;
  const auto last = static_cast<std::ptrdiff_t>(places.size()) - 1;
  const auto left_out = static_cast<std::ptrdiff_t>(share * static_cast<double>(places.size()));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& place : places) values.push_back(place(axis));
    std::sort(values.begin(), values.end());
    box.min()(axis) = values[static_cast<std::size_t>(left_out)];
    box.max()(axis) = values[static_cast<std::size_t>(last - left_out)];
  }
  return box;
}

double PerLandmark(std::size_t observations, std::size_t landmarks) {
  return landmarks == 0 ? 0 : static_cast<double>(observations) / static_cast<double>(landmarks);
}

std::string Row(const std::string& name, const std::string& text) {
  return fmt::format("{:<13} {}\n", name, text);
}

std::string BoxText(const Eigen::AlignedBox3d& box, const char* unit) {
  return fmt::format("x {:.2f} to {:.2f}, y {:.2f} to {:.2f}, z {:.2f} to {:.2f} {}",
                     box.min().x(),
                     box.max().x(),
                     box.min().y(),
                     box.max().y(),
                     box.min().z(),
                     box.max().z(),
                     unit);
}

Json BoxJson(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return nullptr;
  return {{"min", {box.min().x(), box.min().y(), box.min().z()}},
          {"max", {box.max().x(), box.max().y(), box.max().z()}}};
}

// All maps, the one to go on with first.
std::vector<const Map*> MapsOf(const Atlas& atlas) {
  std::vector<const Map*> maps;
  for (const auto& [id, map] : atlas.maps()) {
    maps.insert(id == atlas.active_id() ? maps.begin() : maps.end(), &map);
  }
  return maps;
}

Json MapJson(const RectifiedCamera& camera, const Map& map) {
  const MapSummary summary = Summarize(camera, map);
  Json json = {{"id", map.id().value},
               {"keyframes", summary.keyframes},
               {"first_keyframe_s", nullptr},
               {"last_keyframe_s", nullptr},
               {"path_length", summary.path_length},
               {"points", summary.points},
               {"point_observations", summary.point_observations},
               {"mean_reprojection_px", nullptr},
               {"lines", summary.lines},
               {"line_observations", summary.line_observations},
               {"bounds", BoxJson(summary.bounds)},
               {"bounds_of_middle_90_percent", BoxJson(summary.middle_bounds)}};
  if (summary.time_ns) {
    // Text, since a JSON number does not hold nanoseconds.
    json["first_keyframe_s"] = FormatStamp(summary.time_ns->first);
    json["last_keyframe_s"] = FormatStamp(summary.time_ns->second);
  }
  if (summary.reprojection_px) json["mean_reprojection_px"] = *summary.reprojection_px;
  json["lens_correction_px"] = map.correction().lens.border_px();
  return json;
}

std::string MapRows(const RectifiedCamera& camera, const Map& map) {
  constexpr double kNanoseconds = 1e9;
  const MapSummary summary = Summarize(camera, map);
  const char* unit = KnowsUnitOfLength(camera) ? "m" : "units";
  std::string text = Row("keyframes", std::to_string(summary.keyframes));
  if (summary.time_ns) {
    const auto [first, last] = *summary.time_ns;
    text += Row("time",
                fmt::format("{} to {} s ({:.1f} s)",
                            FormatStamp(first),
                            FormatStamp(last),
                            static_cast<double>(last - first) / kNanoseconds));
  }
  text += Row("path", fmt::format("{:.2f} {} along the keyframes", summary.path_length, unit));
  std::string points = fmt::format("{}, seen by {:.1f} keyframes on average",
                                   summary.points,
                                   PerLandmark(summary.point_observations, summary.points));
  if (summary.reprojection_px) {
    points += fmt::format(", reprojection error {:.2f} px", *summary.reprojection_px);
  }
  text += Row("points", points);
  text += Row("lines",
              fmt::format("{}, seen by {:.1f} keyframes on average",
                          summary.lines,
                          PerLandmark(summary.line_observations, summary.lines)));
  if (const double border_px = map.correction().lens.border_px(); border_px != 0) {
    text += Row("lens", fmt::format("corrected by {:.1f} px at the image's side", border_px));
  }
  if (!summary.bounds.isEmpty()) {
    text += Row("bounds", BoxText(summary.bounds, unit));
    text += Row("middle 90 %", BoxText(summary.middle_bounds, unit));
  }
  return text;
}

std::size_t KeyFramesOf(const Atlas& atlas) {
  std::size_t count = 0;
  for (const auto& [id, map] : atlas.maps()) count += map.keyframes().size();
  return count;
}

std::string MemoryRows(const Atlas& atlas) {
  constexpr double kBytesPerKilobyte = 1e3;
  const auto keyframes = static_cast<double>(std::max<std::size_t>(KeyFramesOf(atlas), 1));
  const auto row = [&](const std::string& kind, std::size_t bytes) {
    const double kilobytes = static_cast<double>(bytes) / kBytesPerKilobyte;
    return fmt::format(
        "  {:<18} {:>10.0f} kB {:>8.1f} kB a keyframe\n", kind, kilobytes, kilobytes / keyframes);
  };
  std::string text = "memory\n";
  std::size_t all = 0;
  for (const MemoryOfKind& part : MemoryOf(atlas)) {
    text += row(part.kind, part.bytes);
    all += part.bytes;
  }
  return text + row("all", all);
}

std::string OtherMapRow(const Map& map) {
  return Row(fmt::format("map {}", map.id().value),
             fmt::format("{}, {}, {}",
                         Counted(map.keyframes().size(), "keyframe"),
                         Counted(map.points().size(), "point"),
                         Counted(map.lines().size(), "line")));
}

}  // namespace

MapSummary Summarize(const RectifiedCamera& camera, const Map& map) {
  MapSummary summary;
  summary.keyframes = map.keyframes().size();
  summary.points = map.points().size();
  summary.lines = map.lines().size();
  summary.path_length = PathAlongKeyFrames(map);
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::int64_t stamp = keyframe.frame.stamp_ns;
    if (!summary.time_ns) summary.time_ns = {stamp, stamp};
    summary.time_ns->first = std::min(summary.time_ns->first, stamp);
    summary.time_ns->second = std::max(summary.time_ns->second, stamp);
  }
  std::vector<Eigen::Vector3d> places, weak_ends;
  double error_sum = 0;
  std::size_t error_count = 0;
  for (const auto& [id, point] : map.points()) {
    if (HasKnownDistance(camera, map, point)) places.push_back(point.position);
    summary.point_observations += point.observations.size();
    if (const auto error = MeanReprojectionError(camera, map, point)) {
      error_sum += *error;
      ++error_count;
    }
  }
  if (error_count > 0) summary.reprojection_px = error_sum / static_cast<double>(error_count);
  for (const auto& [id, line] : map.lines()) {
    // Lines that too few keyframes show for the line map can have an end a million times too far.
    const auto established = static_cast<std::size_t>(LineMapOptions().min_keyframes);
    std::vector<Eigen::Vector3d>& ends =
        line.observations.size() >= established ? places : weak_ends;
    ends.push_back(line.Interval().start);
    ends.push_back(line.Interval().end);
    summary.line_observations += line.observations.size();
  }
  if (places.empty()) places = weak_ends;
  constexpr double kLeftOut = 0.05;
  summary.bounds = BoxOf(places, 0);
  summary.middle_bounds = BoxOf(places, kLeftOut);
  return summary;
}

std::string MapInfoTable(const std::filesystem::path& path, const SavedAtlas& saved, bool memory) {
  constexpr double kBytesPerMegabyte = 1e6;
  const RectifiedCamera& c = saved.context.camera;
  std::string text = Row("file",
                         fmt::format("{}, version {}, {:.1f} MB",
                                     path.string(),
                                     saved.file_version,
                                     static_cast<double>(SizeOf(path)) / kBytesPerMegabyte));
  text += Row("camera",
              fmt::format("{}x{}, fx {:.6g} fy {:.6g} cx {:.6g} cy {:.6g}, rectified",
                          c.width,
                          c.height,
                          c.fx,
                          c.fy,
                          c.cx,
                          c.cy));
  text += Row("baseline",
              MeasuresDepth(c)
                  ? fmt::format("{:.4f} m", c.baseline)
                  : std::string("none: a single camera; lengths are in the map's own unit"));
  const std::vector<const Map*> maps = MapsOf(saved.atlas);
  if (maps.empty()) return text + Row("maps", "0");
  std::string numbers = fmt::format("number {}", maps.front()->id().value);
  if (maps.size() > 1) numbers += ", of which the rest speaks";
  text += Row("maps", fmt::format("{} ({})", maps.size(), numbers)) + MapRows(c, *maps.front());
  for (std::size_t i = 1; i < maps.size(); ++i) text += OtherMapRow(*maps[i]);
  return memory ? text + MemoryRows(saved.atlas) : text;
}

std::string MapInfoJson(const std::filesystem::path& path, const SavedAtlas& saved, bool memory) {
  const RectifiedCamera& c = saved.context.camera;
  const Eigen::Quaterniond& q = saved.context.rectified_from_left;
  Json json = {{"file", path.string()},
               {"version", saved.file_version},
               {"bytes", SizeOf(path)},
               {"camera",
                {{"width", c.width},
                 {"height", c.height},
                 {"fx", c.fx},
                 {"fy", c.fy},
                 {"cx", c.cx},
                 {"cy", c.cy},
                 {"baseline", c.baseline},
                 {"rectified_from_left_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
               {"unit", KnowsUnitOfLength(c) ? "m" : "of the map"},
               {"maps", Json::array()}};
  for (const Map* map : MapsOf(saved.atlas)) json["maps"].push_back(MapJson(c, *map));
  if (memory) {
    for (const MemoryOfKind& part : MemoryOf(saved.atlas)) {
      std::string key = part.kind + "_bytes";
      std::replace(key.begin(), key.end(), ' ', '_');
      json["memory"][key] = part.bytes;
    }
  }
  // A path need not be UTF-8; invalid bytes become replacement characters.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumbline
