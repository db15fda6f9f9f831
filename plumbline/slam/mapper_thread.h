// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/map_events.h"
#include "plumbline/slam/mapper.h"
#include "plumbline/slam/snapshot_schedule.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace plumbline {

// A keyframe dropped by mapping for lack of time or memory. Its frame becomes an ordinary frame,
// and frames that refer to the keyframe refer to its parent from now on.
struct DroppedKeyFrame {
  KeyFrameId id;
  FrameId frame;
  KeyFrameId parent;
  RelativePose from_parent;
};

// Runs the mapper concurrently with tracking: queues its commands, executes them in a thread, and
// gives each frame its due snapshot (SnapshotSchedule).
//   inline    The work is done in the caller's thread, when the snapshot is requested.
//   lockstep  A thread begins the work as soon as a command comes, and the caller waits for exactly
//             the snapshot that the frame is due. The bytes are those of inline.
//   live      The caller waits only for the first keyframe of a map. It gets the newest snapshot,
//             with the keyframes not yet mapped (WithPendingKeyFrames), so that tracking always
//             has a map that reaches the camera. At most kMaxWaiting keyframes may wait; if one
//             more comes, the keyframe that adds least to the map is dropped.
//
// All functions are for one thread, the tracker's, except as stated.
class MapperThread {
 public:
  static constexpr std::size_t kMaxWaiting = 4;   // most keyframes that may wait in a live run
  static constexpr std::size_t kEarlierKept = 8;  // most earlier snapshots that a live run keeps

  MapperThread(const CameraAndPyramid& imaging,
               const SlamOptions& options,
               const Execution& execution = {},
               const SystemMethods& methods = {});
  // Drops all tasks that have not begun.
  ~MapperThread();
  MapperThread(const MapperThread&) = delete;
  MapperThread& operator=(const MapperThread&) = delete;

