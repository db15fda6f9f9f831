// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace plumbline {

// Size of an image [px].
struct ImageSize {
  int width = 0, height = 0;

  // Compares width and height.
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

// Failure to read an image file.
struct ImageFailure {
  std::filesystem::path path;
  std::string why;  // e.g. "the file ends early", without the path
  // Set if the only fault is a size other than the wanted one.
  std::optional<ImageSize> other_size = std::nullopt;

  // The code of tables (FrameRecord::reason): "image_size" or "image_unreadable".
  const char* reason() const { return other_size ? "image_size" : "image_unreadable"; }
};

// Returns the size in the header of an image file. Fails like ReadGrayImage.
Expected<ImageSize, ImageFailure> ReadImageSize(const std::filesystem::path& path);

// Returns the EXIF orientation of a file (ExifOrientation); 1, as stored, if it cannot be read.
int ReadExifOrientation(const std::filesystem::path& path);

// Decodes an 8-bit grey image. Colour is converted by 0.299 R + 0.587 G + 0.114 B, in the same way
// for all file types (those of SizeInHeader). Images of 16 bits keep the upper 8. The image is as
// stored, regardless of its EXIF orientation (ReadExifOrientation). An image whose header has a
// size other than `wanted`, or above kMostPixels, is not decoded.
Expected<GrayImage, ImageFailure> ReadGrayImage(const std::filesystem::path& path,
                                                std::optional<ImageSize> wanted = std::nullopt);

// Decodes an image in colour, of 8 bits a channel. An image stored as grey has the grey levels of
// ReadGrayImage in all channels; everything else is as there.
Expected<ColorImage, ImageFailure> ReadColorImage(const std::filesystem::path& path,
                                                  std::optional<ImageSize> wanted = std::nullopt);

// Decodes a mask: 255 where any channel of a pixel has any bit set, at whatever depth, 0 where all
// are zero; transparency does not count. Everything else is as in ReadGrayImage.
Expected<GrayImage, ImageFailure> ReadMask(const std::filesystem::path& path,
                                           std::optional<ImageSize> wanted = std::nullopt);
// Decodes the bytes of a file as ReadMask does; `name` is for failures.
Expected<GrayImage, ImageFailure> DecodeMask(const std::filesystem::path& name,
                                             std::span<const std::uint8_t> bytes,
                                             std::optional<ImageSize> wanted = std::nullopt);

// Returns the brightest level of a PNG or PGM file with one channel of 16 bits; nullopt for any
// other file, and if it cannot be decoded.
std::optional<int> BrightestOf16Bits(const std::filesystem::path& path);
// Returns it for the bytes of a PNG file, as in a recording.
std::optional<int> BrightestOf16Bits(std::span<const std::uint8_t> bytes);

// Decodes a 16-bit depth image of one channel to metres, value / factor; 0 stays 0 (no
// measurement). Fails for any other image. `factor` must be greater than 0 (BugError).
Expected<DepthImage, ImageFailure> ReadDepthImage(const std::filesystem::path& path,
                                                  double factor,
                                                  std::optional<ImageSize> wanted = std::nullopt);

// Decodes the bytes of a file like ReadGrayImage; `name` is for failures. `bits`: the number of
// used bits of 16-bit levels (8 to 16); of these the upper 8 are kept, and brighter levels become
// 255.
Expected<GrayImage, ImageFailure> DecodeGrayImage(const std::filesystem::path& name,
                                                  std::span<const std::uint8_t> bytes,
                                                  std::optional<ImageSize> wanted = std::nullopt,
                                                  int bits = 16);
// Decodes the bytes of a file like ReadColorImage; `name` is for failures.
Expected<ColorImage, ImageFailure> DecodeColorImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    std::optional<ImageSize> wanted = std::nullopt);
// Decodes the bytes of a file like ReadDepthImage; `name` is for failures.
Expected<DepthImage, ImageFailure> DecodeDepthImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    double factor,
                                                    std::optional<ImageSize> wanted = std::nullopt);

// Returns the reason why the bytes of a PNG, JPEG or WebP file are incomplete, from the structure
// of the file without decoding; nullopt if there is none or the type is another one. Decoders
// return half-filled images for incomplete files.
std::optional<std::string> FindDamage(std::span<const std::uint8_t> bytes);

}  // namespace plumbline
