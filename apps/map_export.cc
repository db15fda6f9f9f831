// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/slam/saved_options.h"

#include "apps/chosen_map.h"
#include "apps/command_inputs.h"
#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/exported_map.h"
#include "apps/map_commands.h"
#include "apps/program_methods.h"
#include "apps/stop_signal.h"
#include <array>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

CommandSyntax MapExportSyntax() {
  return {"map export",
          "Writes a map in the form of another program: points and lines (ply), lines (obj, dxf), "
          "the\ntrajectory of the keyframes (tum), or a folder with a sparse model (colmap) or a "
          "data set\n(nerfstudio) with images.",
          {"FILE"},
          {{"--to", "ply|obj|dxf|tum|colmap|nerfstudio", "the form"},
           {"--out", "PATH", "file, or new folder for colmap and nerfstudio"},
           kMapOption,
           {"--images",
            "PATH",
            "the data that the map was made from: gives images, and points their colours"},
           {"--format",
            "auto|euroc|tum|kitti|images|video|bag|mcap|rosbag2",
            "of --images (found out from PATH)"},
           {"--topic", "NAME", "of --images, a bag or an MCAP file; may be repeated"},
           {"--camera", "FILE", "of --images: camera file, or the name of a built-in camera"},
           {"--rotate", "auto|none|90|180|270", "of --images, as for the run (auto)"},
           {"--view-angle", "DEGREES", "of --images, as for the run"},
           {"--undistort",
            "",
            "images without distortion, as the map's camera; otherwise as delivered where the form "
            "has a model of the lens"},
           {"--frames",
            "keyframes|all|every:N",
            "which frames are images: the keyframes, all frames with a pose as well, or every N-th "
            "of these (keyframes); needs --images"},
           {"--trajectory",
            "FILE",
            "the poses of the frames between keyframes (trajectory.txt beside the map)"},
           {"--model", "text|binary|both", "files of a COLMAP model (both)"}}};
}

struct ExportRequest {
  ExportFormat format = ExportFormat::kPly;
  std::filesystem::path out;
  std::optional<std::filesystem::path> images;
  DatasetOptions images_options;
  int every = 0;                                    // ParseExportedFrames
  std::optional<std::filesystem::path> trajectory;  // nullopt: that beside the map
  bool undistort = false;
  ColmapFiles colmap_files = ColmapFiles::kBoth;
};

void RefuseWithout(const CommandLine& line, const char* option, bool fits, const char* where) {
  if (line.Has(option) && !fits) {
    throw InputError(std::string(option) + ": goes with " + where + " only");
  }
}

ExportRequest ReadExportRequest(const CommandLine& line) {
  const auto to = line.Value("--to");
  const auto out = line.Value("--out");
  if (!to) throw InputError("map export: expected --to ply|obj|dxf|tum|colmap|nerfstudio");
  if (!out) throw InputError("map export: expected --out PATH");
  ExportRequest request;
  request.format = ParseChoice<ExportFormat>("--to", *to);
  request.out = *out;
  const bool colmap = request.format == ExportFormat::kColmap;
  RefuseWithout(line, "--format", line.Has("--images"), "--images");
  RefuseWithout(line, "--topic", line.Has("--images"), "--images");
  RefuseWithout(line, "--camera", line.Has("--images"), "--images");
  RefuseWithout(line, "--rotate", line.Has("--images"), "--images");
  RefuseWithout(line, "--view-angle", line.Has("--images"), "--images");
  RefuseWithout(line, "--model", colmap, "--to colmap");
  if (const auto images = line.Value("--images")) request.images = *images;
  if (const auto text = line.Value("--format"); text && *text != "auto") {
    request.images_options.format = ParseChoice<DatasetFormat>("--format", *text);
  }
  request.images_options.topics = line.Values("--topic");
  request.images_options.camera = line.Value("--camera");
  request.images_options.rotate = ReadRotation(line);
  request.images_options.view_angle_deg = ReadViewAngle(line);
  if (const auto text = line.Value("--model")) {
    request.colmap_files = ParseChoice<ColmapFiles>("--model", *text);
  }
  if (const auto text = line.Value("--frames")) request.every = ParseExportedFrames(*text);
  if (const auto file = line.Value("--trajectory")) request.trajectory = *file;
  RefuseWithout(line, "--trajectory", request.every > 0, "--frames all and --frames every:N");
  request.undistort = line.Has("--undistort");
  CheckExport(request.format, request.images.has_value(), request.every, request.undistort);
  const std::filesystem::path read = line.Positional(0);
  CheckOutput("--out", request.out, {&read, 1}, KindOfExport(request.format));
  if (request.images) CheckApart(request.out, std::array{RunInput{*request.images}});
  return request;
}

// Exports a map of the file.
std::optional<std::string> Export(const CommandLine& line, const ExportRequest& request) {
  const std::string& name = line.Positional(0);
  SavedAtlas atlas = LoadAtlas(name);
  const SlamOptions options = SavedOptionsOrDefault(
      atlas.context,
      name,
      "lines as by default",
      [](const std::string& text) { std::clog << text << '\n'; },
      {},
      ProgramMethods().added);
  const SavedMap saved =
      SavedMapOf(std::move(ChooseMap(line, atlas.atlas)), atlas.context, atlas.file_version);
  MapExport wanted{request.format, request.out};
  wanted.colmap_files = request.colmap_files;
  wanted.undistort = request.undistort;
  wanted.imaging = {atlas.context.camera, atlas.context.octave_scale};
  wanted.line_map = options.mapping.line_map;
  if (request.every > 0) {
    const std::filesystem::path file =
        request.trajectory ? *request.trajectory : TrajectoryBeside(name, saved.map.id());
    wanted.others = FramesBetween(saved, file.string(), ReadTrajectory(file).poses, request.every);
  }
  std::optional<KeyFrameImages> images;
  if (request.images) {
    images.emplace(*request.images, request.images_options, saved);
    wanted.images = &*images;
  }
  return ExportMap(saved, wanted, StopRequested);
}

}  // namespace

int MapExportCommand(std::span<const std::string> arguments) {
  const CommandLine line(MapExportSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(MapExportSyntax());
    return 0;
  }
  const ExportRequest request = ReadExportRequest(line);
  CatchStopSignals();
  const std::optional<std::string> written = Export(line, request);
  if (!written) {
    std::clog << "plumbline: stopped; nothing is written\n";
    return FirstStopSignal()->exit_code;
  }
  std::cout << fmt::format("{}: {}\n", request.out.string(), *written);
  return 0;
}

}  // namespace plumbline
