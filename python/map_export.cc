// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_export.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/colmap_model.h"
#include "plumbline/io/dxf.h"
#include "plumbline/io/keyframe_images.h"
#include "plumbline/io/limap_lines.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/ply.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/mapping/line_map.h"

#include "apps/command_line.h"
#include <map>
#include <vector>

namespace plumbline::python {
namespace {

enum class ExportFormat { kPly, kObj, kDxf, kTum, kColmap };
constexpr auto EnumNames(std::type_identity<ExportFormat>) {
  return std::array{std::pair{ExportFormat::kPly, "ply"},
                    std::pair{ExportFormat::kObj, "obj"},
                    std::pair{ExportFormat::kDxf, "dxf"},
                    std::pair{ExportFormat::kTum, "tum"},
                    std::pair{ExportFormat::kColmap, "colmap"}};
}

std::vector<Segment3> LinesOf(const PyMap& map) {
  std::vector<Segment3> segments;
  for (const MappedLine& line : MakeLineMap(*map.map, {map.saved->context.camera}, {})) {
    segments.push_back(line.segment);
  }
  return segments;
}

void WritePointsAndLines(const PyMap& map, const std::filesystem::path& path) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& [id, point] : map.map->points()) points.push_back(point.position);
  WritePly(path, points, LinesOf(map));
}

void WriteColmap(const PyMap& map, const std::filesystem::path& path) {
  const AtlasContext& context = map.saved->context;
  const SavedMap saved{
      context.camera, context.rectified_from_left, *map.map, map.saved->file_version};
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  AtomicFolder folder(path);
  const ColmapModel model = MakeColmapModel(saved, names);
  const std::filesystem::path sparse = folder.temporary_path() / "sparse" / "0";
  MakeFolder(sparse);
  WriteColmapText(sparse, model);
  WriteColmapBinary(sparse, model);
  MakeFolder(folder.temporary_path() / "lines");
  WriteLimapLines(folder.temporary_path() / "lines", saved.map, names);
  folder.Commit();
}

}  // namespace

Trajectory KeyFrameTrajectoryOf(const PyMap& map) {
  const Rigid3 rectified_from_left{map.saved->context.rectified_from_left, Eigen::Vector3d::Zero()};
  std::map<std::int64_t, Rigid3> poses;
  for (const auto& [id, keyframe] : map.map->keyframes()) {
    poses.emplace(keyframe.frame.stamp_ns,
                  Inverse(keyframe.frame.cam_from_world) * rectified_from_left);
  }
  Trajectory trajectory;
  for (const auto& [stamp_ns, pose] : poses) trajectory.push_back({stamp_ns, pose});
  return trajectory;
}

void ExportMap(const PyMap& map, const std::filesystem::path& path, const std::string& format) {
  switch (ParseChoice<ExportFormat>("format", format)) {
    case ExportFormat::kPly:
      return WritePointsAndLines(map, path);
    case ExportFormat::kObj:
      return WriteObjLines(path, LinesOf(map));
    case ExportFormat::kDxf:
      return WriteDxfLines(path, LinesOf(map));
    case ExportFormat::kTum:
      return WriteTum(path, KeyFrameTrajectoryOf(map));
    case ExportFormat::kColmap:
      return WriteColmap(map, path);
  }
}

}  // namespace plumbline::python
