// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_files.h"

#include "plumbline/base/options.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/geometry_files.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/reprojection.h"
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

void AddTrajectories(const RunResult& result,
                     MapId map,
                     const TrajectoryNames& names,
                     std::vector<RunFile>& files) {
  const auto add = [&](const std::string& name, Trajectory (RunResult::*of)(MapId) const) {
    files.push_back(TumFile(name, [&result, of, map] { return (result.*of)(map); }));
  };
  add(names.final_estimate, &RunResult::FinalTrajectory);
  add(names.causal, &RunResult::CausalTrajectory);
  add(names.keyframes, &RunResult::KeyFrameTrajectory);
}

std::vector<RunFile> TrajectoryFiles(const RunResult& result) {
  std::vector<RunFile> files;
  const auto main = result.MainMap();
  if (!main) {
    const TrajectoryNames names;
    for (const std::string& name : {names.final_estimate, names.causal, names.keyframes}) {
      files.push_back(TumFile(name, [] { return Trajectory(); }));
    }
    return files;
  }
  AddTrajectories(result, *main, TrajectoryNames(), files);
  for (const auto& [id, map] : result.atlas.maps()) {
    if (id == *main) continue;
    AddTrajectories(result, id, TrajectoryNames(id), files);
  }
  // Poses that were reported in a map that another one took in later are in the world of that map.
  for (const auto& [id, joined] : result.atlas.joined()) {
    files.push_back(TumFile(TrajectoryNames(id).causal,
                            [&result, gone = id] { return result.CausalTrajectory(gone); }));
  }
  return files;
}

void WriteCovariances(const RunResult& result,
                      std::optional<MapId> map,
                      const std::filesystem::path& path) {
  std::vector<StampedCovariance> covariances;
  if (map) covariances = result.CausalCovariances(*map);
  WriteFileAtomically(path, FormatCovariances(covariances));
}

// Returns one file beside each of causal poses.
std::vector<RunFile> CovarianceFiles(const RunResult& result) {
  std::vector<RunFile> files;
  const auto add = [&](const TrajectoryNames& names, std::optional<MapId> map) {
    files.push_back({names.covariance, [=, &result](const std::filesystem::path& path) {
                       WriteCovariances(result, map, path);
                     }});
  };
  const auto main = result.MainMap();
  add(TrajectoryNames(), main);
  if (!main) return files;
  for (const auto& [id, map] : result.atlas.maps()) {
    if (id != *main) add(TrajectoryNames(id), id);
  }
  for (const auto& [id, joined] : result.atlas.joined()) add(TrajectoryNames(id), id);
  return files;
}

template <class Format>
RunFile FramesFile(const std::string& name, const RunResult& result, const Format& format) {
  return {name, [=, &result](const std::filesystem::path& path) {
            WriteFileAtomically(path, format(result.frames));
          }};
}

std::vector<Segment3> LinesToSave(const RunResult& result) {
  const auto main = result.MainMap();
  return main ? SegmentsOf(result.LineMap(*main)) : std::vector<Segment3>();
}

void WriteMapPly(const RunResult& result, const std::filesystem::path& path) {
  std::vector<Eigen::Vector3d> points;
  if (const auto main = result.MainMap()) {
    const Map& map = result.atlas.maps().at(*main);
    for (const MapPoint* point : PointsOfKnownDistance(result.context.camera, map)) {
      points.push_back(point->position);
    }
  }
  WritePly(path, points, LinesToSave(result));
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

std::vector<RunFile> PoseFiles(const RunResult& result) {
  std::vector<RunFile> files = TrajectoryFiles(result);
  const auto format = [&result](const FrameLog& frames) {
    return FormatFrames(frames, result.atlas);
  };
  files.push_back(FramesFile("frames.csv", result, format));
  for (RunFile& file : CovarianceFiles(result)) files.push_back(std::move(file));
  return files;
}

RunFile MapFile(const RunResult& result) {
  return {"map.plb", [&result](const std::filesystem::path& path) {
            // Maps that are only read stay as they were, and so does the choice of the active map.
            const MapId active = result.atlas.active_id();
            SaveAtlas(path,
                      result.atlas,
                      result.context,
                      result.read_only ? active : result.MainMap().value_or(active));
          }};
}

std::vector<RunFile> DerivedFiles(const RunResult& result) {
  std::vector<RunFile> files;
  files.push_back(FramesFile("timing.csv", result, FormatTimingCsv));
  files.push_back(FramesFile("timing.json", result, FormatTimingJson));
  files.push_back({"lines.obj", [&result](const std::filesystem::path& path) {
                     WriteObjLines(path, LinesToSave(result));
                   }});
  files.push_back({"lines.dxf", [&result](const std::filesystem::path& path) {
                     WriteDxfLines(path, LinesToSave(result));
                   }});
  files.push_back(
      {"map.ply", [&result](const std::filesystem::path& path) { WriteMapPly(result, path); }});
  return files;
}

}  // namespace plumbline
