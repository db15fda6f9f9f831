// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace plumbline {
namespace {

// The bytes of a file; bytes beyond its end count as 0.
class Header {
 public:
  explicit Header(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t size() const { return bytes_.size(); }
  std::uint32_t Byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0; }
  // Return numbers of so many bytes, with the highest byte first or last.
  std::uint32_t Big(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = (value << 8) | Byte(at + i);
    return value;
  }
  std::uint32_t Little(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = (value << 8) | Byte(at + i);
    return value;
  }
  bool Has(std::size_t at, std::string_view text) const {
    if (at > bytes_.size() || bytes_.size() - at < text.size()) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (bytes_[at + i] != static_cast<std::uint8_t>(text[i])) return false;
    }
    return true;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

std::optional<ImageSize> Size(std::uint64_t width, std::uint64_t height) {
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  if (width == 0 || height == 0 || width > kMax || height > kMax) return std::nullopt;
  return ImageSize{static_cast<int>(width), static_cast<int>(height)};
}

std::optional<ImageSize> SizeOfPng(const Header& file) {
  if (!file.Has(12, "IHDR")) return std::nullopt;
  return Size(file.Big(16, 4), file.Big(20, 4));
}

// Returns the size of a JPEG file, which stands in the start-of-frame segment before the first
// scan.
std::optional<ImageSize> SizeOfJpeg(const Header& file) {
  std::size_t at = 2;
  while (at + 9 <= file.size() && file.Byte(at) == 0xFF) {
    const std::uint32_t marker = file.Byte(at + 1);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const bool frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return Size(file.Big(at + 7, 2), file.Big(at + 5, 2));
    if (marker == 0xDA) break;
    at += 2 + file.Big(at + 2, 2);
  }
  return std::nullopt;
}

std::optional<ImageSize> SizeOfWebp(const Header& file) {
  constexpr std::uint32_t kSide = 0x3FFF;  // 14 bits
  if (file.Has(12, "VP8X")) return Size(file.Little(24, 3) + 1, file.Little(27, 3) + 1);
  if (file.Has(12, "VP8L") && file.Byte(20) == 0x2F) {
    const std::uint32_t bits = file.Little(21, 4);
    return Size((bits & kSide) + 1, ((bits >> 14) & kSide) + 1);
  }
  if (file.Has(12, "VP8 ") && file.Has(23, "\x9D\x01\x2A")) {
    return Size(file.Little(26, 2) & kSide, file.Little(28, 2) & kSide);
  }
  return std::nullopt;
}

// Reads the first `count` numbers of a PNM file: after "P5" come width, height and the greatest
// level, with blanks and comments (from # to the end of the line) between. Numbers that are not
// read are 0.
using PnmNumbers = std::array<std::uint64_t, 3>;
std::optional<PnmNumbers> NumbersOfPnm(const Header& file, std::size_t count) {
  constexpr std::uint64_t kFar = std::uint64_t{1} << 40;
  std::size_t at = 2;
  const auto is_digit = [&] { return file.Byte(at) >= '0' && file.Byte(at) <= '9'; };
  PnmNumbers numbers = {};
  for (std::uint64_t& number : std::span(numbers).first(count)) {
    while (at < file.size() && !is_digit()) {
      if (file.Byte(at) == '#') {
        while (at < file.size() && file.Byte(at) != '\n') ++at;
      } else if (file.Byte(at) > ' ') {
        return std::nullopt;
      } else {
        ++at;
      }
    }
    for (; at < file.size() && is_digit() && number < kFar; ++at) {
      number = 10 * number + (file.Byte(at) - '0');
    }
  }
  return numbers;
}

std::optional<ImageSize> SizeOfPnm(const Header& file) {
  const std::optional<PnmNumbers> numbers = NumbersOfPnm(file, 2);
  return numbers ? Size((*numbers)[0], (*numbers)[1]) : std::nullopt;
}

std::optional<ImageSize> SizeOfBmp(const Header& file) {
  constexpr std::uint32_t kOldHeader = 12, kSign = 0x80000000U;
  if (file.Little(14, 4) == kOldHeader) return Size(file.Little(18, 2), file.Little(20, 2));
  const std::uint32_t height = file.Little(22, 4);  // negative if the first row is the top one
  return Size(file.Little(18, 4), (height & kSign) != 0 ? 0U - height : height);
}

// The first directory of a TIFF file, which may stand inside another file (EXIF), `begin` bytes
// from its start.
class TiffDirectory {
 public:
  TiffDirectory(const Header& file, std::size_t begin)
      : file_(file), big_(file.Byte(begin) == 'M') {
    directory_ = begin + Number(begin + 4, 4);
    entries_ = Number(directory_, 2);
  }

