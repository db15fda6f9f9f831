// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map_saver.h"

#include "plumbline/io/map_file/map_io.h"
#include "plumbline/mapping/landmark_culling.h"

#include <exception>
#include <utility>

namespace plumbline {

namespace {

void CleanMaps(const LineSettings& lines, SavedAtlas& saved) {
  const CameraAndPyramid imaging{saved.context.camera, saved.context.octave_scale};
  for (const auto& [id, map] : saved.atlas.maps()) {
    saved.atlas.Find(id)->Apply(RemoveOutliers(map, imaging, lines));
  }
}

}  // namespace

MapSaver::MapSaver(std::filesystem::path file, const LineSettings& lines)
    : file_(std::move(file)), lines_(lines), writer_([this] { WriteUntilStopped(); }) {}

MapSaver::~MapSaver() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  changed_.notify_all();
}

void MapSaver::Take(SavedAtlas copy) {
  const std::lock_guard lock(mutex_);
  next_ = std::move(copy);
  changed_.notify_all();
}

std::optional<std::string> MapSaver::TakeFailure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

void MapSaver::WriteUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || next_.has_value(); });
    if (stop_) return;
    SavedAtlas copy = *std::exchange(next_, std::nullopt);
    lock.unlock();
    std::optional<std::string> failure;
    try {
      CleanMaps(lines_, copy);
      SaveAtlas(file_, copy.atlas, copy.context);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    if (failure) failure_ = std::move(failure);
  }
}

}  // namespace plumbline
