// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/plain_png.h"

#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/processor.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <libdeflate.h>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

enum PngFilter : std::uint8_t { kUnfiltered, kSub, kUp, kAverage, kPaeth };

// A pixel's neighbours to the left, above, and left of that above predict it.
std::uint8_t PaethPrediction(int left, int above, int above_left) {
  const int to_left = std::abs(above - above_left);
  const int to_above = std::abs(left - above_left);
  const int to_above_left = std::abs(left + above - 2 * above_left);
  int nearest = to_above <= to_above_left ? above : above_left;
  if (to_left <= std::min(to_above, to_above_left)) nearest = left;
  return static_cast<std::uint8_t>(nearest);
}

// Undoes the filter of one row.
template <std::size_t kPixelBytes>
void UndoRow(std::uint8_t filter,
             const std::uint8_t* in,
             const std::uint8_t* above,
             std::size_t size,
             std::uint8_t* out) {
  std::array<std::uint8_t, kPixelBytes> left{}, above_left{};
  const auto predict = [&](auto prediction) {
    for (std::size_t i = 0; i < size; i += kPixelBytes) {
      for (std::size_t c = 0; c < kPixelBytes; ++c) {
        const std::uint8_t up = above[i + c];
        left[c] = static_cast<std::uint8_t>(in[i + c] + prediction(left[c], up, above_left[c]));
        above_left[c] = up;
        out[i + c] = left[c];
      }
    }
  };
  switch (filter) {
    case kUnfiltered:
      std::memcpy(out, in, size);
      break;
    case kSub:
      predict([](int a, int, int) { return a; });
      break;
    case kUp:
      for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(in[i] + above[i]);
      break;
    case kAverage:
      predict([](int a, int b, int) { return (a + b) / 2; });
      break;
    default:
      predict(PaethPrediction);
  }
}

// Undoes the filters of eight rows together. A pixel needs its left neighbour first, so that one
// row is a chain of operations that wait for each other; here lane k of a vector works on row k, k
// pixels behind row 0, where all that it needs is known from the step before.
template <int kPixelBytes>
struct UndoEightRows {
  static constexpr int kRows = 8;
  using Lanes [[gnu::vector_size(2 * kRows)]] = std::int16_t;

  // above: the row above, readable for kRows pixels more. width: in pixels.
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* filtered,
                                                const std::uint8_t* above,
                                                std::ptrdiff_t width,
                                                std::uint8_t* out) {
    UndoEightRows rows(filtered, above, width, out);
    const std::ptrdiff_t steps = width + kRows - 1;
    std::ptrdiff_t step = 0;
    for (; step < std::min<std::ptrdiff_t>(kRows - 1, steps); ++step) rows.Step<true>(step);
    for (; step < width; ++step) rows.Step<false>(step);
    for (; step < steps; ++step) rows.Step<true>(step);
  }

 private:
  [[gnu::always_inline]] inline UndoEightRows(const std::uint8_t* filtered,
                                              const std::uint8_t* above,
                                              std::ptrdiff_t width,
                                              std::uint8_t* out)
      : above_(above), width_(width) {
    for (int k = 0; k < kRows; ++k) {
      const std::ptrdiff_t size = width * kPixelBytes;
      const std::uint8_t* row = filtered + k * (size + 1);
      sub_[k] = row[0] == kSub ? -1 : 0;
      up_[k] = row[0] == kUp ? -1 : 0;
      average_[k] = row[0] == kAverage ? -1 : 0;
      paeth_[k] = row[0] == kPaeth ? -1 : 0;
      in_[k] = row + 1 - k * kPixelBytes;
      out_[k] = out + k * size - k * kPixelBytes;
    }
  }

  [[gnu::always_inline]] static inline Lanes Magnitude(Lanes value) {
    return value < 0 ? -value : value;
  }

  // kEnds: some lanes are not in the image yet, or no more.
  template <bool kEnds>
  [[gnu::always_inline]] inline void Step(std::ptrdiff_t step) {
    for (int c = 0; c < kPixelBytes; ++c) {
      const std::ptrdiff_t at = step * kPixelBytes + c;
      const Lanes coded{in_[0][at],
                        in_[1][at],
                        in_[2][at],
                        in_[3][at],
                        in_[4][at],
                        in_[5][at],
                        in_[6][at],
                        in_[7][at]};
      const Lanes left = left_[c];
      const Lanes above_left = above_left_[c];
      Lanes above = __builtin_shufflevector(left, left, 0, 0, 1, 2, 3, 4, 5, 6);
      above[0] = above_[at];
      const Lanes to_left = Magnitude(above - above_left);
      const Lanes to_above = Magnitude(left - above_left);
      const Lanes to_above_left = Magnitude(left + above - 2 * above_left);
      const Lanes least = to_above < to_above_left ? to_above : to_above_left;
      Lanes nearest = to_above <= to_above_left ? above : above_left;
      nearest = to_left <= least ? left : nearest;
      const Lanes predicted =
          (left & sub_) | (above & up_) | (((left + above) >> 1) & average_) | (nearest & paeth_);
      Lanes pixel = (coded + predicted) & 255;
      for (int k = 0; kEnds && k < kRows; ++k) {
        if (k > step) pixel[k] = 0;
      }
      above_left_[c] = above;
      left_[c] = pixel;
      for (int k = 0; k < kRows; ++k) {
        if (kEnds && (k > step || step - k >= width_)) continue;
        out_[k][at] = static_cast<std::uint8_t>(pixel[k]);
      }
    }
  }

  const std::uint8_t* above_;
  std::ptrdiff_t width_;
  Lanes sub_{}, up_{}, average_{}, paeth_{};  // all bits of the rows that have the filter
  const std::uint8_t* in_[kRows];             // pixel of each lane in step 0
  std::uint8_t* out_[kRows];
  Lanes left_[kPixelBytes]{}, above_left_[kPixelBytes]{};
};

