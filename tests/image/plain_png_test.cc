// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/plain_png.h"

#include "plumbline/base/crc32.h"
#include "plumbline/base/random.h"
#include "plumbline/image/image_codecs.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

using ByteVector = std::vector<std::uint8_t>;

// What a filter of the specification predicts, from the pixels to the left, above and above left.
int Predicted(int filter, int a, int b, int c) {
  if (filter <= 1) return filter == 0 ? 0 : a;
  if (filter <= 3) return filter == 2 ? b : (a + b) / 2;
  const int p = a + b - c;
  const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
  if (pa <= pb && pa <= pc) return a;
  return pb <= pc ? b : c;
}

// Applies a filter to each row; filters[y % size] is that of row y.
ByteVector Filtered(const ByteVector& pixels,
                    std::size_t row_bytes,
                    std::size_t pixel_bytes,
                    const std::vector<int>& filters) {
  ByteVector filtered;
  for (std::size_t y = 0; y * row_bytes < pixels.size(); ++y) {
    const int filter = filters[y % filters.size()];
    filtered.push_back(static_cast<std::uint8_t>(filter));
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const std::size_t at = y * row_bytes + i;
      const bool left = i >= pixel_bytes, above = y > 0;
      const int a = left ? pixels[at - pixel_bytes] : 0;
      const int b = above ? pixels[at - row_bytes] : 0;
      const int c = left && above ? pixels[at - row_bytes - pixel_bytes] : 0;
      filtered.push_back(static_cast<std::uint8_t>(pixels[at] - Predicted(filter, a, b, c)));
    }
  }
  return filtered;
}

// Smooth with noise, in the order of PNG: red first, upper bytes first.
ByteVector TestPixels(std::size_t count) {
  Rng rng(5, "png");
  ByteVector pixels(count);
  int level = 128;
  for (std::uint8_t& pixel : pixels) {
    level += static_cast<int>(rng.Uniform(-40.0, 40.0));
    pixel = static_cast<std::uint8_t>(level);
  }
  return pixels;
}

void AddNumber(std::uint32_t number, ByteVector& bytes) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes.push_back(static_cast<std::uint8_t>(number >> shift));
  }
}

void AddChunk(std::string_view type, const ByteVector& data, ByteVector& file) {
  AddNumber(static_cast<std::uint32_t>(data.size()), file);
  ByteVector checked(type.begin(), type.end());
  checked.insert(checked.end(), data.begin(), data.end());
  file.insert(file.end(), checked.begin(), checked.end());
  AddNumber(Crc32(checked), file);
}

ByteVector Compressed(const ByteVector& bytes) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(1);
  ByteVector compressed(libdeflate_zlib_compress_bound(compressor, bytes.size()));
  compressed.resize(libdeflate_zlib_compress(
      compressor, bytes.data(), bytes.size(), compressed.data(), compressed.size()));
  libdeflate_free_compressor(compressor);
  return compressed;
}

struct TestFile {
  std::uint32_t width = 19;
  std::uint32_t height = 21;
  std::uint8_t depth = 8;
  std::uint8_t color = 0;
  std::vector<int> filters{4, 1, 0, 3, 2};

  std::size_t PixelBytes() const { return (color == 0 ? 1U : color == 2 ? 3U : 4U) * depth / 8U; }
  ByteVector Rows() const {
    const std::size_t row_bytes = width * PixelBytes();
    return Filtered(TestPixels(row_bytes * height), row_bytes, PixelBytes(), filters);
  }
};

ByteVector FileOf(const TestFile& test, const ByteVector& compressed) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  ByteVector file(kSignature.begin(), kSignature.end()), header;
  AddNumber(test.width, header);
  AddNumber(test.height, header);
  header.insert(header.end(), {test.depth, test.color, 0, 0, 0});
  AddChunk("IHDR", header, file);
  AddChunk("tEXt", {'a', 0, 'b'}, file);
  const auto middle = compressed.begin() + static_cast<std::ptrdiff_t>(compressed.size() / 2);
  AddChunk("IDAT", {compressed.begin(), middle}, file);
  AddChunk("IDAT", {middle, compressed.end()}, file);
  AddChunk("IEND", {}, file);
  return file;
}

