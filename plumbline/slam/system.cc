// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/covariance.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/inertial/gyroscope.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/saved_options.h"
#include "plumbline/slam/system_methods.h"
#include "plumbline/slam/system_stages.h"

#include <exception>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

// The camera's motion between the last two views of a map, as a left tangent per second.
Vector6d LastVelocity(const InitialMap& initial) {
  const InitialView& last = initial.views.back();
  const InitialView& before = initial.views[initial.views.size() - 2];
  const double seconds = 1e-9 * static_cast<double>(last.frame.stamp_ns - before.frame.stamp_ns);
  return LogSe3(last.cam_from_world * Inverse(before.cam_from_world)) / seconds;
}

// Throws InputError unless a loaded map is of this camera.
void CheckSameCamera(const RectifiedCamera& of_map, const RectifiedCamera& now) {
  const bool single = !MeasuresDepth(now);
  if (MeasuresDepth(of_map) == single) {
    const char* one = "one camera";
    const char* metric = "a stereo pair or depth";
    throw InputError(
        fmt::format("expected a map made with {}, as the images are now, found one "
                    "made with {}; go on in it with the same sensor",
                    single ? one : metric,
                    single ? metric : one));
  }
  if (const auto difference = CameraDifference({of_map}, {now})) {
    throw InputError("expected a map of the same rectified camera, found " + *difference);
  }
}

}  // namespace

System::System(const Calibration& calibration,
               const SlamOptions& options,
               const Execution& execution)
    : System(calibration, options, execution, {}) {}

System::System(const Calibration& calibration,
               const SlamOptions& options,
               const Execution& execution,
               const SystemMethods& methods)
    : options_(options),
      execution_(execution),
      stages_(std::make_unique<SystemStages>(calibration, options_, execution_, methods)),
      front_end_(stages_->front_end),
      imaging_(stages_->imaging),
      mapping_(stages_->mapping),
      tracker_(stages_->tracker),
      monocular_initialization_(stages_->monocular_initialization) {
  CheckOptions(options_, methods);
  if (!MeasuresDepth(imaging_.camera)) {
    if (options_.tracking.reference == TrackingReference::kLastFrame) {
      throw InputError(
          "tracking.reference: last_frame needs a camera that measures depth (stereo or RGB-D); "
          "with one camera only local_map works");
    }
    monocular_initialization_ =
        std::make_unique<MonocularInitialization>(imaging_, options_, methods, front_end_.helper());
  }
  BeginResult();
}

System::~System() = default;

void System::Observe(std::function<void(const Atlas&, const LoopAttempt&)> observer) {
  mapping_.Observe(std::move(observer));
}

void System::UseInertial(const InertialCalibration& calibration) {
  PLUMBLINE_CHECK(result_.frames.empty(), "an inertial sensor is known before the first frame");
  stages_->gyroscope =
      std::make_unique<Gyroscope>(calibration, rectifier().rectified_left_from_left());
  tracker_.Use(*stages_->gyroscope);
  if (monocular_initialization_) monocular_initialization_->Use(*stages_->gyroscope);
}

void System::AddInertial(std::span<const InertialSample> samples) {
  if (stages_->gyroscope) stages_->gyroscope->Add(samples);
}

std::size_t System::TasksWaiting() const { return mapping_.Waiting(); }
bool System::MapOnce() { return mapping_.WorkOnce(); }
void System::WaitForMapping() {
  Complete();
  mapping_.WaitUntilDone();
}
const Rectifier& System::rectifier() const { return front_end_.rectifier(); }

void System::CheckStamp(std::int64_t stamp_ns) const {
  PLUMBLINE_CHECK(!finished_, "a finished run takes no frames");
  if (result_.frames.empty() || stamp_ns > newest_.stamp_ns) return;
  throw InputError(
      fmt::format("expected a frame after {} ns, found one of {} ns", newest_.stamp_ns, stamp_ns));
}

const FrameRecord& System::Skip(std::int64_t stamp_ns, const std::string& reason, LoadLevel shed) {
  Complete();
  CheckStamp(stamp_ns);
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(result_.frames.size())};
  record.stamp_ns = stamp_ns;
  record.reason = reason;
  record.shed = shed;
  return Keep(std::move(record));
}

