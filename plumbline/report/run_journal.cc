// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_journal.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/run_files.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

constexpr std::chrono::seconds kOftenest(1);

}  // namespace

void RunJournal::Add(const FrameRecord& record) {
  FrameRecord copy = record;
  copy.times.clear();
  const std::lock_guard lock(mutex_);
  added_.push_back(std::move(copy));
}

void RunJournal::TakeIn(const std::vector<FrameRecord>& records) {
  std::map<MapId, Trajectory> causal, keyframes;
  for (FrameRecord record : records) {
    if (record.status == FrameStatus::kTracked) ++maps_[record.map].frames;
    if (const auto& pose = record.causal_world_from_camera) {
      causal[record.map].push_back({record.stamp_ns, *pose});
      if (record.keyframe) keyframes[record.map].push_back({record.stamp_ns, *pose});
    }
    frames_ += FormatFrameRow(record, record.map);
  }
  for (const auto& [map, poses] : causal) maps_[map].causal += FormatTum(poses);
  for (const auto& [map, poses] : keyframes) maps_[map].keyframes += FormatTum(poses);
}

void RunJournal::WriteFiles(RunFolder& folder) {
  MakeFolder(folder.part());
  std::set<std::string> names;
  const auto write = [&](const std::string& name, const std::string& text) {
    WriteFileAtomically(folder.part() / name, text);
    names.insert(name);
  };
  const auto main = std::max_element(maps_.begin(), maps_.end(), [](const auto& a, const auto& b) {
    return a.second.frames < b.second.frames;
  });
  const MapText none;
  write("frames.csv", FormatFrames({}) + frames_);
  write(TrajectoryNames().causal, main == maps_.end() ? none.causal : main->second.causal);
  for (auto map = maps_.begin(); map != maps_.end(); ++map) {
    if (map != main) write(TrajectoryNames(map->first).causal, map->second.causal);
  }
  write(TrajectoryNames().keyframes, main == maps_.end() ? none.keyframes : main->second.keyframes);
  for (auto map = maps_.begin(); map != maps_.end(); ++map) {
    if (map != main) write(TrajectoryNames(map->first).keyframes, map->second.keyframes);
  }
  // The file of a map that has become the main one is not needed any more.
  std::error_code ignored;
  for (const std::string& name : written_) {
    if (!names.contains(name)) std::filesystem::remove(folder.part() / name, ignored);
  }
  written_ = std::move(names);
}

std::optional<std::string> RunJournal::Write(RunFolder& folder) {
  const auto start = Clock::now();
  std::vector<FrameRecord> records;
  {
    const std::lock_guard lock(mutex_);
    records.swap(added_);
  }
  TakeIn(records);
  std::optional<std::string> failure;
  try {
    WriteFiles(folder);
  } catch (const InputError& error) {
    if (!std::exchange(failed_, true)) failure = error.what();
  }
  last_ = Clock::now();
  taken_ = last_ - start;
  return failure;
}

std::optional<std::string> RunJournal::WriteIfDue(RunFolder& folder, Clock::time_point now) {
  constexpr int kShare = 20;
  const auto interval = std::max<Clock::duration>(kShare * taken_, kOftenest);
  if (now - last_ < interval) return std::nullopt;
  return Write(folder);
}

}  // namespace plumbline
