// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_journal.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/run_files.h"

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

constexpr std::chrono::seconds kInterval(1);

// Appends rows to a file, all of them or none.
void AppendRows(const std::filesystem::path& path, const std::string& rows) {
  std::error_code none;
  const std::uintmax_t before =
      std::filesystem::exists(path, none) ? std::filesystem::file_size(path, none) : 0;
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << rows << std::flush;
  if (file) return;
  const std::error_code why(errno, std::generic_category());
  file.close();
  std::filesystem::resize_file(path, before, none);
  throw WriteError(path, why);
}

}  // namespace

RunJournal::RunJournal() {
  const TrajectoryNames names;
  new_ = {{"frames.csv", FormatFrames({})}, {names.causal, ""}, {names.keyframes, ""}};
}

void RunJournal::Add(const FrameRecord& record) {
  const std::lock_guard lock(mutex_);
  new_["frames.csv"] += FormatFrameRow(record, record.map);
  const auto& pose = record.causal_world_from_camera;
  if (!pose) return;
  if (!first_) first_ = record.map;
  const TrajectoryNames names =
      record.map == *first_ ? TrajectoryNames() : TrajectoryNames(record.map);
  const std::string row = FormatTum({{record.stamp_ns, *pose}});
  new_[names.causal] += row;
  if (record.keyframe) new_[names.keyframes] += row;
}

std::optional<std::string> RunJournal::Write(RunFolder& folder) {
  Rows rows;
  {
    const std::lock_guard lock(mutex_);
    rows.swap(new_);
  }
  last_ = Clock::now();
  try {
    MakeFolder(folder.part());
    for (; !rows.empty(); rows.erase(rows.begin())) {
      AppendRows(folder.part() / rows.begin()->first, rows.begin()->second);
    }
  } catch (const InputError& error) {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, text] : rows) new_[name].insert(0, text);
    if (!std::exchange(failed_, true)) return error.what();
  }
  return std::nullopt;
}

std::optional<std::string> RunJournal::WriteIfDue(RunFolder& folder, Clock::time_point now) {
  return now - last_ < kInterval ? std::nullopt : Write(folder);
}

}  // namespace plumbline
