// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_files.h"

#include "plumbline/base/options.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/geometry_files.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/timing.h"
#include "plumbline/slam/atlas_context.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

RunFile TumFile(const std::string& name, const std::function<Trajectory()>& make) {
  return {name, [=](const std::filesystem::path& path) { WriteTum(path, make()); }};
}

void AddTrajectories(const System& system,
                     MapId map,
                     const TrajectoryNames& names,
                     std::vector<RunFile>& files) {
  const auto add = [&](const std::string& name, Trajectory (System::*of)(MapId) const) {
    files.push_back(TumFile(name, [&system, of, map] { return (system.*of)(map); }));
  };
  add(names.final_estimate, &System::FinalTrajectory);
  add(names.causal, &System::CausalTrajectory);
  add(names.keyframes, &System::KeyFrameTrajectory);
}

std::vector<RunFile> TrajectoryFiles(const System& system) {
  std::vector<RunFile> files;
  const auto main = system.MainMap();
  if (!main) {
    const TrajectoryNames names;
    for (const std::string& name : {names.final_estimate, names.causal, names.keyframes}) {
      files.push_back(TumFile(name, [] { return Trajectory(); }));
    }
    return files;
  }
  AddTrajectories(system, *main, TrajectoryNames(), files);
  for (const auto& [id, map] : system.maps()) {
    if (id == *main) continue;
    AddTrajectories(system, id, TrajectoryNames(id), files);
  }
  // Poses that were reported in a map that another one took in later are in the world of that map.
  for (const auto& [id, joined] : system.atlas().joined()) {
    files.push_back(TumFile(TrajectoryNames(id).causal,
                            [&system, gone = id] { return system.CausalTrajectory(gone); }));
  }
  return files;
}

void WriteCovariances(const System& system,
                      std::optional<MapId> map,
                      const std::filesystem::path& path) {
  std::vector<StampedCovariance> covariances;
  if (map) covariances = system.CausalCovariances(*map);
  WriteFileAtomically(path, FormatCovariances(covariances));
}

// Returns one file beside each of causal poses.
std::vector<RunFile> CovarianceFiles(const System& system) {
  std::vector<RunFile> files;
  const auto add = [&](const TrajectoryNames& names, std::optional<MapId> map) {
    files.push_back({names.covariance, [=, &system](const std::filesystem::path& path) {
                       WriteCovariances(system, map, path);
                     }});
  };
  const auto main = system.MainMap();
  add(TrajectoryNames(), main);
  if (!main) return files;
  for (const auto& [id, map] : system.maps()) {
    if (id != *main) add(TrajectoryNames(id), id);
  }
  for (const auto& [id, joined] : system.atlas().joined()) add(TrajectoryNames(id), id);
  return files;
}

template <class Format>
RunFile FramesFile(const std::string& name, const System& system, const Format& format) {
  return {name, [=, &system](const std::filesystem::path& path) {
            WriteFileAtomically(path, format(system.frames()));
          }};
}

std::vector<Segment3> LinesToSave(const System& system) {
  const auto main = system.MainMap();
  return main ? SegmentsOf(system.LineMap(*main)) : std::vector<Segment3>();
}

void WriteMapPly(const System& system, const std::filesystem::path& path) {
  std::vector<Eigen::Vector3d> points;
  if (const auto main = system.MainMap()) points = PointPositions(system.maps().at(*main));
  WritePly(path, points, LinesToSave(system));
}

}  // namespace

TrajectoryNames::TrajectoryNames(std::optional<MapId> map) {
  const std::string suffix = map ? fmt::format("_map{}", map->value) : std::string();
  final_estimate = "trajectory" + suffix + ".txt";
  causal = "trajectory_causal" + suffix + ".txt";
  keyframes = "keyframes" + suffix + ".txt";
  covariance = "trajectory_covariance" + suffix + ".txt";
}

std::string FormatCovariances(const std::vector<StampedCovariance>& covariances) {
  std::string text;
  for (const StampedCovariance& pose : covariances) {
    text += FormatStamp(pose.stamp_ns);
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = 0; column < 6; ++column) {
        fmt::format_to(std::back_inserter(text), " {:.12g}", pose.covariance(row, column));
      }
    }
    text += '\n';
  }
  return text;
}

std::string FormatFrameRow(const FrameRecord& f, MapId final_map) {
  const auto name = [](MapId map) {
    return map.valid() ? fmt::format("{}", map.value) : std::string();
  };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n",
                     f.id.value,
                     FormatStamp(f.stamp_ns),
                     NameOf(f.status),
                     name(f.map),
                     f.reason,
                     f.keyframe ? 1 : 0,
                     f.counts.matched_points,
                     f.counts.matched_lines,
                     f.counts.inlier_points,
                     f.counts.inlier_lines,
                     NameOf(f.shed),
                     name(final_map));
}

std::string FormatFrames(const FrameLog& frames, const Atlas& atlas) {
  std::string text =
      "frame,timestamp,state,map,reason,keyframe,matched_points,matched_lines,inlier_points,"
      "inlier_lines,shed,final_map\n";
  for (const FrameRecord& frame : frames) {
    text += FormatFrameRow(frame, atlas.Current(frame.map));
  }
  return text;
}

std::vector<RunFile> PoseFiles(const System& system) {
  std::vector<RunFile> files = TrajectoryFiles(system);
  const auto format = [&system](const FrameLog& frames) {
    return FormatFrames(frames, system.atlas());
  };
  files.push_back(FramesFile("frames.csv", system, format));
  for (RunFile& file : CovarianceFiles(system)) files.push_back(std::move(file));
  return files;
}

RunFile MapFile(const System& system) {
  return {"map.plb", [&system](const std::filesystem::path& path) {
            // Maps that are only read stay as they were, and so does the choice of the active map.
            const MapId active = system.atlas().active_id();
            SaveAtlas(path,
                      system.atlas(),
                      system.Context(),
                      system.read_only() ? active : system.MainMap().value_or(active));
          }};
}

std::vector<RunFile> DerivedFiles(const System& system) {
  std::vector<RunFile> files;
  files.push_back(FramesFile("timing.csv", system, FormatTimingCsv));
  files.push_back(FramesFile("timing.json", system, FormatTimingJson));
  files.push_back({"lines.obj", [&system](const std::filesystem::path& path) {
                     WriteObjLines(path, LinesToSave(system));
                   }});
  files.push_back({"lines.dxf", [&system](const std::filesystem::path& path) {
                     WriteDxfLines(path, LinesToSave(system));
                   }});
  files.push_back(
      {"map.ply", [&system](const std::filesystem::path& path) { WriteMapPly(system, path); }});
  return files;
}

}  // namespace plumbline
