// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/raw_pixels.h"

#include "plumbline/base/printable.h"
#include "plumbline/geometry/plausible_calibration.h"
#include "plumbline/image/opencv_bridge.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

constexpr int kAsItIs = -1;

struct Encoding {
  std::string_view name;
  ImageContents contents;
  int bytes;
  int to_gray;  // code of OpenCV's conversion to grey
};

constexpr std::array<Encoding, 11> kEncodings = {
    {{"mono8", ImageContents::kGray, 1, kAsItIs},
     {"8UC1", ImageContents::kGray, 1, kAsItIs},
     {"rgb8", ImageContents::kGray, 3, cv::COLOR_RGB2GRAY},
     {"bgr8", ImageContents::kGray, 3, cv::COLOR_BGR2GRAY},
     {"8UC3", ImageContents::kGray, 3, cv::COLOR_BGR2GRAY},
     {"rgba8", ImageContents::kGray, 4, cv::COLOR_RGBA2GRAY},
     {"bgra8", ImageContents::kGray, 4, cv::COLOR_BGRA2GRAY},
     {"8UC4", ImageContents::kGray, 4, cv::COLOR_BGRA2GRAY},
     {"mono16", ImageContents::kDepth, 2, kAsItIs},
     {"16UC1", ImageContents::kDepth, 2, kAsItIs},
     {"32FC1", ImageContents::kDepth, 4, kAsItIs}}};

const Encoding* Find(std::string_view name) {
  for (const Encoding& encoding : kEncodings) {
    if (encoding.name == name) return &encoding;
  }
  return nullptr;
}

// Returns why the pixels cannot be used as what is wanted.
std::optional<ImageFailure> Fault(const std::filesystem::path& name,
                                  const RawPixels& pixels,
                                  ImageContents contents,
                                  std::optional<ImageSize> wanted) {
  const Encoding* encoding = Find(pixels.encoding);
  if (encoding == nullptr || encoding->contents != contents) {
    return ImageFailure{name,
                        fmt::format("expected {}, found encoding {}",
                                    contents == ImageContents::kGray ? "an image" : "depth",
                                    InQuotes(pixels.encoding))};
  }
  const auto width = std::uint64_t{pixels.width}, height = std::uint64_t{pixels.height};
  if (width == 0 || height == 0 || width * height > static_cast<std::uint64_t>(kMostPixels)) {
    return ImageFailure{
        name,
        fmt::format("an image of {}x{} pixels, expected some and at most {} million",
                    width,
                    height,
                    kMostPixels / 1'000'000)};
  }
  const ImageSize size{static_cast<int>(width), static_cast<int>(height)};
  if (wanted && size != *wanted) {
    return ImageFailure{name, fmt::format("an image of {}x{} pixels", width, height), size};
  }
  const std::uint64_t row = width * static_cast<std::uint64_t>(encoding->bytes);
  if (pixels.step < row) {
    return ImageFailure{
        name, fmt::format("expected rows of at least {} bytes, found {}", row, pixels.step)};
  }
  const std::uint64_t least = pixels.step * (height - 1) + row;
  if (pixels.data.size() < least) {
    return ImageFailure{
        name, fmt::format("expected {} bytes of pixels, found {}", least, pixels.data.size())};
  }
  return std::nullopt;
}

float MetresAt(const std::uint8_t* at, const RawPixels& pixels, int bytes, double factor) {
  std::uint32_t bits = 0;
  for (int i = 0; i < bytes; ++i) {
    bits |= static_cast<std::uint32_t>(at[pixels.big_endian ? bytes - 1 - i : i]) << (8 * i);
  }
  if (bytes == 2) return static_cast<float>(bits / factor);
  const float metres = std::bit_cast<float>(bits);
  return std::isfinite(metres) && metres > 0 ? metres : 0.0F;
}

}  // namespace

std::optional<ImageContents> ContentsOfEncoding(std::string_view encoding) {
  const Encoding* found = Find(encoding);
  return found == nullptr ? std::nullopt : std::optional(found->contents);
}

int PixelBytes(std::string_view encoding) {
  const Encoding* found = Find(encoding);
  PLUMBLINE_CHECK(found != nullptr, "an encoding that is known");
  return found->bytes;
}

std::string KnownEncodings() { return "mono8, rgb8, bgr8, rgba8, bgra8, 16UC1, mono16 or 32FC1"; }

Expected<GrayImage, ImageFailure> GrayOfPixels(const std::filesystem::path& name,
                                               const RawPixels& pixels,
                                               std::optional<ImageSize> wanted) {
  if (auto fault = Fault(name, pixels, ImageContents::kGray, wanted)) return *std::move(fault);
  const Encoding& encoding = *Find(pixels.encoding);
  GrayImage gray(static_cast<int>(pixels.width), static_cast<int>(pixels.height));
  // OpenCV does not write to what it reads.
  const cv::Mat in(gray.height(),
                   gray.width(),
                   CV_8UC(encoding.bytes),
                   const_cast<std::uint8_t*>(pixels.data.data()),
                   pixels.step);
  cv::Mat out = AsMat(gray);
  if (encoding.to_gray == kAsItIs) {
    in.copyTo(out);
  } else {
    cv::cvtColor(in, out, encoding.to_gray);
  }
  return gray;
}

Expected<ColorImage, ImageFailure> ColorOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 std::optional<ImageSize> wanted) {
  const Encoding* encoding = Find(pixels.encoding);
  if (encoding == nullptr || encoding->to_gray == kAsItIs) {
    const Expected<GrayImage, ImageFailure> gray = GrayOfPixels(name, pixels, wanted);
    if (!gray) return gray.error();
    return ToColor(*gray);
  }
  if (auto fault = Fault(name, pixels, ImageContents::kGray, wanted)) return *std::move(fault);
  const bool red_first =
      encoding->to_gray == cv::COLOR_RGB2GRAY || encoding->to_gray == cv::COLOR_RGBA2GRAY;
  return FromInterleaved(static_cast<int>(pixels.width),
                         static_cast<int>(pixels.height),
                         {pixels.data, pixels.step, encoding->bytes, red_first ? 0 : 2});
}

Expected<DepthImage, ImageFailure> DepthOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 double factor,
                                                 std::optional<ImageSize> wanted) {
  PLUMBLINE_CHECK(factor > 0, "depth factor");
  if (auto fault = Fault(name, pixels, ImageContents::kDepth, wanted)) return *std::move(fault);
  const int bytes = Find(pixels.encoding)->bytes;
  DepthImage depth(static_cast<int>(pixels.width), static_cast<int>(pixels.height));
  for (int y = 0; y < depth.height(); ++y) {
    const std::uint8_t* in =
        pixels.data.data() + std::size_t{pixels.step} * static_cast<std::size_t>(y);
    float* out = depth.row(y);
    for (int x = 0; x < depth.width(); ++x) {
      out[x] = MetresAt(in + static_cast<std::ptrdiff_t>(x) * bytes, pixels, bytes, factor);
    }
  }
  return depth;
}

}  // namespace plumbline
