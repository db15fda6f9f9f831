// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_files.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/dxf.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/ply.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/timing.h"

#include <regex>
#include <system_error>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

using TimeMirror = std::optional<std::int64_t>;  // DatasetInfo::time_mirror_ns

std::vector<FrameRecord> AsRecorded(std::vector<FrameRecord> frames, TimeMirror mirror_ns) {
  if (!mirror_ns) return frames;
  for (FrameRecord& frame : frames) frame.stamp_ns = *mirror_ns - frame.stamp_ns;
  return frames;
}

void WriteTrajectories(const System& system,
                       const std::filesystem::path& folder,
                       TimeMirror mirror_ns) {
  const auto write = [&](const std::string& name, const Trajectory& played) {
    WriteTum(folder / name, mirror_ns ? TimeReversed(played, *mirror_ns) : played);
  };
  const auto main = system.MainMap();
  if (!main) {
    for (const char* name : {"trajectory.txt", "trajectory_causal.txt", "keyframes.txt"}) {
      WriteTum(folder / name, {});
    }
    return;
  }
  for (const auto& [id, map] : system.maps()) {
    const std::string suffix = id == *main ? "" : fmt::format("_map{}", id.value);
    write("trajectory" + suffix + ".txt", system.FinalTrajectory(id));
    write("trajectory_causal" + suffix + ".txt", system.CausalTrajectory(id));
    write("keyframes" + suffix + ".txt", system.KeyFrameTrajectory(id));
  }
}

void WriteMap(const System& system, const std::filesystem::path& folder) {
  const auto main = system.MainMap();
  const Map none;
  const Map& map = main ? system.maps().at(*main) : none;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [id, point] : map.points()) points.push_back(point.position);
  std::vector<Segment3> lines;
  if (main) {
    for (const MappedLine& line : system.LineMap(*main)) lines.push_back(line.segment);
  }
  WritePly(folder / "map.ply", points, lines);
  WriteObjLines(folder / "lines.obj", lines);
  WriteDxfLines(folder / "lines.dxf", lines);
  SaveMap(folder / "map.plb", system.camera(), system.rectifier().rectified_left_from_left(), map);
}

// Whether a run writes a file of this name, or of a temporary name that becomes it.
bool IsRunFile(const std::string& name) {
  static const std::regex temporary(R"(\.(.+)\.[0-9]+\.tmp(\.[a-z]+))");
  static const std::regex written(
      R"((trajectory|trajectory_causal|keyframes)(_map[0-9]+)?\.txt|overlay_[0-9]+\.png|)"
      R"(options\.yaml|(frames|timing)\.csv|(timing|summary)\.json|map\.(plb|ply)|lines\.(obj|dxf)|)"
      R"(report\.html)");
  std::smatch parts;
  return std::regex_match(
      std::regex_match(name, parts, temporary) ? parts.str(1) + parts.str(2) : name, written);
}

}  // namespace

void RemoveEarlierRun(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (IsRunFile(entry.path().filename().string())) old.push_back(entry.path());
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  for (const std::filesystem::path& path : old) {
    if (!std::filesystem::remove(path, error) && error) {
      throw InputError("cannot remove " + path.string() + " of an earlier run: " + error.message());
    }
  }
}

std::string FormatFrames(const std::vector<FrameRecord>& frames) {
  std::string text =
      "frame,timestamp,state,map,reason,keyframe,matched_points,matched_lines,inlier_points,"
      "inlier_lines\n";
  for (const FrameRecord& f : frames) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n",
                        f.id.value,
                        FormatStamp(f.stamp_ns),
                        NameOf(f.status),
                        f.map.valid() ? fmt::format("{}", f.map.value) : std::string(),
                        f.reason,
                        f.keyframe ? 1 : 0,
                        f.counts.matched_points,
                        f.counts.matched_lines,
                        f.counts.inlier_points,
                        f.counts.inlier_lines);
  }
  return text;
}

void WriteRunFiles(const System& system,
                   const std::filesystem::path& folder,
                   std::optional<std::int64_t> time_mirror_ns) {
  WriteTrajectories(system, folder, time_mirror_ns);
  const std::vector<FrameRecord> frames = AsRecorded(system.frames(), time_mirror_ns);
  WriteFileAtomically(folder / "frames.csv", FormatFrames(frames));
  WriteFileAtomically(folder / "timing.csv", FormatTimingCsv(frames));
  WriteFileAtomically(folder / "timing.json", FormatTimingJson(frames));
  WriteMap(system, folder);
}

}  // namespace plumbline
