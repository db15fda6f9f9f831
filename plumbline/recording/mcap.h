// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace plumbline {

// The bytes with which MCAP files begin and end.
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

namespace mcap {

// Kinds of records, by their first byte. An incomplete list.
enum Op : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kDataEnd = 15,
  kFirstPrivate = 128  // the first of those for private use
};

}  // namespace mcap

// Returns true if a file begins like an MCAP file.
bool BeginsAsMcap(std::span<const std::uint8_t> bytes);

// Reads an MCAP file (mcap.dev/spec, version 0) from its first record to its last, and passes every
// message to `sink` in the order of the file. Messages may be in chunks (not packed, by LZ4 or by
// Zstandard) or outside of them. Checksums are verified if the file has them; its summary is not
// used.
//
// Throws InputError, which names the byte, for another kind of file, and if it is damaged or ends
// early (`mcap recover` completes it). Cost: reading and unpacking the file once.
std::unique_ptr<Recording> ReadMcap(const std::filesystem::path& path, const MessageSink& sink);

// Reads an MCAP file that may be damaged or end early up to the first fault, which becomes a note.
// Messages use `name` for the file. Throws InputError for another kind of file.
std::unique_ptr<Recording> ReadMcapPart(const std::filesystem::path& path,
                                        const MessageSink& sink,
                                        const std::filesystem::path& name);

}  // namespace plumbline
