// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/recordings/recording.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

enum class MessageKind { kImage, kCompressedImage, kCalibration, kInertial };
enum class MessageEncoding { kRos1, kCdr, kProtobuf };

// Form of a channel's messages, as far as supported.
struct MessageForm {
  MessageKind kind = MessageKind::kImage;
  MessageEncoding encoding = MessageEncoding::kRos1;
};

// An image as sent. Its fields are not checked against one another.
struct ImageMessage {
  std::int64_t stamp_ns = 0;  // stamp of the sensor; 0 if not set
  bool compressed = false;    // `data` is an image file
  // "mono8", "bgr8"; for a compressed image its format: "jpeg".
  std::string encoding;
  // The size in pixels of images that are not compressed, and the bytes from row to row.
  std::uint32_t width = 0, height = 0, step = 0;
  bool big_endian = false;
  std::span<const std::uint8_t> data;  // points into the message that was parsed
  std::string frame;  // coordinate frame of the camera (frame_id); empty if not set
};

// Camera parameters in the form of sensor_msgs/CameraInfo.
struct CalibrationMessage {
  std::uint32_t width = 0, height = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;                         // 0 is 1
  std::uint32_t roi_x = 0, roi_y = 0, roi_width = 0, roi_height = 0;  // all 0: the whole image
};

// A measurement in the form of sensor_msgs/Imu, without its orientation.
struct InertialMessage {
  std::int64_t stamp_ns = 0;  // 0 if not set
  std::array<double, 3> angular_rate{}, specific_force{};
  // False where the covariance begins with -1, which marks what is not measured.
  bool has_rate = true, has_force = true;
};

// Returns the form of a channel's messages: sensor_msgs/Image, CompressedImage, CameraInfo and Imu
// of ROS 1 and (with /msg/, as CDR) ROS 2, foxglove.RawImage, CompressedImage and CameraCalibration
// as protobuf; nullopt for all others.
std::optional<MessageForm> FormOf(const Channel& channel);

// Return nullopt if the bytes are no message of this form. `form` must be that of an image, or of a
// calibration.
std::optional<ImageMessage> ParseImage(MessageForm form, std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseCalibration(MessageForm form,
                                                   std::span<const std::uint8_t> bytes);

// Parse messages of ROS, field after field. Those of ROS 1 have no gaps (wiki.ros.org/msg). Those
// of ROS 2 are CDR of either byte order (OMG, DDS-XTypes 1.3, 7.4.3): numbers at multiples of their
// size, texts with a zero at their end, all after four bytes that name the encoding. Return nullopt
// if the bytes end early, or if these four bytes name another encoding.
std::optional<ImageMessage> ParseRosImage(bool cdr,
                                          bool compressed,
                                          std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseRosCalibration(bool cdr,
                                                      std::span<const std::uint8_t> bytes);
std::optional<InertialMessage> ParseRosInertial(bool cdr, std::span<const std::uint8_t> bytes);
// Nanoseconds of a rosgraph_msgs/Clock.
std::optional<std::int64_t> ParseRosClock(bool cdr, std::span<const std::uint8_t> bytes);

// Parse messages of Foxglove's schemas (foxglove.RawImage, CompressedImage, CameraCalibration) in
// the wire format of Protocol Buffers (protobuf.dev/programming-guides/encoding). Unknown fields
// are skipped; missing ones have their default. Return nullopt if the bytes are malformed.
std::optional<ImageMessage> ParseProtobufImage(bool compressed,
                                               std::span<const std::uint8_t> bytes);
std::optional<CalibrationMessage> ParseProtobufCalibration(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
