// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_export.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/colmap_folder.h"
#include "plumbline/io/colmap_model.h"
#include "plumbline/io/dxf.h"
#include "plumbline/io/keyframe_images.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/path_overlap.h"
#include "plumbline/io/ply.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/keyframe_trajectory.h"
#include "plumbline/slam/saved_options.h"

#include "apps/command_line.h"
#include "bindings.h"
#include <map>
#include <string>
#include <vector>

namespace plumbline::python {

namespace py = pybind11;
namespace {

enum class ExportFormat { kPly, kObj, kDxf, kTum, kColmap };
constexpr auto EnumNames(std::type_identity<ExportFormat>) {
  return std::array{std::pair{ExportFormat::kPly, "ply"},
                    std::pair{ExportFormat::kObj, "obj"},
                    std::pair{ExportFormat::kDxf, "dxf"},
                    std::pair{ExportFormat::kTum, "tum"},
                    std::pair{ExportFormat::kColmap, "colmap"}};
}

// A warning of Python, from code that does not hold the GIL.
void Warn(const std::string& text) {
  const py::gil_scoped_acquire acquire;
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

std::vector<Segment3> LinesOf(const PyMap& map) { return SegmentsOf(MappedLinesOf(map, {})); }

void WriteColmap(const PyMap& map, const std::filesystem::path& path) {
  const SavedMap saved = SavedMapOf(*map.map, map.saved->context, map.saved->file_version);
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  AtomicFolder folder(path);
  WriteColmapFolder(folder.temporary_path(), saved.map, MakeColmapModel(saved, names), names);
  folder.Commit();
}

}  // namespace

std::vector<MappedLine> MappedLinesOf(const PyMap& map, const StopCheck& stop) {
  const AtlasContext& context = map.saved->context;
  const SlamOptions options =
      SavedOptionsOrDefault(context, "options of the map", "lines as by default", Warn);
  return MakeLineMap(
      *map.map, {context.camera, context.octave_scale}, options.mapping.line_map, stop);
}

Trajectory KeyFrameTrajectoryOf(const PyMap& map) {
  return KeyFrameTrajectory(*map.map, map.saved->context.rectified_from_left);
}

void ExportMap(const PyMap& map, const std::filesystem::path& path, const std::string& format) {
  const auto chosen = ParseChoice<ExportFormat>("format", format);
  if (!map.file.empty() && IsSamePath(path, map.file)) {
    throw InputError(path.string() +
                     ": expected another file than the one that the map was read from");
  }
  switch (chosen) {
    case ExportFormat::kPly:
      return WritePly(path, PointPositions(*map.map), LinesOf(map));
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