template <int kPixelBytes>
bool UndoFilters(std::span<const std::uint8_t> filtered,
                 std::size_t width,
                 std::size_t height,
                 std::uint8_t* out) {
  using Eight = UndoEightRows<kPixelBytes>;
  const std::size_t size = width * kPixelBytes;
  const auto filter = [&](std::size_t y) { return filtered[y * (size + 1)]; };
  const std::vector<std::uint8_t> nothing(size + Eight::kRows * kPixelBytes);
  for (std::size_t y = 0; y < height;) {
    const std::uint8_t* above = y == 0 ? nothing.data() : out + (y - 1) * size;
    const std::uint8_t* row = &filtered[y * (size + 1)];
    bool together = y + Eight::kRows <= height;
    bool slow = false;  // a row that takes long by itself
    for (std::size_t k = 0; together && k < Eight::kRows; ++k) {
      together = filter(y + k) <= kPaeth;
      slow = slow || filter(y + k) >= kAverage;
    }
    if (together && slow) {
      RunBest<Eight>(row, above, static_cast<std::ptrdiff_t>(width), out + y * size);
      y += Eight::kRows;
    } else {
      if (row[0] > kPaeth) return false;
      UndoRow<kPixelBytes>(row[0], row + 1, above, size, out + y * size);
      ++y;
    }
  }
  return true;
}

std::uint32_t Number(std::span<const std::uint8_t> bytes, std::size_t at) {
  return (std::uint32_t{bytes[at]} << 24U) | (std::uint32_t{bytes[at + 1]} << 16U) |
         (std::uint32_t{bytes[at + 2]} << 8U) | std::uint32_t{bytes[at + 3]};
}

struct PlainPng {
  std::size_t width = 0;
  std::size_t height = 0;
  int channels = 0;
  int channel_bytes = 0;
  std::vector<std::uint8_t> compressed;

  std::size_t FilteredSize() const {
    return height * (width * static_cast<std::size_t>(channels * channel_bytes) + 1);
  }
};

// Takes the data of the chunk IHDR. Returns false for kinds that are not decoded here.
bool TakeHeader(std::span<const std::uint8_t> data, PlainPng& png) {
  constexpr std::size_t kSize = 13;
  if (data.size() != kSize) return false;
  png.width = Number(data, 0);
  png.height = Number(data, 4);
  const int depth = data[8], color = data[9], method = data[10] | data[11] | data[12];
  constexpr int kGrey = 0, kRgb = 2, kRgba = 6;
  png.channels = color == kGrey ? 1 : color == kRgb ? 3 : color == kRgba ? 4 : 0;
  png.channel_bytes = depth / 8;
  constexpr std::size_t kLongest = 1U << 20U;
  return (depth == 8 || (depth == 16 && color == kGrey)) && png.channels > 0 && method == 0 &&
         png.width > 0 && png.height > 0 && png.width < kLongest && png.height < kLongest;
}

