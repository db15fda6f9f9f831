// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"

#include "plumbline/base/crc32.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image_codecs.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/image/opencv_modules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::string_view kEndsEarly = "the file ends early";
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;
constexpr const char* kTooLarge = "the file is larger than 1 GB";
constexpr const char* kNoImage = "not an image this program can decode";

std::uint32_t BigEndian32(Bytes bytes, std::size_t at) {
  return (std::uint32_t{bytes[at]} << 24) | (std::uint32_t{bytes[at + 1]} << 16) |
         (std::uint32_t{bytes[at + 2]} << 8) | std::uint32_t{bytes[at + 3]};
}

std::uint32_t LittleEndian32(Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} | (std::uint32_t{bytes[at + 1]} << 8) |
         (std::uint32_t{bytes[at + 2]} << 16) | (std::uint32_t{bytes[at + 3]} << 24);
}

bool HasText(Bytes bytes, std::size_t at, std::string_view text) {
  if (bytes.size() < at + text.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (bytes[at + i] != static_cast<std::uint8_t>(text[i])) return false;
  }
  return true;
}

bool IsPng(Bytes bytes) { return HasText(bytes, 0, "\x89PNG\r\n\x1a\n"); }
bool IsJpeg(Bytes bytes) { return HasText(bytes, 0, "\xFF\xD8\xFF"); }
bool IsWebp(Bytes bytes) { return HasText(bytes, 0, "RIFF") && HasText(bytes, 8, "WEBP"); }

// Returns the fault of a PNG file, which has chunks of length, type, data and CRC up to IEND.
std::optional<std::string> PngDamage(Bytes bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = BigEndian32(bytes, at);
    if (length > bytes.size() - at - 12) break;
    if (Crc32(bytes.subspan(at + 4, length + 4)) != BigEndian32(bytes, at + 8 + length)) {
      return "the file is damaged or cut short (wrong checksum)";
    }
    if (HasText(bytes, at + 4, "IEND")) return std::nullopt;
    at += length + 12;
  }
  return std::string(kEndsEarly);
}

// Returns the fault of a JPEG file, which has marker segments with lengths up to the start of the
// scan, then coded data, then an end-of-image marker.
std::optional<std::string> JpegDamage(Bytes bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != 0xFF) return "the file is damaged (no marker where one must be)";
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    if (marker == 0xDA) break;
    at += 2 + (std::size_t{bytes[at + 2]} << 8) + bytes[at + 3];
  }
  constexpr std::array<std::uint8_t, 2> kEndOfImage = {0xFF, 0xD9};
  if (at >= bytes.size() || std::search(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                        bytes.end(),
                                        kEndOfImage.begin(),
                                        kEndOfImage.end()) == bytes.end()) {
    return std::string(kEndsEarly);
  }
  return std::nullopt;
}

std::optional<std::string> WebpDamage(Bytes bytes) {
  if (std::size_t{LittleEndian32(bytes, 4)} + 8 > bytes.size()) return std::string(kEndsEarly);
  return std::nullopt;
}

// Decodes an image; the result is empty when the decoder refuses. `flags` are those of
// cv::imdecode, for files that are not decoded here.
cv::Mat Decode(Bytes bytes, int flags) {
  cv::Mat image;
  if (IsPng(bytes)) image = DecodePng(bytes);
  if (IsJpeg(bytes)) image = DecodeJpeg(bytes);
  if (IsWebp(bytes)) image = DecodeWebp(bytes);
  return image.empty() ? LoadOpenCvModules().DecodeImage(bytes, flags) : image;
}

// Reads the bytes of a file.
Expected<std::vector<std::uint8_t>, ImageFailure> ReadBytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) {
    return ImageFailure{path, std::filesystem::exists(path, error) ? "not a file" : "no such file"};
  }
  if (size > kLargestFile) return ImageFailure{path, kTooLarge};
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) return ImageFailure{path, "cannot be read"};
  return bytes;
}

// Returns so many bytes from the start of a file, or as many as it has.
std::vector<std::uint8_t> FirstBytes(const std::filesystem::path& path, std::size_t most) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};  // a pipe never ends
  std::vector<std::uint8_t> start(most);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(start.data()), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

