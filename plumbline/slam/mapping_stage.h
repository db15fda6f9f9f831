// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/background_adjustment.h"
#include "plumbline/slam/execution.h"
#include "plumbline/slam/load_shedding.h"
#include "plumbline/slam/map_start.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/place_recognition.h"
#include "plumbline/tracking/relocalization.h"
#include "plumbline/tracking/tracker.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// A keyframe that mapping had no time for. The frame that it was made of is an ordinary one, and
// what moves with it moves with its parent.
struct DemotedKeyFrame {
  KeyFrameId id;
  FrameId frame;
  KeyFrameId parent;
  RelativePose from_parent;
};

// A lost frame, to be found in one of the maps by its looks.
struct RelocalizationRequest {
  Frame frame;
};
struct RelocalizationOutcome {
  std::optional<Relocalized> found;
  std::shared_ptr<const MapSnapshot> snapshot;  // around the keyframe that showed the way
};

// The lost camera goes on in this map, which was left before: from now on this is the one that
// grows.
struct MapReturn {
  MapId map;
  KeyFrameId keyframe;  // that the camera is beside
};

// The landmarks that the camera sees, when it leaves the surroundings that the snapshot shows.
struct Sighting {
  MapId map;
  std::vector<PointId> points;
  std::vector<LineId> lines;
};

// Somebody who wants to see the maps as they are between two keyframes, in the thread that maps.
struct Visit {
  std::function<void(const Atlas&, const LocalMapper&, const PlaceRecognition&)> look;
};

// The owner and only writer of the maps. Takes keyframes from the tracker and hands out snapshots.
//
// When a keyframe takes effect is part of the algorithm, not of the machine's speed: one made at
// frame f is in the snapshot from frame f + 1 + lag on, the start of a map at once. Inline, the
// work is done when the snapshot is asked for, in the caller's thread. In lockstep a thread of its
// own begins as soon as a keyframe comes, and the caller waits for exactly the snapshot that the
// frame is due: the same bytes. Live, the caller waits only for the first keyframe of a map, and
// gets the newest snapshot there is with the keyframes that are not in it yet (WithKeyFramesAhead):
// tracking always has a map that reaches it. kMaxWaiting of them may wait; when one more comes, the
// one that the map loses least without is given up.
//
// A map whose shape has changed at large is adjusted as a whole beside all that
// (BackgroundAdjustment). What this finds is applied before the first task that was submitted when
// it was due, to the map as it is then (Rebased), and shows in that task's snapshot.
//
// A young map of one camera whose unit runs away is withdrawn (PlaceRecognition::Withdraws): its
// snapshots say so from then on.
//
// All functions are for one thread, the tracker's.
class MappingStage {
 public:
  static constexpr std::size_t kMaxWaiting = 4;   // keyframes, live
  static constexpr std::size_t kEarlierKept = 8;  // snapshots, live

  MappingStage(const ImagingModel& imaging,
               const SlamOptions& options,
               const Execution& execution = {});
  // Leaves undone what has not begun.
  ~MappingStage();
  MappingStage(const MappingStage&) = delete;
  MappingStage& operator=(const MappingStage&) = delete;

