// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/export/colmap_model.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"
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

// Implementation of `plumbline map export` and of Map.export of Python. Messages name options of
// the command line; Python replaces them by the names of its arguments.
namespace plumbline {

// Formats of an exported map.
enum class ExportFormat { kPly, kObj, kDxf, kTum, kColmap, kNerfstudio };
constexpr auto EnumNames(std::type_identity<ExportFormat>) {
  return std::array{std::pair{ExportFormat::kPly, "ply"},
                    std::pair{ExportFormat::kObj, "obj"},
                    std::pair{ExportFormat::kDxf, "dxf"},
                    std::pair{ExportFormat::kTum, "tum"},
                    std::pair{ExportFormat::kColmap, "colmap"},
                    std::pair{ExportFormat::kNerfstudio, "nerfstudio"}};
}

// Kind of files that an export of this format may replace; folders must be new or empty.
FileKind KindOfExport(ExportFormat format);

// Reads the frames of an export: the keyframes, and of the other frames with a pose every n-th:
// "keyframes" (0), "all" (1), or "every:N" (N); throws InputError for another text.
int ParseExportedFrames(std::string_view text);

// Throws InputError if images are given for a format without, or missing for one with images, and
// if frames other than keyframes (every > 0) or undistorted images are requested without images.
void CheckExport(ExportFormat format, bool has_images, int every, bool undistort);

// Returns the file with the poses of a map's frames, in the folder of the run that wrote the map
// file: trajectory_map<id>.txt if it exists, otherwise trajectory.txt. Throws InputError if there
// is neither.
std::filesystem::path TrajectoryBeside(const std::filesystem::path& map_file, MapId map);

// Returns every n-th frame of a trajectory that is no keyframe, with its pose; the count includes
// keyframes. Throws InputError, which names `source`, if the trajectory is not that of the run that
// made the map: at the time of a keyframe it has no pose or a different one.
std::vector<PosedImage> FramesBetween(const SavedMap& saved,
                                      const std::string& source,
                                      const Trajectory& trajectory,
                                      int every);

// Contents and format of an export.
struct MapExport {
  ExportFormat format = ExportFormat::kPly;
  std::filesystem::path out;
  const KeyFrameImages* images = nullptr;  // null: no images
  std::vector<PosedImage> others = {};     // frames other than keyframes
  bool undistort = false;                  // images without distortion, whatever the format knows
  ColmapFiles colmap_files = ColmapFiles::kBoth;
  // Inputs of MakeLineMap, as in the run that made the map.
  CameraAndPyramid imaging = {};
  LineMapOptions line_map = {};
};

// Writes a map and returns a summary, "19 images, 800 points"; nullopt if `stop` has ended it, and
// nothing is written. Images are as delivered if the format knows the lens (ColmapCameraOf,
// NerfstudioKnows), otherwise undistorted. Points have their mean colour in the images of the
// keyframes. Throws InputError if an image cannot be read or is not that of its keyframe, and if a
// file cannot be written.
std::optional<std::string> ExportMap(const SavedMap& saved,
                                     const MapExport& wanted,
                                     const StopCheck& stop);

}  // namespace plumbline