  // Submits a keyframe, which opens a new map if `starts_map`. Frames count from 0. Returns the
  // keyframe dropped in favour of this one, if any.
  std::optional<DroppedKeyFrame> Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map);
  // Submits several keyframes that open a new map.
  void Submit(std::int64_t frame, InitialMapEdit start);
  // Submits a lost frame. TakeRelocalization() returns the result from the frame on whose snapshot
  // would have a keyframe of this frame.
  void Submit(std::int64_t frame, RelocalizationRequest request);
  // Submits the switch to an earlier map. The caller also calls Use() with a snapshot of that map.
  void Submit(std::int64_t frame, SwitchMap back);
  // Submits the landmarks that the camera sees. The snapshot becomes that around the keyframe with
  // most of them.
  void Submit(std::int64_t frame, UpdateLocalMapRequest request);
  void Submit(std::int64_t frame, MapReader reader);

  // Moves the maps of this mapper's atlas, or of a copy of it, each as a whole, so that the first
  // keyframe has its pose from before the map was adjusted to a lens: the world is the camera of
  // that keyframe. May be called when atlas() may be, or in a MapReader.
  void MoveFirstKeyFramesBack(Atlas& atlas) const { mapper_.MoveFirstKeyFramesBack(atlas); }

  // Begins with existing maps, one of them active, and the mapper's state of them. To be called
  // before anything is submitted.
  void Continue(Atlas atlas, const LocalMapper::State& state);

  // Waits until all submitted tasks are done. Rethrows exceptions of mapping.
  void WaitUntilDone() { WaitFor(submitted_); }

  // Sets the observer, which is called in the mapping thread. To be called before the first task.
  void Observe(PlaceObserver observer) { mapper_.Observe(std::move(observer)); }

  // Returns the result of a relocalization, once, if it is due at the frame of the last
  // SnapshotFor().
  std::optional<RelocalizationOutcome> TakeRelocalization();
  // Makes SnapshotFor() return this snapshot until a newer one is due.
  void Use(const std::shared_ptr<const MapSnapshot>& snapshot);

  // Returns the map around its newest keyframe, as due at `frame`; null before the first keyframe.
  // Rethrows exceptions of mapping.
  std::shared_ptr<const MapSnapshot> SnapshotFor(std::int64_t frame);

  // Live runs: returns a snapshot of the current map older than the newest one, without pending
  // keyframes. Each call returns an older one, and after the oldest the newest of them again. Null
  // if there is none.
  std::shared_ptr<const MapSnapshot> EarlierSnapshot();

  // Returns the number of tasks that mapping has not begun, without MapReaders.
  std::size_t Waiting() const;

  // Sets the work that mapping leaves out for keyframes begun from now on; initially none.
  void Lighten(LoadLevel shed);

  // Executes the next task in the caller's thread; returns false if none waits. For live runs
  // without threads (Execution).
  bool WorkOnce();

  // Executes all remaining tasks and adjusts each map as a whole (`stop` ends the adjustment
  // early). Maps that were adjusted to a lens are moved back to their world. Afterwards no keyframe
  // may be added to a map that is tracked against. Rethrows exceptions of mapping.
  void Finish(const StopCheck& stop = {});

  // The maps; none before the first keyframe. With a thread, atlas(), maps(), adjusted_lines(),
  // events() and mapper_state() may be called only after Finish (BugError). If Finish threw, the
  // maps are as mapping left them: the keyframe being inserted may be missing, but each change of a
  // map, and each start of one, was atomic (Map::Undo).
  const Atlas& atlas() const;
  const std::map<MapId, Map>& maps() const { return atlas().maps(); }
  // Takes the maps out, as the last step of a run; afterwards there are none.
  Atlas TakeAtlas();

  // Returns the keyframes not mapped because mapping failed, the newest first; none before a
  // failure. Keyframes that start maps are left out, since they have no parent.
  std::vector<DroppedKeyFrame> NotMapped() const;

  // Number and memory of the lines in local bundle adjustment.
  const AdjustedLines& adjusted_lines() const;

  // Closed loops and merged maps.
  MapEvents events() const;
  // Returns the loops and merges of finished steps of mapping after those already known; costs
  // nothing if there are none. May be called at any time and in any thread. The number of finished
  // steps depends on the machine's speed, their order does not.
  MapEvents EventsSince(MapEventCounts& known) const;

  // The mapper's state of the maps.
  LocalMapper::State mapper_state() const;

  // Returns the times of mapping steps since the last call.
  std::vector<MappingStep> TakeTimes();

 private:
  // A command with its number. Tasks are numbered from 1 in the order of submission.
  struct Task {
    std::int64_t number = 0;
    MapCommand command;
  };
  struct PublishedSnapshot {
    std::int64_t task = 0;  // the last task whose result is in the snapshot
    std::shared_ptr<const MapSnapshot> snapshot;
  };
  struct Outcome {
    std::int64_t task = 0;
    RelocalizationOutcome outcome;
  };
  void Submit(MapCommand command);
  void ForgetEarlierSnapshots();
  std::optional<DroppedKeyFrame> GiveUpOne();
  std::shared_ptr<const MapSnapshot> NewestSnapshot();
  void WaitFor(std::int64_t task);
  void WorkUntilStopped();
  void CheckMappingDone() const;
  void TryNext(std::unique_lock<std::mutex>& lock);
  void ProcessNext(std::unique_lock<std::mutex>& lock);
  std::int64_t LastDone() const { return versions_.back().task; }

  RunMode mode_;
  RectifiedCamera camera_;
  LandmarkCreationOptions creation_;
  // State of the tracker's thread.
  std::int64_t submitted_ = 0;
  SnapshotSchedule schedule_;
  std::int64_t map_begins_ = 0;  // task that began the map in use
  // Earlier snapshots of a live run, the newest first.
  std::deque<std::shared_ptr<const MapSnapshot>> kept_;
  std::size_t next_kept_ = 0;
  // In a live run: newest snapshot, the same with the pending keyframes, and these keyframes.
  std::shared_ptr<const MapSnapshot> base_, with_ahead_;
  std::vector<std::shared_ptr<const NewKeyFrame>> ahead_;
  // Used by the worker; by other threads only while no task is being done.
  Mapper mapper_;
  // State that both threads use, guarded by mutex_.
  mutable std::mutex mutex_;
  std::condition_variable task_added_, task_done_;
  std::deque<Task> tasks_;
  std::shared_ptr<const NewKeyFrame> begun_;  // keyframe being inserted
  LoadLevel shed_ = LoadLevel::kNothing;
  // Snapshots from the current one on. The first belongs to no task, so that none is in use before
  // it is due.
  std::deque<PublishedSnapshot> versions_{{}};
  std::vector<MappingStep> times_;
  std::deque<Outcome> outcomes_;  // results not taken yet
  MapEvents events_;              // source of EventsSince()
  std::exception_ptr failure_;
  bool stop_ = false;
  // Does not run in inline mode and step by step. Declared last: ends before the members it uses.
  std::jthread worker_;
};

}  // namespace plumbline
