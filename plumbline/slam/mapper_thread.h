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

// A keyframe that mapping had no time or memory for. The frame that it was made of becomes an
// ordinary frame. Frames that refer to the keyframe refer to its parent from now on.
struct DroppedKeyFrame {
  KeyFrameId id;
  FrameId frame;
  KeyFrameId parent;
  RelativePose from_parent;
};

// Runs the mapper beside tracking: queues its commands, does them in a thread, and gives each frame
// the snapshot that it is due (SnapshotSchedule).
//   inline    The work is done in the caller's thread, when the snapshot is asked for.
//   lockstep  A thread begins the work as soon as a command comes, and the caller waits for exactly
//             the snapshot that the frame is due. The bytes are those of inline.
//   live      The caller waits only for the first keyframe of a map. It gets the newest snapshot,
//             with the keyframes that are not in it yet (WithPendingKeyFrames), so that tracking
//             always has a map that reaches the camera. At most kMaxWaiting keyframes may wait;
//             when one more comes, the one without which the map loses least is given up.
//
// All functions are for one thread, the tracker's, except those that say otherwise.
class MapperThread {
 public:
  static constexpr std::size_t kMaxWaiting = 4;   // most keyframes that may wait in a live run
  static constexpr std::size_t kEarlierKept = 8;  // most earlier snapshots that a live run keeps

  MapperThread(const CameraAndPyramid& imaging,
               const SlamOptions& options,
               const Execution& execution = {});
  // Leaves undone all tasks that have not begun.
  ~MapperThread();
  MapperThread(const MapperThread&) = delete;
  MapperThread& operator=(const MapperThread&) = delete;

  // Submits a keyframe, which opens a new map when `starts_map`. Frames count from 0. Returns the
  // keyframe that was given up for this one, where there is one.
  std::optional<DroppedKeyFrame> Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map);
  // Submits several keyframes that open a new map.
  void Submit(std::int64_t frame, InitialMapEdit start);
  // Submits a lost frame. TakeRelocalization() gives the outcome from the frame on at which a
  // keyframe of this frame would be in the snapshot.
  void Submit(std::int64_t frame, RelocalizationRequest request);
  // Submits the return to an earlier map. The caller also calls Use() with a snapshot of that map.
  void Submit(std::int64_t frame, SwitchMap back);
  // Submits what the camera sees. The snapshot becomes the one around the keyframe that shows most
  // of it.
  void Submit(std::int64_t frame, UpdateLocalMapRequest request);
  void Submit(std::int64_t frame, MapReader reader);

  // Moves the maps of this stage's atlas, or of a copy of it, each as a whole, so that the first
  // keyframe is where it was before the map was adjusted to a lens: the world is the camera of that
  // keyframe. When it may be called: see atlas(), or in a MapReader.
  void MoveFirstKeyFramesBack(Atlas& atlas) const { mapper_.MoveFirstKeyFramesBack(atlas); }

  // Begins with maps that there are already, of which one is active, and with what mapping
  // remembered of them. To be called before anything is submitted.
  void Continue(Atlas atlas, const LocalMapper::State& state);

  // Waits until all that was submitted is done. Rethrows what mapping threw.
  void WaitUntilDone() { WaitFor(submitted_); }

  // Sets the observer, which is called in the thread that maps. To be called before the first task.
  void Observe(PlaceObserver observer) { mapper_.Observe(std::move(observer)); }

  // Returns the outcome of a relocalization, once, when the frame of the last SnapshotFor() may
  // know it.
  std::optional<RelocalizationOutcome> TakeRelocalization();
  // Makes SnapshotFor() give this snapshot until a newer one is due.
  void Use(const std::shared_ptr<const MapSnapshot>& snapshot);

  // Returns the map around its newest keyframe as frame `frame` may know it; null before the first
  // keyframe. Rethrows what mapping threw.
  std::shared_ptr<const MapSnapshot> SnapshotFor(std::int64_t frame);

  // Live runs: returns a snapshot of the map in use from before the newest one, without keyframes
  // ahead. Each call returns an older one, and after the oldest the first again. Null where there
  // is none.
  std::shared_ptr<const MapSnapshot> EarlierSnapshot();

  // Returns the number of tasks that mapping has not begun. Visits do not count.
  std::size_t Waiting() const;

  // Sets what is shed of the keyframes that mapping begins with from now on. Before the first call
  // nothing is shed.
  void Lighten(LoadLevel shed);

  // Does the next task in the caller's thread; returns false when none waits. For live runs
  // without threads (Execution).
  bool WorkOnce();

  // Does all work that is left and adjusts each map as a whole (`stop` cuts the adjustment short).
  // Maps that were adjusted to a lens are moved back to their world. After that no keyframe may be
  // added to a map that is to be tracked against. Rethrows what mapping threw.
  void Finish(const StopCheck& stop = {});

  // The maps; none before the first keyframe. With a thread they may be asked for only after Finish
  // (BugError). After Finish threw, the maps are as mapping left them: a keyframe that was to be
  // taken in may be missing, but each change of a map happened whole or not at all (Map::Undo), and
  // so did the start of a map.
  const Atlas& atlas() const;
  const std::map<MapId, Map>& maps() const { return atlas().maps(); }

  // Returns the keyframes that mapping did not take in because it failed, the newest first; none
  // before it failed. Keyframes that start maps are left out, since nothing is known beside them.
  std::vector<DroppedKeyFrame> NotMapped() const;

  // The lines that local bundle adjustment held in memory. When it may be called: see atlas().
  const AdjustedLines& adjusted_lines() const;

  // Loops that were closed and maps that were joined. When it may be called: see atlas().
  MapEvents events() const;
  // Loops and joins from the steps of mapping that have ended, without those that are known, which
  // costs nothing where there are none. May be called at any time and in any thread. How many steps
  // have ended depends on the machine's speed, their order does not.
  MapEvents EventsSince(MapEventCounts& known) const;

  // What mapping remembers of the maps. When it may be called: see atlas().
  LocalMapper::State mapper_state() const;

  // Returns the times of the mapping steps done since the last call.
  std::vector<MappingStep> TakeTimes();

 private:
  // A command for the mapper. Tasks are numbered from 1 in the order of submission.
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
  // In a live run: the newest snapshot, that snapshot with the keyframes ahead of it, and these.
  std::shared_ptr<const MapSnapshot> base_, with_ahead_;
  std::vector<std::shared_ptr<const NewKeyFrame>> ahead_;
  // Used by the worker; by other threads only while no task is being done.
  Mapper mapper_;
  // State that both threads use, guarded by mutex_.
  mutable std::mutex mutex_;
  std::condition_variable task_added_, task_done_;
  std::deque<Task> tasks_;
  std::shared_ptr<const NewKeyFrame> begun_;  // keyframe that is being taken in
  LoadLevel shed_ = LoadLevel::kNothing;
  // The versions from the one in use on. The first is that of no task, so that nothing is in use
  // before it is due.
  std::deque<PublishedSnapshot> versions_{{}};
  std::vector<MappingStep> times_;
  std::deque<Outcome> outcomes_;  // outcomes that nobody has taken yet
  MapEvents events_;              // what EventsSince() tells of
  std::exception_ptr failure_;
  bool stop_ = false;
  // The thread does not run in inline mode and step by step. It is declared last, so that it ends
  // before what it uses.
  std::jthread worker_;
};

}  // namespace plumbline
