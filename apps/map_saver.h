// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/matching/line_options.h"

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace plumbline {

// Writes copies of a run's maps to a file while the run goes on, in a thread of its own: neither
// tracking nor mapping waits for the disk. The copies are cleaned as the maps are when a run ends
// (RemoveOutliers).
class MapSaver {
 public:
  // The file is replaced whole each time (SaveAtlas). `lines` are the run's options of lines.
  MapSaver(std::filesystem::path file, const LineOptions& lines);
  // Writes what it has begun with, and no more.
  ~MapSaver();
  MapSaver(const MapSaver&) = delete;
  MapSaver& operator=(const MapSaver&) = delete;

  // From any thread. A copy that has not been begun with is left out for this one.
  void Take(SavedAtlas copy);
  // What went wrong with the last copy, once; the next one is tried all the same.
  std::optional<std::string> TakeFailure();

 private:
  void WriteUntilStopped();

  std::filesystem::path file_;
  LineOptions lines_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<SavedAtlas> next_;
  std::optional<std::string> failure_;
  bool stop_ = false;
  std::jthread writer_;  // last, so that it ends first
};

}  // namespace plumbline
