// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/viewer/messages.h"

#include "plumbline/base/units.h"

#include <array>
#include <bit>

namespace plumbline {
namespace {

constexpr std::uint32_t kBytesPerPoint = 12;

// Constants of foxglove.PointsAnnotation, LinePrimitive, PackedElementField and
// SceneEntityDeletion.
constexpr std::uint64_t kPointsType = 1, kLineListType = 4;
constexpr std::uint64_t kLineListPrimitive = 2;
constexpr std::uint64_t kFloat32 = 7;
constexpr std::uint64_t kDeleteAll = 1;

ProtobufWriter ColorMessage(const std::array<double, 4>& color) {
  return ProtobufWriter()
      .Double(1, color[0])
      .Double(2, color[1])
      .Double(3, color[2])
      .Double(4, color[3]);
}

// Returns a foxglove.Vector3 or Point3, which have the same fields.
ProtobufWriter VectorMessage(const Eigen::Vector3d& v) {
  return ProtobufWriter().Double(1, v.x()).Double(2, v.y()).Double(3, v.z());
}

ProtobufWriter QuaternionMessage(const Eigen::Quaterniond& q) {
  return ProtobufWriter().Double(1, q.x()).Double(2, q.y()).Double(3, q.z()).Double(4, q.w());
}

void AddPoint2(ProtobufWriter& to, const Eigen::Vector2d& px) {
  to.Message(3, ProtobufWriter().Double(1, px.x()).Double(2, px.y()));
}

void AddStyle(ProtobufWriter& to, const ImageMarks& marks) {
  to.Message(4, ColorMessage(marks.color)).Double(7, marks.thickness);
}

ProtobufWriter EntityMessage(std::int64_t stamp_ns, const LineEntity& entity) {
  constexpr double kThicknessPx = 2;
  ProtobufWriter lines;
  lines.Varint(1, kLineListPrimitive)
      .Message(2, PoseMessage({}))
      .Double(3, kThicknessPx)
      .Varint(4, 1);
  for (std::size_t i = 0; i + 2 < entity.ends.size(); i += 3) {
    lines.Message(5, VectorMessage({entity.ends[i], entity.ends[i + 1], entity.ends[i + 2]}));
  }
  lines.Message(6, ColorMessage({0.76, 0.35, 0.05, 1}));
  ProtobufWriter message;
  message.Message(1, StampMessage(stamp_ns)).Bytes(2, kMapFrame).Bytes(3, entity.id);
  return std::move(message.Message(11, lines));
}

}  // namespace

ProtobufWriter StampMessage(std::int64_t stamp_ns) {
  return ProtobufWriter()
      .Varint(1, static_cast<std::uint64_t>(stamp_ns / kNsPerSecond))
      .Varint(2, static_cast<std::uint64_t>(stamp_ns % kNsPerSecond));
}

ProtobufWriter PoseMessage(const Rigid3& parent_from_frame) {
  return ProtobufWriter()
      .Message(1, VectorMessage(parent_from_frame.translation))
      .Message(2, QuaternionMessage(parent_from_frame.rotation));
}

std::string CompressedImageMessage(std::int64_t stamp_ns,
                                   std::string_view format,
                                   std::string_view data) {
  return ProtobufWriter()
      .Message(1, StampMessage(stamp_ns))
      .Bytes(2, data)
      .Bytes(3, format)
      .Bytes(4, kCameraFrame)
      .Take();
}

std::string CalibrationMessageOf(std::int64_t stamp_ns, const RectifiedCamera& c, CameraSide side) {
  const std::array<double, 9> k = {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
  const std::array<double, 9> r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double shift = side == CameraSide::kRight ? -c.fx * c.baseline : 0;
  const std::array<double, 12> p = {c.fx, 0, c.cx, shift, 0, c.fy, c.cy, 0, 0, 0, 1, 0};
  const std::array<double, 5> d{};
  return ProtobufWriter()
      .Message(1, StampMessage(stamp_ns))
      .Fixed32(2, static_cast<std::uint32_t>(c.width))
      .Fixed32(3, static_cast<std::uint32_t>(c.height))
      .Bytes(4, "plumb_bob")
      .Packed<double>(5, d)
      .Packed<double>(6, k)
      .Packed<double>(7, r)
      .Packed<double>(8, p)
      .Bytes(9, kCameraFrame)
      .Take();
}

std::string PoseInFrameMessage(std::int64_t stamp_ns, const Rigid3& world_from_camera) {
  return ProtobufWriter()
      .Message(1, StampMessage(stamp_ns))
      .Bytes(2, kMapFrame)
      .Message(3, PoseMessage(world_from_camera))
      .Take();
}

std::string TransformMessage(std::int64_t stamp_ns, const Rigid3& world_from_camera) {
  return ProtobufWriter()
      .Message(1, StampMessage(stamp_ns))
      .Bytes(2, kMapFrame)
      .Bytes(3, kCameraFrame)
      .Message(4, VectorMessage(world_from_camera.translation))
      .Message(5, QuaternionMessage(world_from_camera.rotation))
      .Take();
}

std::string AnnotationsMessage(std::int64_t stamp_ns, std::span<const ImageMarks> marks) {
  ProtobufWriter message;
  const ProtobufWriter stamp = StampMessage(stamp_ns);
  for (const ImageMarks& mark : marks) {
    if (!mark.points.empty()) {
      ProtobufWriter points;
      points.Message(1, stamp).Varint(2, kPointsType);
      for (const Eigen::Vector2d& px : mark.points) AddPoint2(points, px);
      AddStyle(points, mark);
      message.Message(2, points);
    }
    if (!mark.segments.empty()) {
      ProtobufWriter lines;
      lines.Message(1, stamp).Varint(2, kLineListType);
      for (const Segment2& segment : mark.segments) {
        AddPoint2(lines, segment.start);
        AddPoint2(lines, segment.end);
      }
      AddStyle(lines, mark);
      message.Message(2, lines);
    }
  }
  return message.Take();
}

std::string PointCloudMessage(std::int64_t stamp_ns, std::span<const float> xyz) {
  ProtobufWriter message;
  message.Message(1, StampMessage(stamp_ns))
      .Bytes(2, kMapFrame)
      .Message(3, PoseMessage({}))
      .Fixed32(4, kBytesPerPoint);
  std::uint32_t offset = 0;
  for (const std::string_view name : {"x", "y", "z"}) {
    message.Message(5, ProtobufWriter().Bytes(1, name).Fixed32(2, offset).Varint(3, kFloat32));
    offset += 4;
  }
  message.Packed<float>(6, xyz);  // bytes, which have the same form on the wire
  return message.Take();
}

std::string SceneUpdateMessage(std::int64_t stamp_ns,
                               std::span<const LineEntity> entities,
                               bool forget_all_others) {
  ProtobufWriter message;
  const ProtobufWriter stamp = StampMessage(stamp_ns);
  if (forget_all_others) {
    message.Message(1, ProtobufWriter().Message(1, stamp).Varint(2, kDeleteAll));
  }
  for (const LineEntity& entity : entities) {
    if (!entity.ends.empty()) {
      message.Message(2, EntityMessage(stamp_ns, entity));
    } else if (!forget_all_others) {
      message.Message(1, ProtobufWriter().Message(1, stamp).Bytes(3, entity.id));
    }
  }
  return message.Take();
}

}  // namespace plumbline
