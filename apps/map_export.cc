// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/colmap_folder.h"
#include "plumbline/io/colmap_model.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/dxf.h"
#include "plumbline/io/keyframe_images.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/nerfstudio.h"
#include "plumbline/io/ply.h"
#include "plumbline/io/png.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/keyframe_trajectory.h"
#include "plumbline/mapping/line_map.h"
#include "plumbline/slam/saved_options.h"

#include "apps/chosen_map.h"
#include "apps/command_line.h"
#include "apps/map_commands.h"
#include "apps/stop_signal.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

enum class ExportFormat { kPly, kObj, kDxf, kTum, kColmap, kNerfstudio };
constexpr auto EnumNames(std::type_identity<ExportFormat>) {
  return std::array{std::pair{ExportFormat::kPly, "ply"},
                    std::pair{ExportFormat::kObj, "obj"},
                    std::pair{ExportFormat::kDxf, "dxf"},
                    std::pair{ExportFormat::kTum, "tum"},
                    std::pair{ExportFormat::kColmap, "colmap"},
                    std::pair{ExportFormat::kNerfstudio, "nerfstudio"}};
}

CommandSyntax MapExportSyntax() {
  return {"map export",
          "Writes a map in the form of another program: points and lines (ply), lines (obj, dxf), "
          "the\ntrajectory of the keyframes (tum), or a folder with a sparse model (colmap) or a "
          "data set\n(nerfstudio) with undistorted images.",
          {"FILE"},
          {{"--to", "ply|obj|dxf|tum|colmap|nerfstudio", "the form"},
           {"--out", "PATH", "file, or new folder for colmap and nerfstudio"},
           kMapOption,
           {"--images", "PATH", "the data that the map was made from: its images are written, too"},
           {"--format",
            "auto|euroc|tum|kitti|images|video|bag|mcap|rosbag2",
            "of --images (found out from PATH)"},
           {"--topic", "NAME", "of --images, a bag or an MCAP file; may be repeated"},
           {"--camera", "FILE", "of --images: camera file, or the name of a built-in camera"},
           {"--model", "text|binary|both", "files of a COLMAP model (both)"}}};
}

struct ExportRequest {
  ExportFormat format = ExportFormat::kPly;
  std::filesystem::path out;
  std::optional<std::filesystem::path> images;
  DatasetOptions images_options;
  ColmapFiles colmap_files = ColmapFiles::kBoth;
};

void RefuseWithout(const CommandLine& line, const char* option, bool fits, const char* where) {
  if (line.Has(option) && !fits) {
    throw InputError(std::string(option) + ": goes with " + where + " only");
  }
}

// Whether the first row of a file is as FormatTum writes it: a time and seven numbers, each with
// nine decimals.
bool BeginsAsOurTrajectory(const std::filesystem::path& path) {
  constexpr std::size_t kLongestRow = 400;
  static const std::regex row(R"(-?[0-9]+\.[0-9]{9}( -?[0-9]+\.[0-9]{9}){7})");
  std::ifstream file(path, std::ios::binary);
  std::string start(kLongestRow, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return std::regex_match(start.substr(0, start.find('\n')), row);
}

// Throws InputError where something else than a file of this form would be replaced. Folders have
// to be new or empty.
void CheckOutput(const std::filesystem::path& out, ExportFormat format, const std::string& map) {
  const auto check = [&](const FileKind& kind) { CheckMapOutput("--out", out, {&map, 1}, kind); };
  switch (format) {
    case ExportFormat::kPly:
      return check({"a PLY file by plumbline", "ply\n"});
    case ExportFormat::kObj:
      return check({"lines that were exported", "# Plumbline line segments"});
    case ExportFormat::kDxf:
      return check({"a DXF file by plumbline", "0\nSECTION\n"});
    case ExportFormat::kTum:
      return check({"a trajectory by plumbline", "", &BeginsAsOurTrajectory});
    case ExportFormat::kColmap:
    case ExportFormat::kNerfstudio:
      return check({"a folder", {}});
  }
  throw BugError("a form without a kind of file");
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
  const bool with_images = colmap || request.format == ExportFormat::kNerfstudio;
  RefuseWithout(line, "--images", with_images, "--to colmap and --to nerfstudio");
  RefuseWithout(line, "--format", line.Has("--images"), "--images");
  RefuseWithout(line, "--topic", line.Has("--images"), "--images");
  RefuseWithout(line, "--camera", line.Has("--images"), "--images");
  RefuseWithout(line, "--model", colmap, "--to colmap");
  if (const auto images = line.Value("--images")) request.images = *images;
  if (const auto text = line.Value("--format"); text && *text != "auto") {
    request.images_options.format = ParseChoice<DatasetFormat>("--format", *text);
  }
  request.images_options.topics = line.Values("--topic");
  request.images_options.camera = line.Value("--camera");
  if (const auto text = line.Value("--model")) {
    request.colmap_files = ParseChoice<ColmapFiles>("--model", *text);
  }
  if (request.format == ExportFormat::kNerfstudio && !request.images) {
    throw InputError(
        "--to nerfstudio: expected --images PATH, the data that the map was made from: a data set "
        "of nerfstudio consists of images");
  }
  CheckOutput(request.out, request.format, line.Positional(0));
  return request;
}

// A signal has asked to stop before there was anything whole to write.
struct Stopped {};

void StopIfAsked() {
  if (StopRequested()) throw Stopped{};
}

// What is written: a map of the file, and how its lines are told.
struct ExportedMap {
  SavedMap saved;
  ImagingModel imaging;
  LineMapOptions line_map;
};

ExportedMap LoadExportedMap(const CommandLine& line) {
  const std::string& name = line.Positional(0);
  SavedAtlas saved = LoadAtlas(name);
  const AtlasContext& context = saved.context;
  const SlamOptions options =
      SavedOptionsOrDefault(context, name, "lines as by default", [](const std::string& text) {
        std::cerr << text << '\n';
      });
  return {SavedMapOf(std::move(ChooseMap(line, saved.atlas)), context, saved.file_version),
          {context.camera, context.octave_scale},
          options.mapping.line_map};
}

// The lines that a run gives out, too.
std::vector<Segment3> LinesOf(const ExportedMap& map) {
  std::vector<Segment3> segments =
      SegmentsOf(MakeLineMap(map.saved.map, map.imaging, map.line_map, StopRequested));
  StopIfAsked();
  return segments;
}

// Writes the image of each keyframe into a folder. Returns the mean grey of each point in them.
PointGreys WriteImages(const SavedMap& saved,
                       const KeyFrameImages& images,
                       const std::map<KeyFrameId, std::string>& names,
                       const std::filesystem::path& folder) {
  MakeFolder(folder);
  std::map<PointId, std::pair<int, int>> sums;  // of greys, and their number
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    StopIfAsked();
    const GrayImage image = images.Read(keyframe);
    WriteGrayPng(folder / names.at(id), image);
    const Frame& frame = keyframe.frame;
    const Features measured = MeasuredFeatures(*frame.indexed);
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (!frame.points[i].valid()) continue;
      const Eigen::Vector2d& px = measured.points[i].px;
      const auto x = std::clamp<long>(std::lround(px.x()), 0, image.width() - 1);
      const auto y = std::clamp<long>(std::lround(px.y()), 0, image.height() - 1);
      auto& [sum, count] = sums[frame.points[i]];
      sum += image.at(static_cast<int>(x), static_cast<int>(y));
      ++count;
    }
  }
  PointGreys greys;
  for (const auto& [id, sum] : sums) {
    greys[id] = static_cast<std::uint8_t>(sum.first / sum.second);
  }
  return greys;
}

