// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "map_export.h"

#include "plumbline/base/error.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/keyframe_trajectory.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/slam/saved_options.h"

#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/exported_map.h"
#include "bindings.h"
#include "interruptible.h"
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace plumbline::python {

namespace py = pybind11;
namespace {

// A warning of Python, from code that does not hold the GIL.
void Warn(const std::string& text) {
  const py::gil_scoped_acquire acquire;
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

SlamOptions OptionsOf(const PyMap& map) {
  return SavedOptionsOrDefault(
      map.saved->context, "options of the map", "lines as by default", Warn);
}

KeyFrameImages ImagesOf(const ImageSource& source, const SavedMap& saved) {
  if (const auto* path = std::get_if<std::filesystem::path>(&source)) {
    return KeyFrameImages(*path, {}, saved);
  }
  return KeyFrameImages(std::get<std::shared_ptr<Dataset>>(source), saved);
}

// The data that images come from; empty where they are of no file.
std::filesystem::path PathOf(const ImageSource& source) {
  if (const auto* path = std::get_if<std::filesystem::path>(&source)) return *path;
  return std::get<std::shared_ptr<Dataset>>(source)->info().path;
}

// The poses of the frames of the run, and their name in messages.
std::pair<std::string, Trajectory> FramePosesOf(const PyMap& map,
                                                const std::optional<PoseSource>& source) {
  if (source && std::holds_alternative<PoseList>(*source)) {
    return {"trajectory", std::get<PoseList>(*source).poses};
  }
  if (!source && map.file.empty()) {
    throw InputError(
        "frames: expected trajectory as well, the poses of the run's frames, found none beside a "
        "map that is of no file");
  }
  const std::filesystem::path file =
      source ? std::get<std::filesystem::path>(*source) : TrajectoryBeside(map.file, map.map->id());
  return {file.string(), ReadTrajectory(file).poses};
}

}  // namespace

std::vector<MappedLine> MappedLinesOf(const PyMap& map, const StopCheck& stop) {
  const AtlasContext& context = map.saved->context;
  return MakeLineMap(
      *map.map, {context.camera, context.octave_scale}, OptionsOf(map).mapping.line_map, stop);
}

Trajectory KeyFrameTrajectoryOf(const PyMap& map) {
  return KeyFrameTrajectory(*map.map, map.saved->context.rectified_from_left);
}

void ExportMap(const PyMap& map,
               const std::filesystem::path& path,
               const std::string& format,
               const ExportedImages& images) {
  const auto& [source, frames, trajectory, undistort] = images;
  MapExport wanted;
  wanted.undistort = undistort;
  wanted.format = ParseChoice<ExportFormat>("format", format);
  wanted.out = path;
  const int every = ParseExportedFrames(frames);
  CheckExport(wanted.format, source.has_value(), every, undistort);
  if (trajectory && every == 0) {
    throw InputError("trajectory: goes with frames=\"all\" and frames=\"every:N\" only");
  }
  std::vector<std::filesystem::path> read;
  if (!map.file.empty()) read.push_back(map.file);
  CheckOutput("path", path, read, KindOfExport(wanted.format));
  if (source && !PathOf(*source).empty()) {
    CheckFileApart("path", path, std::array{RunInput{PathOf(*source)}});
  }
  wanted.imaging = {map.saved->context.camera, map.saved->context.octave_scale};
  wanted.line_map = OptionsOf(map).mapping.line_map;
  RunInterruptibly([&](const StopCheck& stop) {
    const SavedMap saved = SavedMapOf(*map.map, map.saved->context, map.saved->file_version);
    if (every > 0) {
      const auto [file, poses] = FramePosesOf(map, images.trajectory);
      wanted.others = FramesBetween(saved, file, poses, every);
    }
    std::optional<KeyFrameImages> opened;
    if (images.source) {
      opened.emplace(ImagesOf(*images.source, saved));
      wanted.images = &*opened;
    }
    plumbline::ExportMap(saved, wanted, stop);
  });
}

}  // namespace plumbline::python
