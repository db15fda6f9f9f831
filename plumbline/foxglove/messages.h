// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/foxglove/protobuf_writer.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Messages of Foxglove's schemas in protobuf. The coordinate frames are "map", the world of the
// active map, and "camera", the rectified left camera (x right, y down, z forward); the right
// camera is given by the baseline, as in ROS. Stamps are those of the sensor in nanoseconds.

inline constexpr std::string_view kMapFrame = "map";
inline constexpr std::string_view kCameraFrame = "camera";

struct Rgba {
  double r = 0, g = 0, b = 0, a = 1;
};

// Returns a google.protobuf.Timestamp.
ProtobufWriter StampMessage(std::int64_t stamp_ns);
// Returns a foxglove.Pose of a frame in its parent.
ProtobufWriter PoseMessage(const Rigid3& parent_from_frame);

// `data` is an image file in the given format ("jpeg").
std::string CompressedImageMessage(std::int64_t stamp_ns,
                                   std::string_view format,
                                   std::string_view data);
// The left camera, or the right one of a pair.
enum class CameraSide { kLeft, kRight };
std::string CalibrationMessageOf(std::int64_t stamp_ns,
                                 const RectifiedCamera& camera,
                                 CameraSide side = CameraSide::kLeft);
std::string PoseInFrameMessage(std::int64_t stamp_ns, const Rigid3& world_from_camera);
std::string TransformMessage(std::int64_t stamp_ns, const Rigid3& world_from_camera);

// Points and segments of one colour in the image, in pixels.
struct ImageMarks {
  std::vector<Eigen::Vector2d> points;
  std::vector<Segment2> segments;
  Rgba color;
  double thickness = 1;  // in pixels
};
std::string AnnotationsMessage(std::int64_t stamp_ns, std::span<const ImageMarks> marks);

// `xyz` has x, y, z of every point, one after the other.
std::string PointCloudMessage(std::int64_t stamp_ns, std::span<const float> xyz);

// Lines that are displayed and replaced together.
struct LineEntity {
  std::string id;
  // Six numbers for each line; empty if the entity was removed.
  std::vector<float> ends;
};
std::string SceneUpdateMessage(std::int64_t stamp_ns,
                               std::span<const LineEntity> entities,
                               bool forget_all_others);

}  // namespace plumbline
