// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "live_slam.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/recorded_topics.h"
#include "plumbline/io/live/stamp_continuity.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/slam/pipeline.h"
#include "plumbline/slam/system.h"

#include "apps/command_line.h"
#include "sensor_messages.h"
#include <map>
#include <mutex>

#include <fmt/format.h>

namespace plumbline::ros_node {
namespace {

SlamOptions ReadOptions(const LiveSlamSettings& settings) {
  SlamOptions options;
  OptionTable table(options);
  table.Set("slam.mode=live");
  if (!settings.config.empty()) table.LoadFile(settings.config);
  for (const OptionSetting& option : settings.options) {
    table.Set(option.key, option.text, option.where);
  }
  CheckOptions(options);
  return options;
}

std::optional<Calibration> FindCalibration(const LiveSlamSettings& settings, SensorKind sensor) {
  if (settings.camera.empty()) return std::nullopt;
  const bool pair = sensor == SensorKind::kStereo;
  Calibration calibration = FindCamera(settings.camera, pair).calibration;
  if (pair && !calibration.right) {
    throw InputError(settings.camera + ": expected two cameras for stereo, found one");
  }
  if (!pair) calibration.right.reset();
  calibration.depth_factor.reset();
  if (sensor == SensorKind::kRgbd) calibration.depth_factor = kDepthFactor;
  return calibration;
}

MapView ViewOf(const Map& map, const Eigen::Quaterniond& rectified_from_left) {
  MapView view;
  for (const auto& [id, point] : map.points()) view.points.push_back(point.position);
  for (const auto& [id, line] : map.lines()) {
    const Segment3 segment = line.Interval();
    view.lines.emplace_back(segment.start, segment.end);
  }
  std::map<std::int64_t, Rigid3> by_time;
  for (const auto& [id, keyframe] : map.keyframes()) {
    by_time.emplace(keyframe.frame.stamp_ns,
                    DeliveredPose(keyframe.frame.cam_from_world, rectified_from_left));
  }
  view.keyframes.assign(by_time.begin(), by_time.end());
  return view;
}

}  // namespace

// One run of the camera: a System with its Pipeline.
class LiveSlam::Session {
 public:
  using Observer = std::function<void(const FrameRecord&, bool corrected)>;

  Session(const Calibration& calibration,
          const SlamOptions& options,
          const std::optional<InertialCalibration>& inertial,
          Observer observer)
      : system_(calibration, options),
        observer_(std::move(observer)),
        pipeline_(system_,
                  [this](const FrameRecord& record, const FrameView&) { Observe(record); }) {
    if (inertial) system_.UseInertial(*inertial);
  }

  System& system() { return system_; }
  Pipeline& pipeline() { return pipeline_; }

 private:
  void Observe(const FrameRecord& record) {
    observer_(record, !system_.EventsSince(corrections_).empty());
  }