ByteVector FileOf(const TestFile& test) { return FileOf(test, Compressed(test.Rows())); }

TEST(DecodePlainPng, GivesWhatOpenCvGivesForAllFiltersAndSizes) {
  const std::vector<std::vector<int>> all_filters{
      {0}, {1}, {2}, {3}, {4}, {4, 1, 0, 3, 2}, {1, 2, 2, 0, 1, 1, 2, 2, 3}};
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{
      {1, 1}, {1, 17}, {3, 8}, {7, 9}, {8, 16}, {9, 7}, {40, 24}};
  for (const auto& [depth, color] : {std::pair{8, 0}, {16, 0}, {8, 2}, {8, 6}}) {
    for (const auto& filters : all_filters) {
      for (const auto& [width, height] : sizes) {
        const ByteVector file = FileOf({width,
                                        height,
                                        static_cast<std::uint8_t>(depth),
                                        static_cast<std::uint8_t>(color),
                                        filters});
        const cv::Mat image = DecodePlainPng(file);
        cv::Mat expected = cv::imdecode(file, cv::IMREAD_UNCHANGED);
        if (color == 6) cv::cvtColor(expected, expected, cv::COLOR_BGRA2BGR);
        ASSERT_EQ(image.size(), expected.size());
        ASSERT_EQ(image.type(), expected.type());
        EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0)
            << depth << " bits, colour " << color << ", " << width << "x" << height;
      }
    }
  }
}

TEST(DecodePlainPng, RefusesDamage) {
  const TestFile test;
  const ByteVector rows = test.Rows();
  ByteVector damaged = Compressed(rows);
  damaged[damaged.size() / 2] ^= 1U;
  EXPECT_TRUE(DecodePlainPng(FileOf(test, damaged)).empty());
  ByteVector longer = rows, shorter = rows, unknown_filter = rows;
  longer.push_back(0);
  shorter.pop_back();
  for (const ByteVector& other : {longer, shorter}) {
    EXPECT_TRUE(DecodePlainPng(FileOf(test, Compressed(other))).empty());
  }
  for (const std::size_t y : {3U, 20U}) {  // among eight rows and by itself
    unknown_filter = rows;
    unknown_filter[y * (test.width + 1)] = 5;
    EXPECT_TRUE(DecodePlainPng(FileOf(test, Compressed(unknown_filter))).empty());
  }
  const ByteVector file = FileOf(test);
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_TRUE(DecodePlainPng(std::span(file).first(size)).empty()) << size;
  }
  for (std::size_t at = 16; at < 33; ++at) {  // the header and its checksum
    ByteVector changed = file;
    changed[at] ^= 1U;
    EXPECT_TRUE(DecodePlainPng(changed).empty()) << at;
  }
}

TEST(DecodePlainPng, AllocatesNothingForASizeThatTheDataCannotHave) {
  TestFile test;
  const ByteVector compressed = Compressed(test.Rows());
  test.width = test.height = 1'000'000;
  EXPECT_TRUE(DecodePlainPng(FileOf(test, compressed)).empty());
}

TEST(DecodePlainPng, LeavesOtherKindsToLibspng) {
  const ByteVector file = FileOf({.depth = 8, .color = 2});
  ByteVector with_end = file;
  with_end.resize(file.size() - 12);
  AddChunk("PLTE", {1, 2, 3}, with_end);  // a critical chunk that colours may have
  AddChunk("IEND", {}, with_end);
  EXPECT_TRUE(DecodePlainPng(with_end).empty());
  std::vector<std::uint8_t> one_bit;
  cv::imencode(
      ".png", cv::Mat(20, 30, CV_8UC1, cv::Scalar(255)), one_bit, {cv::IMWRITE_PNG_BILEVEL, 1});
  EXPECT_TRUE(DecodePlainPng(one_bit).empty());
  EXPECT_FALSE(DecodePng(one_bit).empty());
}

}  // namespace
}  // namespace plumbline
