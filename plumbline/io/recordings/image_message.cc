// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/image_message.h"

#include <string_view>

namespace plumbline {
namespace {

struct KnownType {
  std::string_view type;
  MessageKind kind;
};

constexpr std::array<KnownType, 4> kRosTypes = {
    {{"sensor_msgs/Image", MessageKind::kImage},
     {"sensor_msgs/CompressedImage", MessageKind::kCompressedImage},
     {"sensor_msgs/CameraInfo", MessageKind::kCalibration},
     {"sensor_msgs/Imu", MessageKind::kInertial}}};
constexpr std::array<KnownType, 4> kRos2Types = {
    {{"sensor_msgs/msg/Image", MessageKind::kImage},
     {"sensor_msgs/msg/CompressedImage", MessageKind::kCompressedImage},
     {"sensor_msgs/msg/CameraInfo", MessageKind::kCalibration},
     {"sensor_msgs/msg/Imu", MessageKind::kInertial}}};
constexpr std::array<KnownType, 3> kFoxgloveTypes = {
    {{"foxglove.RawImage", MessageKind::kImage},
     {"foxglove.CompressedImage", MessageKind::kCompressedImage},
     {"foxglove.CameraCalibration", MessageKind::kCalibration}}};

struct KnownEncoding {
  std::string_view name;
  MessageEncoding encoding;
  std::span<const KnownType> types;
};

}  // namespace

std::optional<MessageForm> FormOf(const Channel& channel) {
  const KnownEncoding known[] = {{"ros1", MessageEncoding::kRos1, kRosTypes},
                                 {"cdr", MessageEncoding::kCdr, kRos2Types},
                                 {"protobuf", MessageEncoding::kProtobuf, kFoxgloveTypes}};
  for (const KnownEncoding& encoding : known) {
    if (channel.encoding != encoding.name) continue;
    for (const auto& [type, kind] : encoding.types) {
      if (channel.type == type) return MessageForm{kind, encoding.encoding};
    }
  }
  return std::nullopt;
}

std::optional<ImageMessage> ParseImage(MessageForm form, std::span<const std::uint8_t> bytes) {
  PLUMBLINE_CHECK(form.kind == MessageKind::kImage || form.kind == MessageKind::kCompressedImage,
                  "an image is wanted");
  const bool compressed = form.kind == MessageKind::kCompressedImage;
  if (form.encoding == MessageEncoding::kProtobuf) return ParseProtobufImage(compressed, bytes);
  return ParseRosImage(form.encoding == MessageEncoding::kCdr, compressed, bytes);
}

std::optional<CalibrationMessage> ParseCalibration(MessageForm form,
                                                   std::span<const std::uint8_t> bytes) {
  PLUMBLINE_CHECK(form.kind == MessageKind::kCalibration, "a calibration is wanted");
  if (form.encoding == MessageEncoding::kProtobuf) return ParseProtobufCalibration(bytes);
  return ParseRosCalibration(form.encoding == MessageEncoding::kCdr, bytes);
}

}  // namespace plumbline
