// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/message_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

namespace plumbline {
namespace {

constexpr std::size_t kCompressedDepthHeader = 12;

// Depth in metres that image_transport's compressedDepth packed: before the image stand, behind 4
// bytes, the numbers a and b by which a level v is a / (v - b) metres. 0 is no measurement.
Expected<DepthImage, ImageFailure> DecodeInverseDepth(const std::filesystem::path& name,
                                                      std::span<const std::uint8_t> bytes,
                                                      std::optional<ImageSize> wanted) {
  if (bytes.size() < kCompressedDepthHeader) return ImageFailure{name, "the message ends early"};
  const auto number = [&](std::size_t at) {
    std::uint32_t bits = 0;
    for (std::size_t i = 4; i-- > 0;) bits = (bits << 8U) | bytes[at + i];
    return std::bit_cast<float>(bits);
  };
  const float a = number(4), b = number(8);
  auto depth = DecodeDepthImage(name, bytes.subspan(kCompressedDepthHeader), 1, wanted);
  if (!depth) return depth;
  for (int y = 0; y < depth->height(); ++y) {
    float* row = depth->row(y);
    for (int x = 0; x < depth->width(); ++x) {
      const float metres = row[x] == 0 ? 0 : a / (row[x] - b);
      row[x] = std::isfinite(metres) && metres > 0 ? metres : 0;
    }
  }
  return depth;
}

}  // namespace

RawPixels PixelsOf(const ImageMessage& image) {
  return {image.encoding, image.width, image.height, image.step, image.big_endian, image.data};
}

bool IsInMetres(std::string_view encoding) { return encoding.starts_with("32FC1"); }

Expected<GrayImage, ImageFailure> GrayOfMessage(const std::filesystem::path& name,
                                                const ImageMessage& image,
                                                std::optional<ImageSize> wanted,
                                                std::optional<int> bits) {
  if (image.compressed) return DecodeGrayImage(name, image.data, wanted, bits.value_or(16));
  return GrayOfPixels(name, PixelsOf(image), wanted, bits);
}

Expected<GrayImage, ImageFailure> MaskOfMessage(const std::filesystem::path& name,
                                                const ImageMessage& image,
                                                std::optional<ImageSize> wanted) {
  constexpr int kLowestBits = 8;  // of 16: a level of 1 is not rounded to 0
  if (image.compressed) return DecodeMask(name, image.data, wanted);
  const auto color = ColorOfPixels(name, PixelsOf(image), wanted, kLowestBits);
  if (!color) return color.error();
  GrayImage mask(color->width(), color->height());
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const Color pixel = color->at(x, y);
      mask.at(x, y) = (pixel.r | pixel.g | pixel.b) != 0 ? 255 : 0;
    }
  }
  return mask;
}

Expected<DepthImage, ImageFailure> DepthOfMessage(const std::filesystem::path& name,
                                                  const ImageMessage& image,
                                                  double factor,
                                                  std::optional<ImageSize> wanted) {
  if (!image.compressed) return DepthOfPixels(name, PixelsOf(image), factor, wanted);
  std::span<const std::uint8_t> bytes = image.data;
  if (image.encoding.find("compressedDepth") != std::string::npos) {
    if (IsInMetres(image.encoding)) return DecodeInverseDepth(name, bytes, wanted);
    bytes = bytes.subspan(std::min(bytes.size(), kCompressedDepthHeader));
  }
  return DecodeDepthImage(name, bytes, factor, wanted);
}

}  // namespace plumbline
