// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"
#include "plumbline/io/image_header.h"

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
  // Set where the file is of another size than wanted, and nothing else is wrong with it.
  std::optional<ImageSize> other_size = std::nullopt;
};

// Returns the size that the header of an image file tells. Fails as ReadGrayImage does.
Expected<ImageSize, ImageFailure> ReadImageSize(const std::filesystem::path& path);

// Returns the EXIF orientation that a file asks for (image_header.h); 1, as stored, where it cannot
// be read.
int ReadExifOrientation(const std::filesystem::path& path);

// Decodes an 8-bit grey image. Colour is converted by 0.299 R + 0.587 G + 0.114 B, in the same way
// for all file types (those of image_header.h). Images of 16 bits keep the upper 8. The image is as
// stored, whatever orientation its EXIF data ask for (ReadExifOrientation). An image whose header
// tells another size than `wanted`, or more than kMostPixels, is not decoded.
Expected<GrayImage, ImageFailure> ReadGrayImage(const std::filesystem::path& path,
                                                std::optional<ImageSize> wanted = std::nullopt);

// Decodes an image in colour, of 8 bits a channel. One that is stored grey has the grey levels of
// ReadGrayImage in all channels; all else is as there.
Expected<ColorImage, ImageFailure> ReadColorImage(const std::filesystem::path& path,
                                                  std::optional<ImageSize> wanted = std::nullopt);

// Returns the brightest level of a PNG or PGM file with one channel of 16 bits; nullopt for any
// other file, and where it cannot be decoded.
std::optional<int> BrightestOf16Bits(const std::filesystem::path& path);
// Returns the brightest level of such a PNG file that is given as bytes, as a recording holds it.
std::optional<int> BrightestOf16Bits(std::span<const std::uint8_t> bytes);

// Decodes a 16-bit depth image of one channel to metres, value / factor; 0 stays 0 (no
// measurement). Fails for any other image. `factor` must be greater than 0 (BugError).
Expected<DepthImage, ImageFailure> ReadDepthImage(const std::filesystem::path& path,
                                                  double factor,
                                                  std::optional<ImageSize> wanted = std::nullopt);

// Decodes the bytes of a file as ReadGrayImage decodes the file; `name` is for failures. `bits`:
// how many of the 16 bits of a level are used (8 to 16); of these the upper 8 are kept, and
// brighter levels become 255.
Expected<GrayImage, ImageFailure> DecodeGrayImage(const std::filesystem::path& name,
                                                  std::span<const std::uint8_t> bytes,
                                                  std::optional<ImageSize> wanted = std::nullopt,
                                                  int bits = 16);
// Decodes the bytes of a file as ReadColorImage decodes the file; `name` is for failures.
Expected<ColorImage, ImageFailure> DecodeColorImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    std::optional<ImageSize> wanted = std::nullopt);
// Decodes the bytes of a file as ReadDepthImage decodes the file; `name` is for failures.
Expected<DepthImage, ImageFailure> DecodeDepthImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    double factor,
                                                    std::optional<ImageSize> wanted = std::nullopt);

// Returns why the bytes of a PNG, JPEG or WebP file cannot be complete, found from the structure of
// the file without decoding; nullopt where nothing is wrong or the type is another one. Decoders
// return half-filled images for such files.
std::optional<std::string> FindDamage(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
