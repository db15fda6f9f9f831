// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Writes the fields of one message in the wire format of protobuf, in the order of the calls. A
// reader gives missing fields their default value: zero, empty, false.
class ProtobufWriter {
 public:
  // Writes int32, int64, uint32, uint64, bool and enumerations; negative numbers take ten bytes.
  ProtobufWriter& Varint(std::uint32_t field, std::uint64_t value) {
    Tag(field, 0);
    PutVarint(value);
    return *this;
  }
  ProtobufWriter& Double(std::uint32_t field, double value) {
    Tag(field, 1);
    PutFixed(std::bit_cast<std::uint64_t>(value), 8);
    return *this;
  }
  ProtobufWriter& Fixed32(std::uint32_t field, std::uint32_t value) {
    Tag(field, 5);
    PutFixed(value, 4);
    return *this;
  }
  // Writes a text, bytes or a message.
  ProtobufWriter& Bytes(std::uint32_t field, std::string_view bytes) {
    Tag(field, 2);
    PutVarint(bytes.size());
    bytes_ += bytes;
    return *this;
  }
  ProtobufWriter& Message(std::uint32_t field, const ProtobufWriter& message) {
    return Bytes(field, message.bytes_);
  }
  // Writes a packed repeated field of float, double, fixed32 or sfixed32; writes nothing if it is
  // empty.
  template <class T>
  requires std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, std::uint32_t> ||
      std::same_as<T, std::int32_t>
          ProtobufWriter& Packed(std::uint32_t field, std::span<const T> values) {
    if (values.empty()) return *this;
    Tag(field, 2);
    PutVarint(values.size_bytes());
    if constexpr (std::endian::native == std::endian::little) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    } else {
      for (const T value : values) PutNative(value);
    }
    return *this;
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  void Tag(std::uint32_t field, std::uint32_t type) { PutVarint(field << 3U | type); }
  void PutVarint(std::uint64_t value) {
    for (; value >= 128; value >>= 7U) bytes_ += static_cast<char>(value | 128U);
    bytes_ += static_cast<char>(value);
  }
  void PutFixed(std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i));
  }
  template <class T>
  void PutNative(T value) {
    if constexpr (sizeof(T) == 8) {
      PutFixed(std::bit_cast<std::uint64_t>(value), 8);
    } else {
      PutFixed(std::bit_cast<std::uint32_t>(value), 4);
    }
  }

  std::string bytes_;
};

// Messages of Foxglove's schemas in protobuf. The coordinate frames are "map", the world of the
// active map, and "camera", the rectified left camera (x right, y down, z forward); the right
// camera is given by the baseline, as in ROS. Stamps are those of the sensor in nanoseconds.

inline constexpr std::string_view kMapFrame = "map";
inline constexpr std::string_view kCameraFrame = "camera";

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
  std::array<double, 4> color{0, 0, 0, 1};  // red, green, blue and opacity
  double thickness = 1;                     // in pixels
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
