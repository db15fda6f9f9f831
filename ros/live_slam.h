// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/live/stamp_continuity.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/system.h"

#include "inertial_queue.h"
#include "sensor_messages.h"
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline::ros_node {

// An option, and how messages name it: "node.yaml:4: options.features.line_count".
struct OptionSetting {
  std::string key, text, where;
};

struct LiveSlamSettings {
  std::string sensor = "mono";  // mono, stereo, rgbd
  std::string camera;           // a file, or the name of a built-in camera; empty: SetCameras
  // Whether the images are rectified (SetCameras); not set: as the name of their topic says.
  std::optional<bool> rectified;
  std::string config;                  // a file of options; empty: none
  std::vector<OptionSetting> options;  // applied after the file
  std::string imu = "off";             // off, auto or a file (FindInertialCalibration)
};

// What came of a frame.
struct FrameOutcome {
  std::int64_t stamp_ns = 0;  // as it was fed
  bool skipped = false;       // it was left out, for want of time
  std::string state;          // initializing, tracked, lost, skipped
  std::optional<Rigid3> world_from_camera;
  // Of world_from_camera, relative to the map, along its axes: x, y, z, rotation about x, y, z. Not
  // set where it is not known.
  std::optional<Matrix6d> covariance;
  std::int64_t map = -1;   // in which the pose is
  bool corrected = false;  // the map was corrected at large since the frame before
};

// The active map at one moment.
struct MapView {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> lines;
  // Stamps and world_from_camera, the camera as delivered, by time.
  std::vector<std::pair<std::int64_t, Rigid3>> keyframes;
};

// SLAM on frames that come when they come, in live mode unless told otherwise: one run of the
// camera after the other, each begun by Load or Reset. One thread calls; what is wrong with its
// arguments is told by InputError, after which all is as it was before the call.
class LiveSlam {
 public:
  // Called in the thread that tracks, in the order of the frames.
  using Observer = std::function<void(const FrameOutcome&)>;

  LiveSlam(const LiveSlamSettings& settings, Observer observer);
  ~LiveSlam();
  LiveSlam(const LiveSlam&) = delete;
  LiveSlam& operator=(const LiveSlam&) = delete;

  // Whether the cameras are known.
  bool IsCalibrated() const { return calibration_.has_value(); }
  // image_topic: of the left images; the last part of its name may say that they are rectified, as
  // for the topics of a bag.
  void SetCameras(const TopicCamera& left,
                  const std::optional<TopicCamera>& right,
                  const std::string& image_topic);

  // Whether the gyroscope of an inertial sensor is used.
  bool UsesInertial() const { return inertial_.has_value(); }
  // A sample for the frames whose turns need it. It may let go frames that waited for it.
  void AddInertial(const InertialSample& sample);

  // A frame; with an inertial sensor it may wait for its samples (InertialQueue). `second` is the
  // right image or the depth image, null with one camera. Stamps that jump back go on behind the
  // frame before (StampContinuity): then this returns by how many seconds they jumped. 16 bits of
  // depth are millimetres. Where maps that wait do not fit the camera, every frame is refused for
  // that reason until Load or Reset.
  std::optional<double> Feed(const TopicImage& left, const TopicImage* second);
  bool HasFrames() const { return session_ && has_frames_; }

  // Hands over the active map as mapping has it when it has done what was tracked, in the thread
  // that maps; nothing where there is no map. Waits until the frames so far are tracked.
  void ViewMap(std::function<void(MapView)> take);

  // Writes all maps into a file, and says what was written.
  std::string Save(const std::string& path);
  // Goes on in the maps of a file, where the camera is looked for; `localize`: changes nothing of
  // them. Before the cameras are known the maps wait. Returns what makes them harder to use.
  std::vector<std::string> Load(const std::string& path, bool localize);
  void Reset();

 private:
  class Session;

  // A frame with its stamp as it was fed.
  struct WaitingFrame {
    std::int64_t source_ns = 0;
    SensorFrame frame;
  };

  // Hands frames to the pipeline with their samples: those that need not wait for more, or `all`.
  void HandOn(bool all);
  SensorFrame FrameOf(const TopicImage& left, const TopicImage* second) const;
  std::unique_ptr<Session> MakeSession();
  std::unique_ptr<Session> Begin();
  void Observe(const FrameRecord& record, bool corrected);
  std::int64_t StampAsFed(std::int64_t stamp_ns);

  SensorKind sensor_;
  std::optional<bool> rectified_;
  SlamOptions options_;
  std::optional<Calibration> calibration_;
  std::optional<InertialCalibration> inertial_;  // nullopt: none is used
  InertialQueue samples_;
  std::deque<WaitingFrame> waiting_;
  Observer observer_;
  std::optional<SavedAtlas> loaded_;  // to begin with
  bool localize_ = false;
  std::optional<std::string> unusable_;  // why no session could begin, where that was tried
  StampContinuity continuity_;
  bool has_frames_ = false;
  std::mutex stamps_mutex_;
  std::map<std::int64_t, std::int64_t> stamps_;  // ours to those as fed, of frames that are not out
  std::unique_ptr<Session> session_;  // null until the first frame; last: its threads call Observe
};

}  // namespace plumbline::ros_node