// Returns the size of an image whose file is complete, judged by its structure.
Expected<ImageSize, ImageFailure> CheckedSize(const std::filesystem::path& path, Bytes bytes) {
  if (bytes.empty()) return ImageFailure{path, "the file is empty"};
  if (bytes.size() > kLargestFile) return ImageFailure{path, kTooLarge};
  if (std::optional<std::string> damage = FindDamage(bytes)) return ImageFailure{path, *damage};
  const std::optional<ImageSize> size = SizeInHeader(bytes);
  if (!size) return ImageFailure{path, kNoImage};
  if (std::int64_t{size->width} * size->height > kMostPixels) {
    return ImageFailure{path,
                        fmt::format("an image of {}x{} pixels, expected at most {} million",
                                    size->width,
                                    size->height,
                                    kMostPixels / 1'000'000)};
  }
  return *size;
}

// Returns the upper 8 of so many bits of grey levels.
GrayImage UpperBits(const cv::Mat& mat, int bits) {
  GrayImage gray(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) {
    const auto* in = mat.ptr<std::uint16_t>(y);
    for (int x = 0; x < mat.cols; ++x) {
      gray.at(x, y) = static_cast<std::uint8_t>(std::min(in[x] >> (bits - 8), 255));
    }
  }
  return gray;
}

Expected<cv::Mat, ImageFailure> DecodeMat(const std::filesystem::path& path,
                                          Bytes bytes,
                                          int flags,
                                          std::optional<ImageSize> wanted) {
  const auto size = CheckedSize(path, bytes);
  if (!size) return size.error();
  if (wanted && *size != *wanted) {
    return ImageFailure{
        path, fmt::format("an image of {}x{} pixels", size->width, size->height), *size};
  }
  cv::Mat mat = Decode(bytes, flags);
  if (mat.empty() || mat.cols != size->width || mat.rows != size->height) {
    return ImageFailure{path, kNoImage};
  }
  return mat;
}

// Decodes an image to 8 bits, or to 16 bits of grey, of one channel or in colour.
// Decoders that turn colour into grey themselves round differently, so that colours are decoded.
Expected<cv::Mat, ImageFailure> DecodeLight(const std::filesystem::path& name,
                                            Bytes bytes,
                                            std::optional<ImageSize> wanted) {
  return DecodeMat(name, bytes, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION, wanted);
}

//   bits  how many of the 16 bits of a level are used
Expected<GrayImage, ImageFailure> GrayOf(const std::filesystem::path& name,
                                         const cv::Mat& mat,
                                         int bits) {
  if (mat.type() == CV_8UC1) return ToImage<std::uint8_t>(mat);
  if (mat.type() == CV_16UC1) return UpperBits(mat, bits);
  if (mat.type() != CV_8UC3) return ImageFailure{name, "neither a grey nor a colour image"};
  GrayImage gray(mat.cols, mat.rows);
  cv::Mat out = AsMat(gray);
  cv::cvtColor(mat, out, cv::COLOR_BGR2GRAY);
  return gray;
}

}  // namespace

std::optional<std::string> FindDamage(std::span<const std::uint8_t> bytes) {
  if (IsPng(bytes)) return PngDamage(bytes);
  if (IsJpeg(bytes)) return JpegDamage(bytes);
  if (IsWebp(bytes)) return WebpDamage(bytes);
  return std::nullopt;
}

Expected<ImageSize, ImageFailure> ReadImageSize(const std::filesystem::path& path) {
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  return CheckedSize(path, *bytes);
}

int ReadExifOrientation(const std::filesystem::path& path) {
  constexpr std::size_t kHeader = 1U << 17U;  // EXIF data of a JPEG file have 64 kB at most
  const std::vector<std::uint8_t> start = FirstBytes(path, kHeader);
  if (!IsWebp(start)) return ExifOrientation(start);
  const auto bytes = ReadBytes(path);  // there they stand at the end
  return bytes ? ExifOrientation(*bytes) : 1;
}

Expected<GrayImage, ImageFailure> DecodeGrayImage(const std::filesystem::path& name,
                                                  std::span<const std::uint8_t> bytes,
                                                  std::optional<ImageSize> wanted,
                                                  int bits) {
  PLUMBLINE_CHECK(bits >= 8 && bits <= 16, "bits of a level");
  const Expected<cv::Mat, ImageFailure> mat = DecodeLight(name, bytes, wanted);
  if (!mat) return mat.error();
  return GrayOf(name, *mat, bits);
}

