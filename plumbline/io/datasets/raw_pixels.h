// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"
#include "plumbline/io/datasets/image_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// Meaning of the pixels of an image.
enum class ImageContents { kGray, kDepth };

// Returns the meaning of the pixels of an encoding. Encodings are named and ordered as by ROS,
// Foxglove and the stream of standard input: mono8, rgb8, bgr8, rgba8, bgra8 (8UC1, 8UC3, 8UC4 as
// mono8, bgr8, bgra8), bayer_rggb8, bayer_bggr8, bayer_gbrg8, bayer_grbg8, yuv422 (uyvy),
// yuv422_yuy2 (yuyv), nv12 and nv21, whose grey levels are used unchanged; depth as mono16, 16UC1
// or 32FC1 (metres). Returns nullopt for all other encodings.
std::optional<ImageContents> ContentsOfEncoding(std::string_view encoding);
// Returns the bytes of a pixel, for an encoding known to ContentsOfEncoding.
int PixelBytes(std::string_view encoding);
// Returns the rows of bytes of an image: in nv12 and nv21 colours follow the grey levels.
int PixelRows(std::string_view encoding, int height);
// Returns true for pixels with one channel of 16 bits, which may also be grey levels.
bool Is16BitGray(std::string_view encoding);
// Returns the names of the encodings with these contents, for messages: "mono16, 16UC1 or 32FC1".
std::string EncodingsOf(ImageContents contents);

// Rows of pixels from top to bottom, `step` bytes apart.
struct RawPixels {
  std::string encoding;
  std::uint32_t width = 0, height = 0, step = 0;
  bool big_endian = false;
  std::span<const std::uint8_t> data;
};

// Converts pixels of an encoding to grey; colour becomes grey as in ReadGrayImage. Failures, named
// by `name`: another encoding, inconsistent sizes, a size other than `wanted`. With `bits` (8 to
// 16), 16 bits of one channel are grey levels with this number of used bits: the upper 8 of these
// are kept, and brighter levels become 255.
Expected<GrayImage, ImageFailure> GrayOfPixels(const std::filesystem::path& name,
                                               const RawPixels& pixels,
                                               std::optional<ImageSize> wanted,
                                               std::optional<int> bits = std::nullopt);
// Returns the brightest level of pixels of 16 bits and one channel; nullopt for others, and if
// GrayOfPixels would fail.
std::optional<int> BrightestOf16Bits(const RawPixels& pixels);
// Converts pixels of an encoding to colours; grey ones have the same in all channels. Failures are
// those of GrayOfPixels.
Expected<ColorImage, ImageFailure> ColorOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 std::optional<ImageSize> wanted,
                                                 std::optional<int> bits = std::nullopt);
// Converts pixels to depth. 16 bits: value / factor; 32FC1: metres, in which values that are not
// finite or not positive mean no measurement (0).
Expected<DepthImage, ImageFailure> DepthOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 double factor,
                                                 std::optional<ImageSize> wanted);

}  // namespace plumbline
