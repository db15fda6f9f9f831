// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/raw_pixels.h"

#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

constexpr int kAsItIs = -1;
constexpr int kNoColor = -2;

struct Encoding {
  std::string_view name;
  ImageContents contents;
  int bytes;
  int to_gray;          // code of OpenCV's conversion to grey
  int to_bgr;           // and to colours; kAsItIs: three or four channels
  bool planes = false;  // behind the grey levels come half as many rows of colours
};

// OpenCV names Bayer patterns after the pixel at (1, 1) and the one right of it.
constexpr std::array<Encoding, 21> kEncodings = {
    {{"mono8", ImageContents::kGray, 1, kAsItIs, kNoColor},
     {"8UC1", ImageContents::kGray, 1, kAsItIs, kNoColor},
     {"rgb8", ImageContents::kGray, 3, cv::COLOR_RGB2GRAY, kAsItIs},
     {"bgr8", ImageContents::kGray, 3, cv::COLOR_BGR2GRAY, kAsItIs},
     {"8UC3", ImageContents::kGray, 3, cv::COLOR_BGR2GRAY, kAsItIs},
     {"rgba8", ImageContents::kGray, 4, cv::COLOR_RGBA2GRAY, kAsItIs},
     {"bgra8", ImageContents::kGray, 4, cv::COLOR_BGRA2GRAY, kAsItIs},
     {"8UC4", ImageContents::kGray, 4, cv::COLOR_BGRA2GRAY, kAsItIs},
     {"bayer_rggb8", ImageContents::kGray, 1, cv::COLOR_BayerBG2GRAY, cv::COLOR_BayerBG2BGR},
     {"bayer_bggr8", ImageContents::kGray, 1, cv::COLOR_BayerRG2GRAY, cv::COLOR_BayerRG2BGR},
     {"bayer_gbrg8", ImageContents::kGray, 1, cv::COLOR_BayerGR2GRAY, cv::COLOR_BayerGR2BGR},
     {"bayer_grbg8", ImageContents::kGray, 1, cv::COLOR_BayerGB2GRAY, cv::COLOR_BayerGB2BGR},
     {"yuv422", ImageContents::kGray, 2, cv::COLOR_YUV2GRAY_UYVY, cv::COLOR_YUV2BGR_UYVY},
     {"uyvy", ImageContents::kGray, 2, cv::COLOR_YUV2GRAY_UYVY, cv::COLOR_YUV2BGR_UYVY},
     {"yuv422_yuy2", ImageContents::kGray, 2, cv::COLOR_YUV2GRAY_YUY2, cv::COLOR_YUV2BGR_YUY2},
     {"yuyv", ImageContents::kGray, 2, cv::COLOR_YUV2GRAY_YUY2, cv::COLOR_YUV2BGR_YUY2},
     {"nv12", ImageContents::kGray, 1, kAsItIs, cv::COLOR_YUV2BGR_NV12, true},
     {"nv21", ImageContents::kGray, 1, kAsItIs, cv::COLOR_YUV2BGR_NV21, true},
     {"mono16", ImageContents::kDepth, 2, kAsItIs, kNoColor},
     {"16UC1", ImageContents::kDepth, 2, kAsItIs, kNoColor},
     {"32FC1", ImageContents::kDepth, 4, kAsItIs, kNoColor}}};

const Encoding* Find(std::string_view name) {
  for (const Encoding& encoding : kEncodings) {
    if (encoding.name == name) return &encoding;
  }
  return nullptr;
}

