// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/image/image.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace plumbline {

// An image file that gave no image.
struct ImageFailure {
  std::filesystem::path path;
  std::string why;  // e.g. "the file ends early", without the path
};

// Decodes an 8-bit grey image; colour is converted by 0.299 R + 0.587 G + 0.114 B, in the same way
// whatever the file type. An EXIF orientation is ignored: the calibration is of the raw pixels.
Expected<GrayImage, ImageFailure> ReadGrayImage(const std::filesystem::path& path);

// Decodes a 16-bit depth image to metres, value / factor; 0 stays 0 (no measurement).
Expected<DepthImage, ImageFailure> ReadDepthImage(const std::filesystem::path& path, double factor);

// Why the bytes of a PNG, JPEG or WebP file cannot be whole, found from the structure of the file
// without decoding; nullopt where nothing is wrong or the type is another one. Decoders return
// half-filled images for such files.
std::optional<std::string> FindDamage(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
