// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/initial_map_edit.h"

#include "plumbline/base/error.h"
#include "plumbline/matching/measurements.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

namespace plumbline {
namespace {

// Turns an initial map into an edit step by step. Keyframes come first, since landmarks name them.
class StartBuilder {
 public:
  StartBuilder(const InitialMap& initial,
               const CameraAndPyramid& imaging,
               const Rigid3& world_from_first_cam,
               KeyFrameId first)
      : initial_(initial), camera_(imaging.camera), world_from_initial_(world_from_first_cam) {
    const std::size_t count = initial.views.size();
    PLUMBLINE_CHECK(count >= 2, "an initial map has two views at least");
    for (std::size_t i = 0; i < count; ++i) {
      start_.keyframes.push_back(KeyFrameId{first.value + static_cast<std::int64_t>(i)});
      start_.frames.push_back(initial.views[i].frame.id);
    }
  }

  InitialMapEdit Build() {
    AddKeyFrames();
    for (std::size_t k = 0; k < initial_.points.size(); ++k) AddPoint(k);
    for (std::size_t k = 0; k < initial_.lines.size(); ++k) AddLine(k);
    return std::move(start_);
  }

 private:
  void AddKeyFrames() {
    KeyFrameId parent;
    for (std::size_t i = 0; i < initial_.views.size(); ++i) {
      const InitializationFrame& from = initial_.views[i].frame;
      Frame frame;
      frame.id = from.id;
      frame.stamp_ns = from.stamp_ns;
      frame.indexed = from.indexed;
      frame.cam_from_world = initial_.views[i].cam_from_world * Inverse(world_from_initial_);
      frame.points.resize(from.indexed->features.points.size());
      frame.lines.resize(from.indexed->features.lines.size());
      frames_.push_back(frame);
      start_.edit.push_back(edit::AddKeyFrame{{start_.keyframes[i], parent, std::move(frame)}});
      parent = start_.keyframes[i];
    }
  }

  Observations ByKeyFrame(const std::vector<InitialObservation>& observations) const {
    Observations result;
    for (const InitialObservation& o : observations) {
      result.emplace(start_.keyframes[static_cast<std::size_t>(o.view)], o.feature);
    }
    return result;
  }

  void AddPoint(std::size_t k) {
    MapPoint point;
    point.id = PointId{static_cast<std::int64_t>(k)};
    point.created_by = start_.keyframes.back();
    point.position = world_from_initial_ * initial_.points[k].position;
    point.observations = ByKeyFrame(initial_.points[k].observations);
    start_.edit.push_back(edit::AddPoint{std::move(point)});
    start_.edit.push_back(edit::RefreshPoint{PointId{static_cast<std::int64_t>(k)}});
  }

  void AddLine(std::size_t k) {
    const InitialLine& from = initial_.lines[k];
    MapLine line;
    line.id = LineId{static_cast<std::int64_t>(k)};
    line.created_by = start_.keyframes.back();
    line.line = Transform(world_from_initial_, from.line);
    line.start = line.line.ParameterOf(world_from_initial_ * from.segment.start);
    line.end = line.line.ParameterOf(world_from_initial_ * from.segment.end);
    if (line.start > line.end) std::swap(line.start, line.end);
    line.observations = ByKeyFrame(from.observations);
    for (const InitialObservation& o : from.observations) {
      line.information += LineInformation(camera_,
                                          frames_[static_cast<std::size_t>(o.view)],
                                          static_cast<std::size_t>(o.feature),
                                          line.line);
    }
    start_.edit.push_back(edit::AddLine{std::move(line)});
    start_.edit.push_back(edit::RefreshLine{LineId{static_cast<std::int64_t>(k)}});
  }

  const InitialMap& initial_;
  const RectifiedCamera& camera_;
  Rigid3 world_from_initial_;
  std::vector<Frame> frames_;  // the frames of the keyframes
  InitialMapEdit start_;
};

}  // namespace

InitialMapEdit MakeInitialMapEdit(const InitialMap& initial,
                                  const CameraAndPyramid& imaging,
                                  const Rigid3& world_from_first_cam,
                                  KeyFrameId first) {
  return StartBuilder(initial, imaging, world_from_first_cam, first).Build();
}

MapEdit NumberedFor(const Map& map, MapEdit edit) {
  const auto number_point = [&](PointId& id) { id.value += map.NextPointId().value; };
  const auto number_line = [&](LineId& id) { id.value += map.NextLineId().value; };
  for (MapChange& change : edit) {
    if (auto* point = std::get_if<edit::AddPoint>(&change)) {
      number_point(point->landmark.id);
    } else if (auto* line = std::get_if<edit::AddLine>(&change)) {
      number_line(line->landmark.id);
    } else if (auto* new_point = std::get_if<edit::RefreshPoint>(&change)) {
      number_point(new_point->id);
    } else if (auto* new_line = std::get_if<edit::RefreshLine>(&change)) {
      number_line(new_line->id);
    }
  }
  return edit;
}

}  // namespace plumbline
