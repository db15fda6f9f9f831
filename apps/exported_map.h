// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/colmap_folder.h"
#include "plumbline/io/keyframe_images.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/posed_image.h"
#include "plumbline/mapping/line_map.h"

#include "apps/command_outputs.h"
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// What `plumbline map export` and Map.export of Python do. Messages name options of the command
// line; Python turns them into the names of its arguments.
namespace plumbline {

// The forms in which a map is written.
enum class ExportFormat { kPly, kObj, kDxf, kTum, kColmap, kNerfstudio };
constexpr auto EnumNames(std::type_identity<ExportFormat>) {
  return std::array{std::pair{ExportFormat::kPly, "ply"},
                    std::pair{ExportFormat::kObj, "obj"},
                    std::pair{ExportFormat::kDxf, "dxf"},
                    std::pair{ExportFormat::kTum, "tum"},
                    std::pair{ExportFormat::kColmap, "colmap"},
                    std::pair{ExportFormat::kNerfstudio, "nerfstudio"}};
}

// What an export of this form may take the place of; folders have to be new or empty.
FileKind KindOfExport(ExportFormat format);

// Which frames go into an export: the keyframes, and of the other frames with a pose every n-th.
// Reads "keyframes" (0), "all" (1), or "every:N" (N); throws InputError for another text.
int ParseExportedFrames(std::string_view text);

// Throws InputError where a form has no images, or needs some, and where frames besides keyframes
// (every > 0) are asked for without images.
void CheckExport(ExportFormat format, bool has_images, int every);

// Returns the file that has the poses of a map's frames, in the folder of the run that wrote the
// map file: trajectory_map<id>.txt where there is one, otherwise trajectory.txt. Throws InputError
// where there is neither.
std::filesystem::path TrajectoryBeside(const std::filesystem::path& map_file, MapId map);

// Returns every n-th of the frames of a trajectory that are no keyframes, at their poses; frames
// are counted with the keyframes. Throws InputError, which names `source`, where the trajectory
// is not that of the run that made the map: none of its poses, or another one, is at the time of
// a keyframe.
std::vector<PosedImage> FramesBetween(const SavedMap& saved,
                                      const std::string& source,
                                      const Trajectory& trajectory,
                                      int every);

// What is written of a map, and where.
struct MapExport {
  ExportFormat format = ExportFormat::kPly;
  std::filesystem::path out;
  const KeyFrameImages* images = nullptr;  // null: none are known
  std::vector<PosedImage> others = {};     // frames that are no keyframes
  ColmapFiles colmap_files = ColmapFiles::kBoth;
  // What decides about the lines, as in the run that made the map.
  CameraAndPyramid imaging = {};
  LineMapOptions line_map = {};
};

// Writes a map and returns what was written, "19 images, 800 points"; nullopt where `stop` has
// ended it, and nothing is written. Points have the mean colour of their places in the images of
// the keyframes. Throws InputError where an image cannot be read or is not that of its keyframe,
// and where a file cannot be written.
std::optional<std::string> ExportMap(const SavedMap& saved,
                                     const MapExport& wanted,
                                     const StopCheck& stop);

}  // namespace plumbline
