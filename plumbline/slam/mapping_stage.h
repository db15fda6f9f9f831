// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/map_start.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/tracker.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// The owner and only writer of the maps. Takes keyframes from the tracker and hands out snapshots.
//
// When a keyframe takes effect is part of the algorithm, not of the machine's speed: one made at
// frame f is in the snapshot from frame f + 1 + lag on, the start of a map at once. Inline, the
// work is done when the snapshot is asked for, in the caller's thread. In lockstep a thread of its
// own begins as soon as a keyframe comes, and the caller waits for exactly the snapshot that the
// frame is due: the same bytes. Live, the caller gets the newest snapshot there is and waits only
// for the first keyframe of a map.
//
// All functions are for one thread, the tracker's.
class MappingStage {
 public:
  MappingStage(const ImagingModel& imaging, const SlamOptions& options);
  // Leaves undone what has not begun.
  ~MappingStage();
  MappingStage(const MappingStage&) = delete;
  MappingStage& operator=(const MappingStage&) = delete;

  // Opens a new map when `starts_map`; frames count from 0.
  void Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map);
  // Opens a new map that begins with several keyframes.
  void Submit(std::int64_t frame, MapStart start);

  // The map around its newest keyframe as frame `frame` may know it; null before the first
  // keyframe. Rethrows what mapping threw.
  std::shared_ptr<const MapSnapshot> SnapshotFor(std::int64_t frame);

  // Whether so many keyframes wait that a live tracker should make none it can do without.
  bool Behind() const;

  // Does all work that is left and adjusts each map as a whole (`stop` cuts the adjustment short);
  // no keyframe may follow in a map that is to be tracked against. Rethrows what mapping threw.
  void Finish(const StopCheck& stop = {});

  // None before the first keyframe. With a thread, only after Finish (BugError). After Finish
  // threw, the maps are as mapping left them: a keyframe that was to be taken in may be missing,
  // and the last change may be done by half.
  const Atlas& atlas() const;
  const std::map<MapId, Map>& maps() const { return atlas().maps(); }

  // Like atlas().
  const AdjustedLines& adjusted_lines() const;

  // Time of the mapping steps done since the last call.
  std::vector<MappingStep> TakeTimes();

 private:
  // Something to be taken in. Tasks are numbered from 1 in the order of submission.
  struct Task {
    std::int64_t number = 0;
    std::variant<NewKeyFrame, MapStart> work;
    bool starts_map = false;
  };
  struct Due {
    std::int64_t frame = 0;  // the first that is to see it
    std::int64_t task = 0;
  };
  struct Version {
    std::int64_t task = 0;  // the last one in it
    std::shared_ptr<const MapSnapshot> snapshot;
  };

  void Submit(std::int64_t frame, std::variant<NewKeyFrame, MapStart> work, bool starts_map);
  void WaitFor(std::int64_t task);
  void WorkUntilStopped();
  void CheckComplete() const;
  void TryNext(std::unique_lock<std::mutex>& lock);
  void DoNext(std::unique_lock<std::mutex>& lock);
  std::shared_ptr<const MapSnapshot> TakeSnapshotAround(const Map& map, KeyFrameId centre);
  std::int64_t Done() const { return versions_.empty() ? 0 : versions_.back().task; }

  RunMode mode_;
  std::int64_t lag_;
  // The tracker's side.
  std::int64_t submitted_ = 0;
  std::int64_t finished_ = 0;  // the last one when Finish() adjusted the maps
  std::deque<Due> dues_;  // of tasks later than the one last asked for; live: of first keyframes
  // The worker's side.
  LocalMapper mapper_;
  Atlas atlas_;
  std::deque<KeyFrameId> centres_;  // of the last snapshots of the active map
  // Between the two, guarded by mutex_.
  mutable std::mutex mutex_;
  std::condition_variable task_added_, task_done_;
  std::deque<Task> tasks_;
  std::deque<Version> versions_;  // from the one in use on
  std::vector<MappingStep> times_;
  std::exception_ptr failure_;
  bool stop_ = false;
  std::jthread worker_;  // none inline; last, so that it ends first
};

}  // namespace plumbline
