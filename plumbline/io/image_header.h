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

// Returns the size of the image in a PNG, JPEG, WebP, PGM, PPM, PBM, BMP or TIFF file as its header
// tells it, without decoding: a file of a megabyte may hold an image of gigabytes. Returns nullopt
// for files of another kind, and where the header is broken or the size is zero.
std::optional<ImageSize> SizeInHeader(std::span<const std::uint8_t> bytes);

// Whether a PNG file says that its image has one channel of 16 bits, or a PGM file that it has
// levels beyond 255, which are stored in 16 bits. The first bytes of the file are enough.
bool IsGreyOf16Bits(std::span<const std::uint8_t> bytes);

// Returns the EXIF orientation, 1 to 8, that a JPEG, PNG, WebP or TIFF file asks for; 1, as stored,
// where it asks for none. Of JPEG and PNG files the first bytes are enough: what a PNG file has
// behind its pixels is not looked for.
int ExifOrientation(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