const FrameRecord& System::Keep(FrameRecord record) {
  result_.frames.Add(record);
  if (!result_.read_only) {
    Session& session = result_.context.sessions.back();
    if (result_.frames.size() == 1) session.first_stamp_ns = record.stamp_ns;
    session.last_stamp_ns = record.stamp_ns;
  }
  newest_ = std::move(record);
  return newest_;
}

ExtractedFrame System::Extract(SensorFrame frame, StageClock clock, LoadLevel shed) const {
  return front_end_.Extract(std::move(frame), std::move(clock), shed);
}

const FrameRecord& System::Process(SensorFrame frame) {
  Track(Extract(std::move(frame)));
  Complete();
  return newest_;
}

const FrameRecord& System::Track(ExtractedFrame extracted) {
  Complete();
  CheckStamp(extracted.stamp_ns);
  if (!result_.read_only && result_.context.sessions.back().uuid == Uuid()) NameSession(extracted);
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(result_.frames.size())};
  record.stamp_ns = extracted.stamp_ns;
  record.shed = extracted.shed;
  mapping_.Lighten(extracted.shed);
  StageClock clock = std::move(extracted.clock);
  clock.Done("wait");  // time until tracking began with the frame

  const bool start = monocular_initialization_ && tracker_.state() == TrackerState::kInitializing;
  TrackingResult result =
      start ? OfferToStart(extracted, record) : FollowMap(extracted, record, clock);
  clock.Done(start ? "initialize" : "track");
  record.times = clock.Finish();
  view_ = {std::move(extracted.images), result.frame};
  if (!start) {
    unfinished_ = std::make_unique<UnfinishedFrame>(
        UnfinishedFrame{std::move(result), extracted.shed, std::move(extracted.left_pyramid)});
  }
  return Keep(std::move(record));
}

TrackingResult System::FollowMap(ExtractedFrame& extracted,
                                 FrameRecord& record,
                                 StageClock& clock) {
  const auto due = mapping_.SnapshotFor(record.id.value);
  clock.Done("map");
  for (const StageTime& time : TakeMappingTimes()) clock.Add(time.stage, time.milliseconds);
  const auto relocalized = TakeRelocalized(record.id);
  const auto& snapshot = relocalized != nullptr ? relocalized : due;
  if (snapshot != nullptr) map_ = snapshot->map;
  if (tracker_.NeedsRightLines()) {
    extracted.indexed =
        front_end_.WithRightLines(extracted.images, extracted.shed, extracted.indexed);
    clock.Done("right_lines");
  }
  TrackingResult result = tracker_.Track(record.id,
                                         record.stamp_ns,
                                         std::move(extracted.indexed),
                                         snapshot.get(),
                                         FeatureShare(extracted.shed));
  record.keyframe = result.keyframe.has_value();
  if (result.starts_map) map_ = MapId{next_map_++};
  RecordTracking(result, record);
  return result;
}

void System::Complete() {
  if (!unfinished_) return;
  StageClock clock;
  UnfinishedFrame unfinished = std::move(*unfinished_);
  unfinished_.reset();
  TrackingResult& result = unfinished.result;
  const std::int64_t frame = result.frame.id.value;
  CompleteRightLines(unfinished, clock);
  if (result.keyframe) {
    result.keyframe->keyframe.session = session_id();
    result.keyframe->left_pyramid = std::move(unfinished.left_pyramid);
    const auto gone = mapping_.Submit(frame, std::move(*result.keyframe), result.starts_map);
    if (gone) Demote(*gone);
  }
  if (result.leaves_surroundings) {
    mapping_.Submit(frame, UpdateLocalMapRequest{map_, result.frame.points, result.frame.lines});
  }
  Relocalize(result);
  LookInEarlierSnapshot(result);
  if (monocular_initialization_) {
    if (result.cam_from_world) monocular_initialization_->Tracked(result);
    if (result.state == TrackerState::kInitializing) monocular_initialization_->Restart();
  }
  clock.Done("after_keyframe");
  const std::vector<StageTime> times = clock.Stages();
  newest_.times.insert(newest_.times.end(), times.begin(), times.end());
  result_.frames.AddTimes(times);
}