// Reads the chunks: the header, the data in one piece, the end, and between them chunks that do not
// change the pixels.
std::optional<PlainPng> ReadChunks(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (bytes.size() < kSignature.size() ||
      std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0) {
    return std::nullopt;
  }
  PlainPng png;
  std::string_view before;  // type of the chunk before
  for (std::size_t at = kSignature.size(); at + 12 <= bytes.size();) {
    const std::size_t length = Number(bytes, at);
    if (length > bytes.size() - at - 12) return std::nullopt;
    const std::string_view type(reinterpret_cast<const char*>(&bytes[at + 4]), 4);
    const auto data = bytes.subspan(at + 8, length);
    constexpr char kLowerCase = 0x20;
    if (before.empty()) {
      if (type != "IHDR" || !TakeHeader(data, png) ||
          Crc32(bytes.subspan(at + 4, length + 4)) != Number(bytes, at + 8 + length)) {
        return std::nullopt;
      }
    } else if (type == "IDAT") {
      if (before != "IDAT" && !png.compressed.empty()) return std::nullopt;
      if (png.compressed.empty()) png.compressed.reserve(bytes.size() - at);
      png.compressed.insert(png.compressed.end(), data.begin(), data.end());
    } else if (type == "IEND") {
      return png;
    } else if ((type[0] & kLowerCase) == 0) {
      return std::nullopt;
    }
    before = type;
    at += length + 12;
  }
  return std::nullopt;
}

// Returns the rows with their filters; empty if the data are damaged, or more or fewer.
std::vector<std::uint8_t> Inflate(const PlainPng& png) {
  constexpr std::size_t kMostTimes = 1032;  // a bound of the format
  if (png.FilteredSize() / kMostTimes > png.compressed.size()) return {};
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  PLUMBLINE_CHECK(decompressor != nullptr, "memory for a decoder");
  std::vector<std::uint8_t> rows(png.FilteredSize());
  const libdeflate_result result = libdeflate_zlib_decompress(decompressor.get(),
                                                              png.compressed.data(),
                                                              png.compressed.size(),
                                                              rows.data(),
                                                              rows.size(),
                                                              nullptr);
  if (result != LIBDEFLATE_SUCCESS) rows.clear();
  return rows;
}

// Turns the order of bytes of PNG into the processor's.
void FromBigEndian(cv::Mat& image) {
  const std::span pixels(image.ptr<std::uint16_t>(), image.total());
  for (std::uint16_t& level : pixels) {
    std::array<std::uint8_t, 2> stored;
    std::memcpy(stored.data(), &level, sizeof level);
    level = static_cast<std::uint16_t>(stored[0] << 8 | stored[1]);
  }
}

}  // namespace

bool UndoPngFilters(std::span<const std::uint8_t> filtered,
                    std::size_t width,
                    std::size_t height,
                    int pixel_bytes,
                    std::uint8_t* out) {
  PLUMBLINE_CHECK(pixel_bytes >= 1 && pixel_bytes <= 4, "bytes of a pixel");
  PLUMBLINE_CHECK(
      filtered.size() == height * (width * static_cast<std::size_t>(pixel_bytes) + 1) && width > 0,
      "size of the filtered rows");
  constexpr std::array kUndo{UndoFilters<1>, UndoFilters<2>, UndoFilters<3>, UndoFilters<4>};
  return kUndo[static_cast<std::size_t>(pixel_bytes - 1)](filtered, width, height, out);
}

cv::Mat DecodePlainPng(std::span<const std::uint8_t> bytes) {
  const std::optional<PlainPng> png = ReadChunks(bytes);
  if (!png) return {};
  const std::vector<std::uint8_t> rows = Inflate(*png);
  if (rows.empty()) return {};
  cv::Mat image(static_cast<int>(png->height),
                static_cast<int>(png->width),
                CV_MAKETYPE(png->channel_bytes == 2 ? CV_16U : CV_8U, png->channels));
  if (!UndoPngFilters(
          rows, png->width, png->height, png->channels * png->channel_bytes, image.data)) {
    return {};
  }
  if (png->channel_bytes == 2) FromBigEndian(image);
  if (png->channels == 3) cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
  if (png->channels == 4) cv::cvtColor(image, image, cv::COLOR_RGBA2BGR);
  return image;
}

}  // namespace plumbline