  // Opens a new map when `starts_map`; frames count from 0. Returns the keyframe that was given up
  // for this one.
  std::optional<DemotedKeyFrame> Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map);
  // Opens a new map that begins with several keyframes.
  void Submit(std::int64_t frame, MapStart start);
  // The outcome is there when a keyframe of this frame would be in the snapshot.
  void Submit(std::int64_t frame, RelocalizationRequest request);
  // Beside Use() of a snapshot of that map.
  void Submit(std::int64_t frame, MapReturn back);
  // The snapshot is then that around the keyframe that shows most of what is seen.
  void Submit(std::int64_t frame, Sighting sighting);
  void Submit(std::int64_t frame, Visit visit);

  // Begins with maps that there are already, one of them active, and what mapping remembered of it,
  // before anything is submitted.
  void Continue(Atlas atlas, const LocalMapper::State& mapper);

  // All that it goes on from beside its maps, once everything that was submitted is done: what
  // tracking is to see of that, and from which frame on.
  struct Checkpoint;
  // Completes all work that is left; the frames of before see as little of it as they would
  // without. Changes no result but of live runs, which see it sooner. Rethrows what mapping threw.
  Checkpoint Save();
  // In place of Continue: goes on as the stage with these maps would that gave the checkpoint.
  // Throws InputError where no stage can have given it.
  void Resume(Atlas atlas, const Checkpoint& checkpoint);

  // Before the first task; the observer is called in the thread that maps.
  void Observe(PlaceObserver observer) { places_.Observe(std::move(observer)); }

  // The outcome of a relocalization that the frame of the last SnapshotFor() may know, once.
  std::optional<RelocalizationOutcome> TakeRelocalization();
  // From now on SnapshotFor() gives this one until a newer one is due.
  void Use(const std::shared_ptr<const MapSnapshot>& snapshot);

  // The map around its newest keyframe as frame `frame` may know it; null before the first
  // keyframe. Rethrows what mapping threw.
  std::shared_ptr<const MapSnapshot> SnapshotFor(std::int64_t frame);

  // Live: one of the last snapshots of the map in use before the newest, without keyframes ahead;
  // from call to call an older one, then again from the first. Null where there is none.
  std::shared_ptr<const MapSnapshot> EarlierSnapshot();

  // Tasks that mapping has not begun with, but for visits, which are nothing to it.
  std::size_t Waiting() const;

  // What is shed of the keyframes that mapping begins with from now on; nothing before the first
  // call.
  void Lighten(Shed shed);

  // Takes in the next keyframe, in the caller's thread; false when none waits. For live runs
  // without threads (Execution).
  bool WorkOnce();

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

  // Loops that were closed and maps that were joined, like atlas().
  MapEvents events() const;
  // The same as far as the steps of mapping that have ended tell, at any time and in any thread:
  // which steps these are depends on the machine's speed, their order does not.
  MapEvents EventsSoFar() const;

  // What mapping remembers, like atlas().
  LocalMapper::State mapper_state() const;

  // Time of the mapping steps done since the last call.
  std::vector<MappingStep> TakeTimes();

 private:
  using Work = std::variant<std::shared_ptr<const NewKeyFrame>,
                            MapStart,
                            RelocalizationRequest,
                            MapReturn,
                            Sighting,
                            Visit>;
  // Something to be taken in. Tasks are numbered from 1 in the order of submission.
  struct Task {
    std::int64_t number = 0;
    std::int64_t frame = 0;  // at which it was submitted
    Work work;
    bool starts_map = false;
  };
  struct Due {
    std::int64_t frame = 0;  // the first that is to see it
    std::int64_t task = 0;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.frame, self.task);
    }
  };
  struct Version {
    std::int64_t task = 0;  // the last one in it
    std::shared_ptr<const MapSnapshot> snapshot;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.task, self.snapshot);
    }
  };
  struct Outcome {
    std::int64_t task = 0;
    RelocalizationOutcome outcome;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.task, self.outcome);
    }
  };
  // What a task did.
  struct Done {
    std::shared_ptr<const MapSnapshot> snapshot;  // null: the one before stays
    std::vector<MappingStep> times;
    std::optional<RelocalizationOutcome> relocalization;
  };

  void Submit(std::int64_t frame, Work work, bool starts_map);
  std::optional<DemotedKeyFrame> GiveUpOne();
  std::shared_ptr<const MapSnapshot> NewestSnapshot();
  void WaitFor(std::int64_t task);
  void WorkUntilStopped();
  void CheckComplete() const;
  static void CheckFits(const Atlas& atlas, const Checkpoint& c);
  void TryNext(std::unique_lock<std::mutex>& lock);
  void DoNext(std::unique_lock<std::mutex>& lock);
  // `frame`: at which the task was submitted.
  Done Do(const std::shared_ptr<const NewKeyFrame>& added, std::int64_t frame);
  Done Do(const MapStart& start, std::int64_t frame);
  Done Do(const RelocalizationRequest& request, std::int64_t frame);
  Done Do(const MapReturn& back, std::int64_t frame);
  Done Do(const Sighting& sighting, std::int64_t frame);
  Done Do(const Visit& visit, std::int64_t frame);
  void Recognize(KeyFrameId id, std::int64_t frame, std::vector<MappingStep>& times);
  void FollowJoins();
  void TakeCorrection(std::int64_t frame);
  std::shared_ptr<const MapSnapshot> TakeSnapshotAround(const Map& map, KeyFrameId centre);
  std::int64_t LastDone() const { return versions_.back().task; }

  RunMode mode_;
  std::int64_t lag_;
  RectifiedCamera camera_;
  MappingOptions mapping_options_;
  // The tracker's side.
  std::int64_t submitted_ = 0;
  std::deque<Due> dues_;  // of tasks later than the one last asked for; live: of first keyframes
  std::int64_t map_begins_ = 0;                          // with this task
  std::deque<std::shared_ptr<const MapSnapshot>> kept_;  // live: earlier ones, the newest first
  std::size_t next_kept_ = 0;
  // Live: the newest version and what was made of it.
  std::shared_ptr<const MapSnapshot> base_, with_ahead_;
  std::vector<std::shared_ptr<const NewKeyFrame>> ahead_;
  // The worker's side.
  LocalMapper mapper_;
  Relocalizer relocalizer_;
  PlaceRecognition places_;
  Atlas atlas_;
  std::set<MapId> changed_;         // since the maps were loaded or last adjusted as a whole
  std::deque<KeyFrameId> centres_;  // of the last snapshots
  BackgroundAdjustment adjustment_;
  // Between the two, guarded by mutex_.
  mutable std::mutex mutex_;
  std::condition_variable task_added_, task_done_;
  std::deque<Task> tasks_;
  std::shared_ptr<const NewKeyFrame> begun_;  // being taken in
  Shed shed_ = Shed::kNothing;
  // From the one in use on; at first that of no task, so that nothing is in use before it is due.
  std::deque<Version> versions_{{}};
  std::vector<MappingStep> times_;
  std::deque<Outcome> outcomes_;  // not taken yet
  MapEvents events_;              // EventsSoFar
  std::exception_ptr failure_;
  bool stop_ = false;
  std::jthread worker_;  // none inline and step by step; last, so that it ends first
};

struct MappingStage::Checkpoint {
  LocalMapper::State mapper;
  std::int64_t submitted = 0;
  std::int64_t map_begins = 0;
  std::deque<Due> dues;
  std::deque<Version> versions;
  std::deque<Outcome> outcomes;
  std::set<MapId> changed;
  std::deque<KeyFrameId> centres;
  std::vector<MappingStep> times;
  Atlas::History history;
  PlaceRecognition::State places;
  std::optional<BackgroundAdjustment::Pending> adjustment;

  // But the mapper's young landmarks and evidence, which are kept with the maps (AtlasContext).
  template <class Self, class Visitor>
  static void VisitState(Self& self, const Visitor& visit) {
    visit(self.mapper.adjusted_lines, self.submitted, self.map_begins, self.dues);
    visit(self.versions, self.outcomes, self.changed, self.centres, self.times);
    visit(self.history, self.places, self.adjustment, self.mapper.stereo_change);
    visit(self.mapper.recent_patches);
  }
};

}  // namespace plumbline