void System::CompleteRightLines(UnfinishedFrame& unfinished, StageClock& clock) {
  TrackingResult& result = unfinished.result;
  if (!tracker_.WantsRightLines(result)) return;
  tracker_.Complete(front_end_.WithRightLines(view_.images, unfinished.shed, result.frame.indexed),
                    result);
  view_.frame.indexed = result.frame.indexed;
  clock.Done("after_right_lines");
}

// Takes the result of relocalization of an earlier frame, and lets the tracker continue from there
// if it is still lost. Returns the snapshot around that place; null if there is no place to
// continue from.
std::shared_ptr<const MapSnapshot> System::TakeRelocalized(FrameId frame) {
  const auto in_earlier = std::move(found_in_earlier_);
  const auto outcome = mapping_.TakeRelocalization();
  if (outcome) relocalizing_ = false;
  if (outcome && !outcome->found) tracker_.NotFound();
  if (tracker_.state() != TrackerState::kLost) return nullptr;
  if (outcome && outcome->found && !TrackedSince(outcome->found->frame.id)) {
    mapping_.Use(outcome->snapshot);
    if (outcome->snapshot->map != map_ && !result_.read_only) {
      mapping_.Submit(frame.value, SwitchMap{outcome->snapshot->map, outcome->found->keyframe});
      if (monocular_initialization_) monocular_initialization_->MapLeft();
    }
    return FollowFrom(*outcome);
  }
  if (in_earlier && in_earlier->snapshot->map == map_) return FollowFrom(*in_earlier);
  return nullptr;
}

std::shared_ptr<const MapSnapshot> System::FollowFrom(const RelocalizationOutcome& outcome) {
  const Relocalized& found = *outcome.found;
  tracker_.FollowFrom(found, *outcome.snapshot);
  result_.events.relocalizations.push_back(
      {found.frame.id, found.keyframe, found.counts.inlier_points, found.counts.inlier_lines});
  return outcome.snapshot;
}

// Live runs: looks for a lost frame in an earlier snapshot of the map, since mapping may have no
// time to look for it soon. The next frame is tracked against that snapshot.
void System::LookInEarlierSnapshot(const TrackingResult& result) {
  if (result.state != TrackerState::kLost) return;
  const auto earlier = mapping_.EarlierSnapshot();
  if (earlier == nullptr) return;
  auto found = stages_->relocalizer.Find(result.frame, *earlier);
  if (!found) return;
  found_in_earlier_ =
      std::make_unique<RelocalizationOutcome>(RelocalizationOutcome{std::move(found), earlier});
}

// Relocalization is outdated if the camera was tracked and lost again meanwhile: it may have made
// keyframes that are not in the snapshot around that place.
bool System::TrackedSince(FrameId frame) const {
  for (std::size_t i = result_.frames.size(); i-- > static_cast<std::size_t>(frame.value) + 1;) {
    if (result_.frames[i].status == FrameStatus::kTracked) return true;
  }
  return false;
}

// Asks for the place of a lost frame, unless such a request is still unanswered, or the frame shows
// too little to be found anywhere.
void System::Relocalize(const TrackingResult& result) {
  if (result.state != TrackerState::kLost || relocalizing_ || !options_.relocalization.enabled)
    return;
  if (result.failure == TrackingFailure::kTooFewFeatures) return;
  mapping_.Submit(result.frame.id.value, RelocalizationRequest{result.frame});
  relocalizing_ = true;
}

std::vector<std::string> System::Continue(SavedAtlas saved, bool read_only) {
  if (!options_.relocalization.enabled) {
    throw InputError("relocalization.enabled: expected true to go on in a map, found false");
  }
  if (saved.atlas.empty()) throw InputError("expected a map to go on in, found none");
  const AtlasContext& context = saved.context;
  CheckSameCamera(context.camera, result_.camera);
  const double scale = options_.features.orb.scale_factor;
  if (context.octave_scale != scale) {
    throw InputError(fmt::format("features.orb.scale_factor: expected {} as in the map, found {}",
                                 context.octave_scale,
                                 scale));
  }
  const AtlasContext& now = result_.context;
  std::vector<std::string> notes = FrontEndDifferences(context, now);
  for (std::string& note : notes) note = "the map was made with another front end: " + note;
  const std::vector<std::string> system = SystemDifferences(context, now);
  if (!system.empty()) {
    notes.push_back(fmt::format("the map was made by another system: {}", fmt::join(system, "; ")));
  }
  LocalMapper::State mapper;
  mapper.young = YoungOf(context);
  if (!CameraDifference({context.camera, context.rectified_from_left},
                        {now.camera, now.rectified_from_left})) {
    mapper.stereo_evidence = context.stereo_evidence;
  }
  map_ = saved.atlas.active_id();
  next_map_ = saved.atlas.NextMapId().value;
  result_.first_keyframe = saved.atlas.NextKeyFrameId();
  tracker_.BeginLost({result_.first_keyframe, read_only, options_.relocalization.patience});
  mapping_.Continue(std::move(saved.atlas), mapper);
  ContinueContext(std::move(saved.context), read_only);
  return notes;
}