// WriteColmapFolder, and images/ where there are any.
void ExportColmap(const SavedMap& saved, const ExportRequest& request) {
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  std::optional<KeyFrameImages> images;
  if (request.images) images.emplace(*request.images, request.images_options, saved);
  AtomicFolder folder(request.out);
  PointGreys greys;
  if (images) greys = WriteImages(saved, *images, names, folder.temporary_path() / "images");
  const ColmapModel model = MakeColmapModel(saved, names, greys);
  WriteColmapFolder(folder.temporary_path(), saved.map, model, names, request.colmap_files);
  folder.Commit();
  const std::size_t left_out = saved.map.points().size() - model.points.size();
  std::cout << fmt::format(
      "{}: {} images{}, {} points{}, {} lines\n",
      request.out.string(),
      model.images.size(),
      images ? "" : " (not written; --images PATH writes them)",
      model.points.size(),
      left_out == 0 ? std::string() : fmt::format(" ({} of one image left out)", left_out),
      saved.map.lines().size());
}

void ExportNerfstudio(const SavedMap& saved, const ExportRequest& request) {
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  const KeyFrameImages images(*request.images, request.images_options, saved);
  AtomicFolder folder(request.out);
  const PointGreys greys = WriteImages(saved, images, names, folder.temporary_path() / "images");
  std::vector<std::uint8_t> brightness;
  for (const auto& [id, point] : saved.map.points()) brightness.push_back(greys.at(id));
  WritePly(folder.temporary_path() / "points.ply", PointPositions(saved.map), {}, brightness);
  WriteNerfstudioTransforms(
      folder.temporary_path() / "transforms.json", saved, "images", names, "points.ply");
  folder.Commit();
  std::cout << fmt::format(
      "{}: {} images, {} points\n", request.out.string(), names.size(), saved.map.points().size());
}

void ExportFile(const ExportedMap& map, const ExportRequest& request) {
  const SavedMap& saved = map.saved;
  const std::string out = request.out.string();
  if (request.format == ExportFormat::kTum) {
    const Trajectory trajectory = KeyFrameTrajectory(saved.map, saved.rectified_from_left);
    WriteTum(request.out, trajectory);
    const std::size_t left_out = saved.map.keyframes().size() - trajectory.size();
    std::cout << fmt::format(
        "{}: {} keyframes{}\n",
        out,
        trajectory.size(),
        left_out == 0 ? std::string() : fmt::format(" ({} of the same times left out)", left_out));
    return;
  }
  const std::vector<Segment3> lines = LinesOf(map);
  std::string what;
  if (request.format == ExportFormat::kPly) {
    WritePly(request.out, PointPositions(saved.map), lines);
    what = fmt::format("{} points, ", saved.map.points().size());
  } else if (request.format == ExportFormat::kObj) {
    WriteObjLines(request.out, lines);
  } else {
    WriteDxfLines(request.out, lines);
  }
  std::cout << fmt::format("{}: {}{} lines\n", out, what, lines.size());
}

void Export(const ExportedMap& map, const ExportRequest& request) {
  StopIfAsked();
  if (request.format == ExportFormat::kColmap) {
    ExportColmap(map.saved, request);
  } else if (request.format == ExportFormat::kNerfstudio) {
    ExportNerfstudio(map.saved, request);
  } else {
    ExportFile(map, request);
  }
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
  try {
    Export(LoadExportedMap(line), request);
  } catch (const Stopped&) {
    std::cerr << "plumbline: stopped; nothing is written\n";
    return FirstStopSignal()->exit_code;
  }
  return 0;
}

}  // namespace plumbline
