// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/keyframe_tracks.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
namespace {

template <class LandmarkId>
std::vector<LandmarkId> WellObserved(const std::vector<LandmarkId>& matches,
                                     const MapSnapshot& snapshot,
                                     int views) {
  std::vector<LandmarkId> observed(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto* landmark = matches[i].valid() ? snapshot.Find(matches[i]) : nullptr;
    if (landmark != nullptr && landmark->observation_count + 1 >= views) observed[i] = matches[i];
  }
  return observed;
}

template <class LandmarkId>
void AddShared(std::vector<LandmarkId> tracks,
               const std::vector<LandmarkId>* today,
               const std::vector<LandmarkId>& of_frame,
               KeyFrameTracks::Count& count) {
  for (std::size_t i = 0; i < tracks.size() && today != nullptr; ++i) {
    if (tracks[i].valid()) tracks[i] = i < today->size() ? (*today)[i] : LandmarkId{};
  }
  std::erase_if(tracks, [](LandmarkId id) { return !id.valid(); });
  std::sort(tracks.begin(), tracks.end());
  count.shown += static_cast<int>(tracks.size());
  count.shared +=
      static_cast<int>(std::count_if(of_frame.begin(), of_frame.end(), [&](LandmarkId id) {
        return std::binary_search(tracks.begin(), tracks.end(), id);
      }));
}

}  // namespace

KeyFrameTracks::KeyFrameTracks(KeyFrameId keyframe,
                               const Frame& frame,
                               const MapSnapshot& snapshot,
                               int views)
    : keyframe_(keyframe),
      points_(WellObserved(frame.points, snapshot, views)),
      lines_(WellObserved(frame.lines, snapshot, views)) {}

KeyFrameTracks::Count KeyFrameTracks::CountShared(const Frame& frame,
                                                  const MapSnapshot& snapshot) const {
  const bool here = snapshot.centre == keyframe_;
  const Frame& today = snapshot.reference->frame;
  Count count;
  AddShared(points_, here ? &today.points : nullptr, frame.points, count);
  AddShared(lines_, here ? &today.lines : nullptr, frame.lines, count);
  return count;
}

}  // namespace plumbline