// The maps that are only read keep their context; to others this session is added.
void System::ContinueContext(AtlasContext loaded, bool read_only) {
  result_.read_only = read_only;
  AtlasContext& context = result_.context;
  if (read_only) {
    context = std::move(loaded);
    return;
  }
  loaded.sessions.push_back(std::move(context.sessions.back()));
  context.sessions = std::move(loaded.sessions);
  context.maps = std::move(loaded.maps);
}

// Offers a frame of a single camera that has no map yet to the start of one. Most frames start
// none.
TrackingResult System::OfferToStart(const ExtractedFrame& extracted, FrameRecord& record) {
  const InitializationResult start = monocular_initialization_->Offer(record.id, extracted);
  if (start.map) return StartFrom(*start.map, record);
  record.status = StatusWithoutPose();
  record.reason = NameOf(start.wait);
  record.counts.matched_points = start.matches;
  TrackingResult result;
  result.frame.id = record.id;
  result.frame.stamp_ns = record.stamp_ns;
  result.frame.indexed = extracted.indexed;
  result.frame.points.resize(extracted.indexed->features.points.size());
  result.frame.lines.resize(extracted.indexed->features.lines.size());
  return result;
}

// Starts a map. Its newest view is the present frame; the other views are earlier frames, which get
// their poses now.
TrackingResult System::StartFrom(const InitialMap& initial, FrameRecord& record) {
  InitialMapEdit start = MakeInitialMapEdit(
      initial, imaging_, WorldFromFirstCamera(rectifier()), tracker_.next_keyframe());
  for (MapChange& change : start.edit) {
    if (auto* added = std::get_if<edit::AddKeyFrame>(&change))
      added->keyframe.session = session_id();
  }
  mapping_.Submit(record.id.value, start);
  map_ = MapId{next_map_++};
  monocular_initialization_->MapStarted(map_, start);
  TrackingResult result =
      tracker_.StartFrom(*mapping_.SnapshotFor(record.id.value), LastVelocity(initial));
  RecordTracking(result, record);
  record.keyframe = true;
  for (std::size_t i = 0; i + 1 < start.frames.size(); ++i) {
    result_.frames.Change(static_cast<std::size_t>(start.frames[i].value),
                          [&](FrameRecord& earlier) {
                            earlier.status = FrameStatus::kTracked;
                            earlier.reason.clear();
                            earlier.map = map_;
                            earlier.reference = start.keyframes[i];
                            earlier.keyframe = true;
                          });
  }
  return result;
}

// Undoes a keyframe that was given up. It was made by a recent frame, and only that frame and later
// ones refer to it, which bounds the search.
void System::Demote(const DroppedKeyFrame& gone) {
  tracker_.ReparentPoses(gone.id, gone.parent, gone.from_parent);
  if (monocular_initialization_)
    monocular_initialization_->ReparentPoses(gone.id, gone.parent, gone.from_parent);
  const auto made = static_cast<std::size_t>(gone.frame.value);
  for (std::size_t i = result_.frames.size(); i-- > made;) {
    if (result_.frames.ReferenceOf(i) != gone.id && i != made) continue;
    result_.frames.Change(i, [&](FrameRecord& record) {
      if (record.reference == gone.id) {
        record.reference = gone.parent;
        record.from_reference = Chained(record.from_reference, gone.from_parent);
      }
      record.keyframe = record.keyframe && i != made;
      record.demoted = record.demoted || i == made;
    });
  }
}

