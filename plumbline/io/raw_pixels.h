// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/io/image_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// What an image shows.
enum class ImageContents { kGray, kDepth };

// Pixels as ROS, Foxglove and the stream of standard input name and order them: mono8, rgb8, bgr8,
// rgba8, bgra8 (8UC1, 8UC3, 8UC4 as mono8, bgr8, bgra8); depth as mono16, 16UC1 or 32FC1 (metres).
// nullopt for all other encodings.
std::optional<ImageContents> ContentsOfEncoding(std::string_view encoding);
// Bytes of a pixel, of an encoding that ContentsOfEncoding knows.
int PixelBytes(std::string_view encoding);
// The encodings, for messages.
std::string KnownEncodings();

// Rows of pixels, top to bottom, each `step` bytes behind the one before.
struct RawPixels {
  std::string encoding;
  std::uint32_t width = 0, height = 0, step = 0;
  bool big_endian = false;
  std::span<const std::uint8_t> data;
};

// Copies pixels of an encoding for what they are to be; colour becomes grey as in ReadGrayImage.
// Failures, by `name`: another encoding, sizes that do not go together, another size than `wanted`.
Expected<GrayImage, ImageFailure> GrayOfPixels(const std::filesystem::path& name,
                                               const RawPixels& pixels,
                                               std::optional<ImageSize> wanted);
// 16 bits: value / factor; 32FC1: metres, where what is not finite or not positive is no
// measurement (0).
Expected<DepthImage, ImageFailure> DepthOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 double factor,
                                                 std::optional<ImageSize> wanted);

}  // namespace plumbline
