// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline {

struct ImageSize {
  int width = 0, height = 0;

  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

// Returns the size in the header of a PNG, JPEG, WebP, PGM, PPM, PBM, BMP or TIFF file, without
// decoding: a file of a megabyte may contain an image of gigabytes. Returns nullopt for files of
// another kind, and if the header is broken or the size is zero.
std::optional<ImageSize> SizeInHeader(std::span<const std::uint8_t> bytes);

// Returns true for a PNG file with one channel of 16 bits, or a PGM file with levels beyond 255,
// which are stored in 16 bits. The first bytes of the file are enough.
bool IsGreyOf16Bits(std::span<const std::uint8_t> bytes);

// Returns the EXIF orientation, 1 to 8, of a JPEG, PNG, WebP or TIFF file; 1, as stored, if it has
// none. Of JPEG and PNG files the first bytes are enough: data after the pixels of a PNG file are
// ignored.
int ExifOrientation(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
