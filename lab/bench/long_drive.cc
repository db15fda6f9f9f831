// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "long_drive.h"

#include "plumbline/base/random.h"
#include "plumbline/matching/measurements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

namespace plumbline {
namespace {

constexpr int kPointsOfKeyFrame = 90;
constexpr int kLinesOfKeyFrame = 10;
constexpr int kBefore = 4, kAfter = 8;  // places from which a landmark may be seen
constexpr double kFound = 0.8;          // share of those in view
constexpr double kFoundAgain = 0.5;     // share of the later visits that match a landmark at all
constexpr double kPointSigmaPx = 0.7, kLineSigmaPx = 0.4, kDisparitySigmaPx = 0.3;

RectifiedCamera CarCamera() {
  return {
      .fx = 718, .fy = 718, .cx = 607, .cy = 185, .baseline = 0.54, .width = 1241, .height = 376};
}

// Position and heading on a flat road.
struct RoadPose {
  double x = 0, z = 0, heading = 0;

  // A metre further, the road turning by `turn` meanwhile.
  RoadPose Next(double turn) const {
    const double mean = heading + 0.5 * turn;
    return {x + std::sin(mean), z + std::cos(mean), heading + turn};
  }
  Rigid3 CamFromWorld() const {
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitY()));
    return Inverse(Rigid3{rotation, {x, 0, z}});
  }
};

// The road as driven by each keyframe. In shapes with circuits, these close; after each the side to
// which the road turns changes, and for those through a hub also the length of the straight.
std::vector<RoadPose> Road(DriveShape shape, const std::vector<int>& places) {
  const int part = std::max(1, static_cast<int>(places.size()) / kDriveParts);
  std::vector<RoadPose> road;
  std::vector<RoadPose> at_place(places.size());
  std::vector<bool> known(places.size(), false);
  RoadPose pose;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto place = static_cast<std::size_t>(places[k]);
    if (known[place]) {
      pose = at_place[place];
    } else {
      known[place] = true;
      at_place[place] = pose;
    }
    road.push_back(pose);
    const int round = static_cast<int>(k) / part, step = static_cast<int>(k) % part;
    const int circuit = shape == DriveShape::kChain ? part - part / 6 : part;
    const double side = round % 2 == 0 ? 1 : -1;
    // A stadium: two straight stretches and two half circles.
    const int straight = part / 10 + (shape == DriveShape::kHub ? round * part / 50 : 0);
    const int bend = std::max(1, circuit / 2 - straight);
    const int in_half = step % (straight + bend);
    const bool bending = shape != DriveShape::kStraight && in_half >= straight;
    pose = pose.Next(bending ? side * std::numbers::pi / bend : 0);
  }
  return road;
}

struct Sighting {
  int keyframe = 0;
  int feature = 0;
};

// Landmarks of the world, before there is a map.
struct DrivePoint {
  Eigen::Vector3d position;
  std::vector<Sighting> seen;
  int created_by = 0;
};
struct DriveLine {
  Segment3 segment;
  std::vector<Sighting> seen;
  int created_by = 0;
};