// Returns the status of a frame without pose. A camera that has had a map is lost, even while it
// looks for the start of another one.
FrameStatus System::StatusWithoutPose() const {
  return map_.valid() ? FrameStatus::kLost : FrameStatus::kInitializing;
}

void System::RecordTracking(const TrackingResult& result, FrameRecord& record) {
  record.counts = result.counts;
  cut_lines_ += result.counts.cut_lines;
  if (!result.cam_from_world) {
    record.status = StatusWithoutPose();
    record.reason = NameOf(result.failure);
    return;
  }
  record.status = FrameStatus::kTracked;
  record.map = map_;
  record.reference = result.reference;
  record.from_reference = result.from_reference;
  record.causal_world_from_camera =
      DeliveredPose(*result.cam_from_world, result_.rectified_from_left);
  if (result.covariance) {
    record.causal_covariance = PoseCovarianceInWorld(*result.cam_from_world, *result.covariance);
  }
}

std::vector<StageTime> System::TakeMappingTimes() {
  std::vector<StageTime> times;
  for (const MappingStep& step : mapping_.TakeTimes()) {
    times.push_back({"map_" + step.name, step.milliseconds});
  }
  return times;
}

// Lets frames whose keyframe is in no map, because mapping failed before it, refer to its parent.
// Marks them as lost if it has none, or if tracking failed before it handed the keyframe over.
void System::LoseFramesNotMapped() {
  for (const DroppedKeyFrame& gone : mapping_.NotMapped()) Demote(gone);
  const Atlas& atlas = mapping_.atlas();
  const auto has_place = [&](const FrameRecord& record) {
    const Map* map = atlas.Find(atlas.Current(record.map));
    return map != nullptr && map->Knows(record.reference);
  };
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    const FrameRecord record = result_.frames[i];
    if (record.status != FrameStatus::kTracked || has_place(record)) continue;
    result_.frames.Change(i, [](FrameRecord& lost) {
      lost.status = FrameStatus::kLost;
      lost.reason = kNotMapped;
    });
  }
}

RunResult System::Finish(const StopCheck& stop, std::exception_ptr* failure) {
  PLUMBLINE_CHECK(!finished_, "a run is finished once");
  std::exception_ptr first;
  const auto keeping = [&first](const auto& step) {
    try {
      step();
    } catch (...) {
      if (!first) first = std::current_exception();
    }
  };
  keeping([&] { Complete(); });
  keeping([&] { mapping_.Finish(stop); });
  keeping([&] { LoseFramesNotMapped(); });
  if (!first) keeping([&] { LocateEarlyFrames(stop); });
  keeping([&] { CollectMaps(); });
  if (const Gyroscope* gyroscope = stages_->gyroscope.get()) {
    result_.inertial = {gyroscope->observed(),
                        gyroscope->contradicted(),
                        gyroscope->errors(),
                        gyroscope->covariance().diagonal().cwiseSqrt()};
  }
  finished_ = true;
  if (failure != nullptr) *failure = first;
  if (failure == nullptr && first) std::rethrow_exception(first);
  return std::move(result_);
}

// Gives frames from before a monocular map, and early ones in it, their poses in the finished map.
void System::LocateEarlyFrames(const StopCheck& stop) {
  const std::vector<StageTime> times = TakeMappingTimes();
  if (!result_.frames.empty()) result_.frames.AddTimes(times);
  if (!monocular_initialization_) return;
  for (const EarlierFrame& earlier : monocular_initialization_->Locate(mapping_.atlas(), stop)) {
    const auto change = [&](FrameRecord& record) {
      record.status = FrameStatus::kTracked;
      record.reason.clear();
      record.map = earlier.map;
      record.reference = earlier.reference;
      record.from_reference = earlier.from_reference;
      record.counts = earlier.counts;
    };
    result_.frames.Change(static_cast<std::size_t>(earlier.id.value), change);
  }
}

MapEvents System::EventsSince(MapEventCounts& known) const {
  PLUMBLINE_CHECK(!finished_, "the events of a finished run are in its result");
  MapEvents events = mapping_.EventsSince(known);
  events.relocalizations = TakeNew(result_.events.relocalizations, known.relocalizations);
  return events;
}

}  // namespace plumbline
