// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/section_file.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <span>
#include <system_error>
#include <utility>

#include <zstd.h>
#include <zstd_errors.h>

namespace plumbline {
namespace {

constexpr std::size_t kHeaderBytes = 32;
constexpr int kLevel = 3;  // higher levels take several times as long and save some hundredths
// Limit of our compression ratio, which bounds the memory requested by a forged file.
constexpr std::uint64_t kMaxRatio = 200;
constexpr std::uint64_t kSmallBytes = 65536;  // allowed with any ratio
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 31;

enum Method : std::uint32_t { kAsItIs = 0, kZstd = 1 };

std::span<const std::uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool IsAllowed(std::uint64_t size, std::uint64_t stored) {
  return size <= kMaxBytes && (size <= kSmallBytes || size / kMaxRatio <= stored);
}

// Returns the compressed contents; an empty string if compression does not help.
std::string Compressed(std::string_view contents) {
  std::string packed(ZSTD_compressBound(contents.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), contents.data(), contents.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size >= contents.size() || !IsAllowed(contents.size(), size)) {
    return {};
  }
  packed.resize(size);
  return packed;
}

}  // namespace

SectionWriter::SectionWriter(const std::filesystem::path& path, std::string_view preamble)
    : file_(path) {
  file_.Write(preamble);
}

void SectionWriter::Write(std::uint32_t kind, std::string_view contents) {
  PLUMBLINE_CHECK(contents.size() <= kMaxBytes, "a section that is too large to be read");
  const std::string packed = Compressed(contents);
  const std::string_view stored = packed.empty() ? contents : std::string_view(packed);
  ByteWriter header;
  header(kind);
  header(std::uint32_t{packed.empty() ? kAsItIs : kZstd});
  header(static_cast<std::uint64_t>(stored.size()));
  header(static_cast<std::uint64_t>(contents.size()));
  header(Crc32(BytesOf(stored)));
  header(Crc32(BytesOf(header.bytes())));
  file_.Write(header.bytes());
  file_.Write(stored);
}

void SectionWriter::Commit() { file_.Commit(Durability::kPower); }

SectionReader::SectionReader(const std::filesystem::path& path, std::size_t preamble_bytes)
    : source_(path.string()) {
  CheckExists(path);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(source_ + ": expected a file, found something else");
  }
  file_.open(path, std::ios::binary);
  remaining_ = std::filesystem::file_size(path, error);
  if (!file_ || error) throw InputError(source_ + ": cannot be read");
  preamble_ = ReadBytes(std::min<std::uint64_t>(preamble_bytes, remaining_));
}

std::string SectionReader::ReadBytes(std::uint64_t count) {
  if (count > remaining_) throw InputError(source_ + ": ends early");
  std::string bytes(static_cast<std::size_t>(count), '\0');
  file_.read(bytes.data(), static_cast<std::streamsize>(count));
  if (!file_) throw InputError(source_ + ": cannot be read");
  remaining_ -= count;
  return bytes;
}

SectionReader::Section SectionReader::Next() {
  const std::string header = ReadBytes(kHeaderBytes);
  Section section;
  std::uint32_t method = 0, crc = 0, header_crc = 0;
  std::uint64_t stored_size = 0, size = 0;
  ByteReader fields(BytesOf(header), source_);
  fields(section.kind);
  fields(method);
  fields(stored_size);
  fields(size);
  fields(crc);
  fields(header_crc);
  const InputError damaged(source_ + ": damaged (wrong checksum)");
  if (Crc32(BytesOf(header).first(kHeaderBytes - 4)) != header_crc) throw damaged;
  std::string stored = ReadBytes(stored_size);
  if (Crc32(BytesOf(stored)) != crc) throw damaged;
  const bool fits = method == kZstd ? IsAllowed(size, stored_size) : size == stored_size;
  if (method > kZstd || !fits) {
    throw InputError(source_ + ": expected a section as it is or packed by zstd, found neither");
  }
  if (method == kAsItIs) {
    section.contents = std::move(stored);
    return section;
  }
  section.contents.resize(static_cast<std::size_t>(size));
  const std::size_t unpacked =
      ZSTD_decompress(section.contents.data(), size, stored.data(), stored.size());
  if (ZSTD_getErrorCode(unpacked) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (ZSTD_isError(unpacked) != 0 || unpacked != size) {
    throw InputError(source_ + ": expected " + std::to_string(size) +
                     " bytes packed by zstd, found others");
  }
  return section;
}

std::string VersionedPreamble(std::string_view magic, std::uint32_t version) {
  ByteWriter preamble;
  for (const char c : magic) preamble(static_cast<std::uint8_t>(c));
  preamble(version);
  return preamble.Take();
}

std::optional<std::uint32_t> VersionOf(const SectionReader& file, std::string_view magic) {
  const std::string& preamble = file.preamble();
  if (!preamble.starts_with(magic)) return std::nullopt;
  ByteReader reader(BytesOf(preamble), file.source());
  reader.Take(magic.size());
  std::uint32_t version = 0;
  reader(version);
  return version;
}

}  // namespace plumbline
