// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/atomic_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline {

// A binary file of sections, each compressed by itself (zstd, if that makes it smaller) and with
// checksums of its own, so that files of any size are written and read with the memory of one
// section. A preamble of bytes of the caller is followed by each section, little-endian:
//
//   bytes  contents
//   4      kind, of the caller
//   4      0: as it is, 1: zstd
//   8      size as stored
//   8      size of the contents
//   4      CRC-32 of the bytes as stored
//   4      CRC-32 of these 28 bytes
//   rest   the contents

class SectionWriter {
 public:
  // Begins a file. Throws InputError "cannot write <path>: <reason>", as do all functions here.
  SectionWriter(const std::filesystem::path& path, std::string_view preamble);

  void Write(std::uint32_t kind, std::string_view contents);

  // Gives the file its name, once everything is on the disk. Without this call the file is removed.
  void Commit();

 private:
  AtomicFileWriter file_;
};

class SectionReader {
 public:
  // Opens a file and reads the bytes of the preamble, or all if there are fewer. Throws InputError
  // if the file is missing.
  SectionReader(const std::filesystem::path& path, std::size_t preamble_bytes);

  const std::string& preamble() const { return preamble_; }
  // Returns the number of bytes after the sections read so far.
  std::uint64_t remaining() const { return remaining_; }
  const std::string& source() const { return source_; }

  struct Section {
    std::uint32_t kind = 0;
    std::string contents;
  };
  // Returns the next section. Throws InputError naming the file if it ends early or a checksum is
  // wrong. Takes at most some hundred times the memory of the section in the file.
  Section Next();

 private:
  std::string ReadBytes(std::uint64_t count);

  std::string source_;
  std::ifstream file_;
  std::uint64_t remaining_ = 0;
  std::string preamble_;
};

// Preamble of files with a version: eight bytes that identify the format, and the version in four,
// little-endian.
inline constexpr std::size_t kVersionedPreambleBytes = 12;
std::string VersionedPreamble(std::string_view magic, std::uint32_t version);
// Returns the version of a file opened with a preamble of that size; nullopt if it does not begin
// with `magic`. Throws InputError if the file ends before the version does.
std::optional<std::uint32_t> VersionOf(const SectionReader& file, std::string_view magic);

}  // namespace plumbline