Expected<ColorImage, ImageFailure> DecodeColorImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    std::optional<ImageSize> wanted) {
  const Expected<cv::Mat, ImageFailure> mat = DecodeLight(name, bytes, wanted);
  if (!mat) return mat.error();
  if (mat->type() == CV_8UC3) {
    const std::size_t size = mat->step * static_cast<std::size_t>(mat->rows);
    return FromInterleaved(mat->cols, mat->rows, {{mat->data, size}, mat->step});
  }
  const Expected<GrayImage, ImageFailure> gray = GrayOf(name, *mat, 16);
  if (!gray) return gray.error();
  return ToColor(*gray);
}

Expected<GrayImage, ImageFailure> ReadGrayImage(const std::filesystem::path& path,
                                                std::optional<ImageSize> wanted) {
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  return DecodeGrayImage(path, *bytes, wanted);
}

Expected<ColorImage, ImageFailure> ReadColorImage(const std::filesystem::path& path,
                                                  std::optional<ImageSize> wanted) {
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  return DecodeColorImage(path, *bytes, wanted);
}

Expected<GrayImage, ImageFailure> DecodeMask(const std::filesystem::path& name,
                                             std::span<const std::uint8_t> bytes,
                                             std::optional<ImageSize> wanted) {
  constexpr int kAsStored =
      cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
  const Expected<cv::Mat, ImageFailure> mat = DecodeMat(name, bytes, kAsStored, wanted);
  if (!mat) return mat.error();
  const std::size_t size = mat->elemSize();
  GrayImage mask(mat->cols, mat->rows);
  for (int y = 0; y < mat->rows; ++y) {
    const std::uint8_t* pixel = mat->ptr<std::uint8_t>(y);
    for (int x = 0; x < mat->cols; ++x, pixel += size) {
      const bool used = std::any_of(pixel, pixel + size, [](auto byte) { return byte != 0; });
      mask.at(x, y) = used ? 255 : 0;
    }
  }
  return mask;
}

Expected<GrayImage, ImageFailure> ReadMask(const std::filesystem::path& path,
                                           std::optional<ImageSize> wanted) {
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  return DecodeMask(path, *bytes, wanted);
}

std::optional<int> BrightestOf16Bits(const std::filesystem::path& path) {
  constexpr std::size_t kHeader = 4096;  // with comments of a PGM file, as a rule
  if (!IsGreyOf16Bits(FirstBytes(path, kHeader))) return std::nullopt;
  const auto bytes = ReadBytes(path);
  return bytes ? BrightestOf16Bits(Bytes(*bytes)) : std::nullopt;
}

std::optional<int> BrightestOf16Bits(std::span<const std::uint8_t> bytes) {
  if (!IsGreyOf16Bits(bytes)) return std::nullopt;
  const auto mat = DecodeMat({}, bytes, cv::IMREAD_UNCHANGED, std::nullopt);
  if (!mat || mat->type() != CV_16UC1) return std::nullopt;
  int brightest = 0;
  for (int y = 0; y < mat->rows; ++y) {
    const auto* in = mat->ptr<std::uint16_t>(y);
    brightest = std::max(brightest, int{*std::max_element(in, in + mat->cols)});
  }
  return brightest;
}

Expected<DepthImage, ImageFailure> DecodeDepthImage(const std::filesystem::path& name,
                                                    std::span<const std::uint8_t> bytes,
                                                    double factor,
                                                    std::optional<ImageSize> wanted) {
  PLUMBLINE_CHECK(factor > 0, "depth factor");
  const Expected<cv::Mat, ImageFailure> mat = DecodeMat(name, bytes, cv::IMREAD_UNCHANGED, wanted);
  if (!mat) return mat.error();
  if (mat->type() != CV_16UC1) return ImageFailure{name, "not a 16-bit image of one channel"};
  DepthImage depth(mat->cols, mat->rows);
  for (int y = 0; y < mat->rows; ++y) {
    const auto* in = mat->ptr<std::uint16_t>(y);
    float* out = depth.row(y);
    for (int x = 0; x < mat->cols; ++x) out[x] = static_cast<float>(in[x] / factor);
  }
  return depth;
}

Expected<DepthImage, ImageFailure> ReadDepthImage(const std::filesystem::path& path,
                                                  double factor,
                                                  std::optional<ImageSize> wanted) {
  const auto bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  return DecodeDepthImage(path, *bytes, factor, wanted);
}

}  // namespace plumbline