  System system_;
  Observer observer_;
  MapEventCounts corrections_;  // so far; the tracking thread's
  Pipeline pipeline_;           // last: its thread calls Observe
};

LiveSlam::LiveSlam(const LiveSlamSettings& settings, Observer observer)
    : sensor_(ParseChoice<SensorKind>("sensor", settings.sensor)),
      rectified_(settings.rectified),
      options_(ReadOptions(settings)),
      calibration_(FindCalibration(settings, sensor_)),
      inertial_(FindInertialCalibration(settings.imu, settings.camera)),
      samples_(inertial_ ? inertial_->time_offset.value_or(0) : 0,
               options_.slam.mode != RunMode::kLive),
      observer_(std::move(observer)) {}
LiveSlam::~LiveSlam() = default;

void LiveSlam::SetCameras(const TopicCamera& left,
                          const std::optional<TopicCamera>& right,
                          const std::string& image_topic) {
  if ((sensor_ == SensorKind::kStereo) != right.has_value()) {
    throw InputError("cameras: expected two for stereo and one otherwise");
  }
  const bool rectified = rectified_.value_or(IsRectifiedByName(image_topic));
  calibration_ = CalibrationOf(left, right, rectified, sensor_ == SensorKind::kRgbd);
}

std::optional<double> LiveSlam::Feed(const TopicImage& left, const TopicImage* second) {
  if (unusable_) throw InputError(*unusable_);
  const std::int64_t stamp_ns = left.message.stamp_ns;
  SensorFrame frame = FrameOf(left, second);
  if (!session_) session_ = Begin();
  const StampContinuity::Stamp next = continuity_.Next(stamp_ns);
  frame.stamp_ns = next.stamp_ns;
  {
    const std::lock_guard lock(stamps_mutex_);
    stamps_[next.stamp_ns] = stamp_ns;
  }
  has_frames_ = true;
  waiting_.push_back({stamp_ns, std::move(frame)});
  HandOn(!inertial_);
  if (!next.jumped_back_ns) return std::nullopt;
  return 1e-9 * static_cast<double>(*next.jumped_back_ns);
}

void LiveSlam::AddInertial(const InertialSample& sample) {
  if (!inertial_) return;
  samples_.Add(sample);
  HandOn(false);
}

void LiveSlam::HandOn(bool all) {
  while (!waiting_.empty()) {
    if (!all && samples_.MustWait(waiting_.front().source_ns, waiting_.back().source_ns)) return;
    WaitingFrame next = std::move(waiting_.front());
    waiting_.pop_front();
    // Samples jump where the stamps of frames do.
    std::vector<InertialSample> samples = samples_.TakeUpTo(next.source_ns);
    for (InertialSample& one : samples) one.stamp_ns += next.frame.stamp_ns - next.source_ns;
    session_->pipeline().AddInertial(samples);
    session_->pipeline().Feed(std::move(next.frame));
  }
}

SensorFrame LiveSlam::FrameOf(const TopicImage& left, const TopicImage* second) const {
  if (!calibration_) throw InputError("expected a calibration before the first frame, found none");
  const ImageSize size{calibration_->left.width(), calibration_->left.height()};
  SensorFrame frame;
  frame.left = GrayOf(left, size);
  if (sensor_ == SensorKind::kMono) return frame;
  if (second == nullptr) throw InputError("expected a second image, found none");
  if (sensor_ == SensorKind::kStereo) frame.right = GrayOf(*second, size);
  if (sensor_ == SensorKind::kRgbd) frame.depth = DepthOf(*second, size);
  return frame;
}

std::unique_ptr<LiveSlam::Session> LiveSlam::MakeSession() {
  return std::make_unique<Session>(
      *calibration_, options_, inertial_, [this](const FrameRecord& r, bool corrected) {
        Observe(r, corrected);
      });
}

// With what was loaded, or nothing. What was loaded stays where it does not fit, and is not tried
// again: that would take longer than the time between two frames.
std::unique_ptr<LiveSlam::Session> LiveSlam::Begin() {
  std::unique_ptr<Session> session;
  try {
    session = MakeSession();
    if (loaded_) session->system().Continue(*loaded_, localize_);
  } catch (const InputError& error) {
    unusable_ = error.what();
    throw;
  }
  loaded_.reset();
  has_frames_ = false;
  return session;
}

void LiveSlam::Observe(const FrameRecord& record, bool corrected) {
  FrameOutcome outcome;
  outcome.stamp_ns = StampAsFed(record.stamp_ns);
  outcome.skipped = record.status == FrameStatus::kSkipped;
  outcome.state = NameOf(record.status);
  outcome.world_from_camera = record.causal_world_from_camera;
  outcome.covariance = record.causal_covariance;
  outcome.map = record.map.valid() ? record.map.value : -1;
  outcome.corrected = corrected;
  observer_(outcome);
}

// Forgets the frames before.
std::int64_t LiveSlam::StampAsFed(std::int64_t stamp_ns) {
  const std::lock_guard lock(stamps_mutex_);
  const auto found = stamps_.find(stamp_ns);
  PLUMBLINE_CHECK(found != stamps_.end(), "a frame came out that was not fed");
  const std::int64_t as_fed = found->second;
  stamps_.erase(stamps_.begin(), std::next(found));
  return as_fed;
}

void LiveSlam::ViewMap(std::function<void(MapView)> take) {
  if (!HasFrames()) return;
  session_->pipeline().Drain();
  System& system = session_->system();
  // The map is shown in the world of the poses that are reported meanwhile.
  system.ReadMaps([take = std::move(take),
                   rectified_from_left =
                       system.rectifier().rectified_left_from_left()](const CurrentMaps& maps) {
    const Map* map = maps.atlas.Find(maps.atlas.active_id());
    if (map != nullptr) take(ViewOf(*map, rectified_from_left));
  });
}

std::string LiveSlam::Save(const std::string& path) {
  if (!HasFrames()) throw InputError(path + ": expected frames before a map is saved, found none");
  HandOn(true);
  session_->pipeline().Drain();
  SavedAtlas saved;
  session_->system().ReadMaps([&saved](const CurrentMaps& maps) { saved = maps.copy(); });
  session_->system().WaitForMapping();
  SaveAtlas(path, saved.atlas, saved.context);
  const Map* map = saved.atlas.Find(saved.atlas.active_id());
  return fmt::format("{}: {} keyframes, {} points, {} lines",
                     path,
                     map != nullptr ? map->keyframes().size() : 0,
                     map != nullptr ? map->points().size() : 0,
                     map != nullptr ? map->lines().size() : 0);
}

std::vector<std::string> LiveSlam::Load(const std::string& path, bool localize) {
  SavedAtlas saved = LoadAtlas(path);
  if (!calibration_) {
    loaded_ = std::move(saved);
    localize_ = localize;
    return {};
  }
  std::unique_ptr<Session> session = MakeSession();
  std::vector<std::string> remarks = session->system().Continue(std::move(saved), localize);
  waiting_.clear();
  session_ = std::move(session);
  loaded_.reset();
  unusable_.reset();
  has_frames_ = false;
  return remarks;
}

void LiveSlam::Reset() {
  waiting_.clear();
  session_.reset();
  loaded_.reset();
  unusable_.reset();
  localize_ = false;
  has_frames_ = false;
}

}  // namespace plumbline::ros_node
