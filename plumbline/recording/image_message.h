// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

enum class MessageKind { kImage, kCompressedImage, kCalibration };
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

}  // namespace plumbline