class DriveBuilder {
 public:
  DriveBuilder(DriveShape shape, int keyframes)
      : places_(DrivePlaces(shape, keyframes)), visits_(DriveVisits(places_)) {
    drive_.imaging.camera = CarCamera();
    features_.resize(places_.size());
    const std::vector<RoadPose> road = Road(shape, places_);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      Rng rng(1, "drive_pose", k);
      Vector6d lane, error;
      lane << RandomVector(rng, 0.01), RandomVector(rng, 0.2);
      error << RandomVector(rng, 0.0002), RandomVector(rng, 0.01);
      world_from_road_.push_back(Inverse(road[k].CamFromWorld()).rotation);
      drive_.truth.push_back(ExpSe3(lane) * road[k].CamFromWorld());
      estimate_.push_back(k == 0 ? drive_.truth[k] : ExpSe3(error) * drive_.truth[k]);
    }
  }

  LongDrive Build() {
    for (std::size_t k = 0; k < places_.size(); ++k) AddLandmarks(k);
    AddKeyFrames();
    MapEdit edit;
    for (std::size_t i = 0; i < points_.size(); ++i) AddPoint(i, edit);
    drive_.map.Apply(edit);
    edit.clear();
    for (std::size_t i = 0; i < lines_.size(); ++i) AddLine(i, edit);
    drive_.map.Apply(edit);
    return std::move(drive_);
  }

 private:
  static Eigen::Vector3d RandomVector(Rng& rng, double sigma) {
    const double x = rng.Normal(sigma);
    const double y = rng.Normal(sigma);
    return {x, y, rng.Normal(sigma)};
  }
  static Eigen::Vector2d RandomPixel(Rng& rng, double sigma) {
    const double x = rng.Normal(sigma);
    return {x, rng.Normal(sigma)};
  }

  // Beside the road or ahead, as camera coordinates.
  Eigen::Vector3d PlaceInView(Rng& rng) const {
    const RectifiedCamera& camera = drive_.imaging.camera;
    const double u = rng.Uniform(0, camera.width);
    const double v = rng.Uniform(0, camera.height);
    return camera.Unproject({u, v}) * std::exp(rng.Uniform(std::log(6), std::log(40)));
  }

  // Edges of houses beside the road: upright, along it, across it, and some of any direction.
  static Eigen::Vector3d EdgeDirection(Rng& rng) {
    const double kind = rng.Uniform();
    if (kind < 0.4) return Eigen::Vector3d::UnitY();
    if (kind < 0.65) return Eigen::Vector3d::UnitZ();
    if (kind < 0.8) return Eigen::Vector3d::UnitX();
    return RandomVector(rng, 1).normalized();
  }

  // The keyframes that look for a landmark: those around the one that adds it, and of the other
  // visits to the place some.
  std::vector<int> Watchers(int keyframe, Rng& rng) const {
    const int place = places_[static_cast<std::size_t>(keyframe)];
    std::vector<int> watchers;
    for (const int visit : visits_[static_cast<std::size_t>(place)]) {
      if (visit != keyframe && rng.Uniform() >= kFoundAgain) continue;
      const int last = static_cast<int>(places_.size()) - 1;
      for (int k = std::max(0, visit - kBefore); k <= std::min(last, visit + kAfter); ++k) {
        // A visit ends at the fork of the roads.
        const int other = places_[static_cast<std::size_t>(k)];
        if (visit != keyframe && std::abs(other - place) > kAfter) continue;
        if (rng.Uniform() < kFound) watchers.push_back(k);
      }
    }
    std::sort(watchers.begin(), watchers.end());
    watchers.erase(std::unique(watchers.begin(), watchers.end()), watchers.end());
    return watchers;
  }

  void AddLandmarks(std::size_t k) {
    Rng rng(1, "drive_landmarks", k);
    const int keyframe = static_cast<int>(k);
    const Rigid3 world_from_cam = Inverse(drive_.truth[k]);
    for (int i = 0; i < kPointsOfKeyFrame; ++i) {
      DrivePoint point{world_from_cam * PlaceInView(rng), {}, keyframe};
      for (const int watcher : Watchers(keyframe, rng)) SeePoint(watcher, rng, point);
      if (point.seen.size() >= 2) points_.push_back(std::move(point));
    }
    for (int i = 0; i < kLinesOfKeyFrame; ++i) {
      const Eigen::Vector3d start = world_from_cam * PlaceInView(rng);
      const double length = rng.Uniform(1, 4);
      const Eigen::Vector3d along = world_from_road_[k] * EdgeDirection(rng);
      DriveLine line{{start, start + length * along}, {}, keyframe};
      for (const int watcher : Watchers(keyframe, rng)) SeeLine(watcher, rng, line);
      if (line.seen.size() >= 2) lines_.push_back(std::move(line));
    }
  }

  void SeePoint(int watcher, Rng& rng, DrivePoint& point) {
    const auto k = static_cast<std::size_t>(watcher);
    const RectifiedCamera& camera = drive_.imaging.camera;
    const Eigen::Vector3d p = drive_.truth[k] * point.position;
    if (p.z() < 2 || !camera.Contains(camera.Project(p), 5)) return;
    Features& features = features_[k];
    point.seen.push_back({watcher, static_cast<int>(features.points.size())});
    PointFeature feature;
    feature.px = camera.Project(p) + RandomPixel(rng, kPointSigmaPx);
    feature.sigma_px = kPointSigmaPx;
    features.points.push_back(feature);
    features.point_disparity.push_back(Disparity{
        camera.DisparityFromDepth(p.z()) + rng.Normal(kDisparitySigmaPx), kDisparitySigmaPx});
  }

  void SeeLine(int watcher, Rng& rng, DriveLine& line) {
    constexpr double kMinLengthPx = 25;
    const auto k = static_cast<std::size_t>(watcher);
    const RectifiedCamera& camera = drive_.imaging.camera;
    const Segment3 in_left{drive_.truth[k] * line.segment.start,
                           drive_.truth[k] * line.segment.end};
    const Eigen::Vector3d shift(camera.baseline, 0, 0);
    const auto left = ProjectSegment(camera, in_left);
    const auto right = ProjectSegment(camera, {in_left.start - shift, in_left.end - shift});
    if (!left || left->Length() < kMinLengthPx) return;
    Features& features = features_[k];
    line.seen.push_back({watcher, static_cast<int>(features.lines.size())});
    LineFeature feature;
    feature.segment = Noisy(*left, rng);
    feature.sigma_px = kLineSigmaPx;
    features.lines.push_back(feature);
    std::optional<MeasuredSegment> in_right;
    if (right && right->Length() >= kMinLengthPx) {
      in_right = MeasuredSegment{Noisy(*right, rng), kLineSigmaPx};
    }
    features.line_right.push_back(in_right);
  }

  static Segment2 Noisy(const Segment2& segment, Rng& rng) {
    const Eigen::Vector2d start = segment.start + RandomPixel(rng, kLineSigmaPx);
    return {start, segment.end + RandomPixel(rng, kLineSigmaPx)};
  }

  void AddKeyFrames() {
    const RectifiedCamera& camera = drive_.imaging.camera;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const KeyFrameId id{static_cast<std::int64_t>(k)};
      Frame frame;
      frame.id = FrameId{id.value};
      frame.stamp_ns = id.value * 100'000'000;
      frame.cam_from_world = estimate_[k];
      frame.points.resize(features_[k].points.size());
      frame.lines.resize(features_[k].lines.size());
      std::vector<Eigen::Vector2d> positions;
      for (const PointFeature& point : features_[k].points) positions.push_back(point.px);
      PointGrid grid(positions, camera.width, camera.height);
      frame.indexed = std::make_shared<const FrameFeatures>(
          FrameFeatures{std::move(features_[k]), std::move(grid)});
      drive_.map.Apply({edit::AddKeyFrame{{id, KeyFrameId{id.value - 1}, std::move(frame)}}});
    }
  }

  // Error of the pose of the keyframe that adds a landmark.
  Rigid3 Displacement(int created_by) const {
    const auto k = static_cast<std::size_t>(created_by);
    return Inverse(estimate_[k]) * drive_.truth[k];
  }

  static Observations ObservationsOf(const std::vector<Sighting>& seen) {
    Observations observations;
    for (const Sighting& sighting : seen) {
      observations.emplace(KeyFrameId{sighting.keyframe}, sighting.feature);
    }
    return observations;
  }

  void AddPoint(std::size_t index, MapEdit& edit) const {
    const DrivePoint& from = points_[index];
    MapPoint point;
    point.id = PointId{static_cast<std::int64_t>(index)};
    point.position = Displacement(from.created_by) * from.position;
    point.created_by = KeyFrameId{from.created_by};
    point.observations = ObservationsOf(from.seen);
    edit.push_back(edit::AddPoint{std::move(point)});
  }

  void AddLine(std::size_t index, MapEdit& edit) const {
    const DriveLine& from = lines_[index];
    const Rigid3 displacement = Displacement(from.created_by);
    const Segment3 segment{displacement * from.segment.start, displacement * from.segment.end};
    MapLine line;
    line.id = LineId{static_cast<std::int64_t>(index)};
    line.line = LineThroughPoints(segment.start, segment.end);
    line.start = line.line.ParameterOf(segment.start);
    line.end = line.line.ParameterOf(segment.end);
    line.created_by = KeyFrameId{from.created_by};
    line.observations = ObservationsOf(from.seen);
    for (const Sighting& sighting : from.seen) {
      line.information += LineInformation(drive_.imaging.camera,
                                          drive_.map.Find(KeyFrameId{sighting.keyframe})->frame,
                                          static_cast<std::size_t>(sighting.feature),
                                          line.line);
    }
    edit.push_back(edit::AddLine{std::move(line)});
  }

  std::vector<int> places_;               // by keyframe
  std::vector<std::vector<int>> visits_;  // by place
  LongDrive drive_;
  std::vector<Eigen::Quaterniond> world_from_road_;  // by keyframe
  std::vector<Rigid3> estimate_;                     // by keyframe
  std::vector<Features> features_;
  std::vector<DrivePoint> points_;
  std::vector<DriveLine> lines_;
};

}  // namespace

LongDrive MakeLongDrive(DriveShape shape, int keyframes) {
  return DriveBuilder(shape, keyframes).Build();
}

}  // namespace plumbline
