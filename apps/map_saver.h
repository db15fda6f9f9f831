// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/matching/line_method.h"

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace plumbline {

// Writes copies of a run's maps to a file during the run, in a thread of its own: neither tracking
// nor mapping waits for the disk. Outliers are removed from the copies, as from the maps at the end
// of a run (RemoveOutliers).
class MapSaver {
 public:
  // The file is replaced as a whole each time (SaveAtlas). `lines` are the run's line options.
  MapSaver(std::filesystem::path file, const LineSettings& lines);
  // Completes the current file, and no more.
  ~MapSaver();
  MapSaver(const MapSaver&) = delete;
  MapSaver& operator=(const MapSaver&) = delete;

  // Takes a copy, from any thread. It replaces a copy not yet begun.
  void Take(SavedAtlas copy);
  // Returns the failure of the last copy, once; the next one is tried nevertheless.
  std::optional<std::string> TakeFailure();

 private:
  void WriteUntilStopped();

  std::filesystem::path file_;
  LineSettings lines_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<SavedAtlas> next_;
  std::optional<std::string> failure_;
  bool stop_ = false;
  std::jthread writer_;  // declared last: ends first
};

}  // namespace plumbline