// Returns the reason why the pixels are unusable for the wanted contents.
std::optional<ImageFailure> Fault(const std::filesystem::path& name,
                                  const RawPixels& pixels,
                                  ImageContents contents,
                                  std::optional<ImageSize> wanted,
                                  bool deep = false) {
  const Encoding* encoding = Find(pixels.encoding);
  const bool fits = encoding != nullptr &&
                    (encoding->contents == contents || (deep && Is16BitGray(pixels.encoding)));
  if (!fits) {
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
  const auto rows = static_cast<std::uint64_t>(PixelRows(pixels.encoding, size.height));
  const std::uint64_t least = pixels.step * (rows - 1) + row;
  if (pixels.data.size() < least) {
    return ImageFailure{
        name, fmt::format("expected {} bytes of pixels, found {}", least, pixels.data.size())};
  }
  return std::nullopt;
}

int LevelAt(const std::uint8_t* at, bool big_endian) {
  return at[big_endian ? 1 : 0] | (at[big_endian ? 0 : 1] << 8);
}

const std::uint8_t* RowOf(const RawPixels& pixels, int y) {
  return pixels.data.data() + std::size_t{pixels.step} * static_cast<std::size_t>(y);
}

GrayImage GrayOf16Bits(const RawPixels& pixels, int bits) {
  GrayImage gray(static_cast<int>(pixels.width), static_cast<int>(pixels.height));
  for (int y = 0; y < gray.height(); ++y) {
    const std::uint8_t* in = RowOf(pixels, y);
    std::uint8_t* out = gray.row(y);
    for (int x = 0; x < gray.width(); ++x, in += 2) {
      out[x] =
          static_cast<std::uint8_t>(std::min(LevelAt(in, pixels.big_endian) >> (bits - 8), 255));
    }
  }
  return gray;
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

bool Is16BitGray(std::string_view encoding) { return encoding == "mono16" || encoding == "16UC1"; }

int PixelRows(std::string_view encoding, int height) {
  const Encoding* found = Find(encoding);
  return found != nullptr && found->planes ? height + (height + 1) / 2 : height;
}

std::string EncodingsOf(ImageContents contents) {
  std::vector<std::string_view> names;
  for (const Encoding& encoding : kEncodings) {
    if (encoding.contents == contents) names.push_back(encoding.name);
  }
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

Expected<GrayImage, ImageFailure> GrayOfPixels(const std::filesystem::path& name,
                                               const RawPixels& pixels,
                                               std::optional<ImageSize> wanted,
                                               std::optional<int> bits) {
  PLUMBLINE_CHECK(!bits || (*bits >= 8 && *bits <= 16), "bits of a level");
  if (auto fault = Fault(name, pixels, ImageContents::kGray, wanted, bits.has_value())) {
    return *std::move(fault);
  }
  if (Is16BitGray(pixels.encoding)) return GrayOf16Bits(pixels, *bits);
  const Encoding& encoding = *Find(pixels.encoding);
  GrayImage gray(static_cast<int>(pixels.width), static_cast<int>(pixels.height));
  // OpenCV does not write to its input.
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

std::optional<int> BrightestOf16Bits(const RawPixels& pixels) {
  if (!Is16BitGray(pixels.encoding)) return std::nullopt;
  if (Fault("", pixels, ImageContents::kDepth, std::nullopt)) return std::nullopt;
  int brightest = 0;
  for (int y = 0; y < static_cast<int>(pixels.height); ++y) {
    const std::uint8_t* in = RowOf(pixels, y);
    for (std::uint32_t x = 0; x < pixels.width; ++x, in += 2) {
      brightest = std::max(brightest, LevelAt(in, pixels.big_endian));
    }
  }
  return brightest;
}

Expected<ColorImage, ImageFailure> ColorOfPixels(const std::filesystem::path& name,
                                                 const RawPixels& pixels,
                                                 std::optional<ImageSize> wanted,
                                                 std::optional<int> bits) {
  const Encoding* encoding = Find(pixels.encoding);
  if (encoding == nullptr || encoding->to_bgr == kNoColor) {
    const Expected<GrayImage, ImageFailure> gray = GrayOfPixels(name, pixels, wanted, bits);
    if (!gray) return gray.error();
    return ToColor(*gray);
  }
  if (auto fault = Fault(name, pixels, ImageContents::kGray, wanted)) return *std::move(fault);
  const int width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
  if (encoding->to_bgr == kAsItIs) {
    const bool red_first =
        encoding->to_gray == cv::COLOR_RGB2GRAY || encoding->to_gray == cv::COLOR_RGBA2GRAY;
    return FromInterleaved(
        width, height, {pixels.data, pixels.step, encoding->bytes, red_first ? 0 : 2});
  }
  // OpenCV does not write to its input.
  const cv::Mat in(PixelRows(pixels.encoding, height),
                   width,
                   CV_8UC(encoding->bytes),
                   const_cast<std::uint8_t*>(pixels.data.data()),
                   pixels.step);
  cv::Mat bgr;
  cv::cvtColor(in, bgr, encoding->to_bgr);
  const std::size_t size = bgr.step * static_cast<std::size_t>(bgr.rows);
  return FromInterleaved(width, height, {{bgr.data, size}, bgr.step});
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
    const std::uint8_t* in = RowOf(pixels, y);
    float* out = depth.row(y);
    for (int x = 0; x < depth.width(); ++x) {
      out[x] = MetresAt(in + static_cast<std::ptrdiff_t>(x) * bytes, pixels, bytes, factor);
    }
  }
  return depth;
}

}  // namespace plumbline