  // The value of a tag that is one whole number; 0 if it is missing.
  std::uint32_t Tag(std::uint32_t tag) const {
    constexpr std::uint32_t kShort = 3, kLong = 4;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < entries_ && directory_ + 2 + 12 * i < file_.size(); ++i) {
      const std::size_t entry = directory_ + 2 + 12 * i;
      const std::uint32_t type = Number(entry + 2, 2);
      if (type != kShort && type != kLong) continue;
      if (Number(entry, 2) == tag) value = Number(entry + 8, type == kShort ? 2 : 4);
    }
    return value;
  }

  static bool BeginsAt(const Header& file, std::size_t at) {
    return file.Has(at, std::string_view("II*\0", 4)) || file.Has(at, std::string_view("MM\0*", 4));
  }

 private:
  std::uint32_t Number(std::size_t at, std::size_t count) const {
    return big_ ? file_.Big(at, count) : file_.Little(at, count);
  }

  const Header& file_;
  bool big_;
  std::size_t directory_ = 0, entries_ = 0;
};

std::optional<ImageSize> SizeOfTiff(const Header& file) {
  constexpr std::uint32_t kWidth = 256, kHeight = 257;
  const TiffDirectory directory(file, 0);
  return Size(directory.Tag(kWidth), directory.Tag(kHeight));
}

// Return the beginning of the EXIF data of a file, which are a TIFF file; nullopt if there are
// none.
std::optional<std::size_t> ExifOfJpeg(const Header& file) {
  constexpr std::string_view kExif("Exif\0\0", 6);
  std::size_t at = 2;
  while (at + 4 <= file.size() && file.Byte(at) == 0xFF) {
    const std::uint32_t marker = file.Byte(at + 1);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    if (marker == 0xE1 && file.Has(at + 4, kExif)) return at + 4 + kExif.size();
    if (marker == 0xDA) break;
    at += 2 + file.Big(at + 2, 2);
  }
  return std::nullopt;
}

std::optional<std::size_t> ExifOfPng(const Header& file) {
  for (std::size_t at = 8; at + 12 <= file.size(); at += 12 + std::size_t{file.Big(at, 4)}) {
    if (file.Has(at + 4, "eXIf")) return at + 8;
  }
  return std::nullopt;
}

std::optional<std::size_t> ExifOfWebp(const Header& file) {
  constexpr std::string_view kExif("Exif\0\0", 6);  // some writers repeat JPEG's marker
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::size_t length = file.Little(at + 4, 4);
    if (file.Has(at, "EXIF")) return at + 8 + (file.Has(at + 8, kExif) ? kExif.size() : 0);
    at += 8 + length + length % 2;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageSize> SizeInHeader(std::span<const std::uint8_t> bytes) {
  const Header file(bytes);
  if (file.Has(0, "\x89PNG\r\n\x1a\n")) return SizeOfPng(file);
  if (file.Has(0, "\xFF\xD8\xFF")) return SizeOfJpeg(file);
  if (file.Has(0, "RIFF") && file.Has(8, "WEBP")) return SizeOfWebp(file);
  if (file.Has(0, "BM")) return SizeOfBmp(file);
  if (TiffDirectory::BeginsAt(file, 0)) return SizeOfTiff(file);
  if (file.Byte(0) == 'P' && file.Byte(1) >= '1' && file.Byte(1) <= '6') return SizeOfPnm(file);
  return std::nullopt;
}

bool IsGreyOf16Bits(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kBitDepth = 24, kColorType = 25;
  constexpr std::uint64_t kMostOf8Bits = 255, kMost = 65535;
  const Header file(bytes);
  if (file.Has(0, "\x89PNG\r\n\x1a\n"))
    return file.Byte(kBitDepth) == 16 && file.Byte(kColorType) == 0;
  if (!file.Has(0, "P2") && !file.Has(0, "P5")) return false;
  const std::optional<PnmNumbers> numbers = NumbersOfPnm(file, 3);
  return numbers && (*numbers)[2] > kMostOf8Bits && (*numbers)[2] <= kMost;
}

int ExifOrientation(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kOrientation = 274, kLast = 8;
  const Header file(bytes);
  std::optional<std::size_t> exif;
  if (file.Has(0, "\x89PNG\r\n\x1a\n")) exif = ExifOfPng(file);
  if (file.Has(0, "\xFF\xD8\xFF")) exif = ExifOfJpeg(file);
  if (file.Has(0, "RIFF") && file.Has(8, "WEBP")) exif = ExifOfWebp(file);
  if (TiffDirectory::BeginsAt(file, 0)) exif = 0;
  if (!exif || !TiffDirectory::BeginsAt(file, *exif)) return 1;
  const std::uint32_t orientation = TiffDirectory(file, *exif).Tag(kOrientation);
  return orientation >= 1 && orientation <= kLast ? static_cast<int>(orientation) : 1;
}

}  // namespace plumbline
