// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/recordings/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

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

// Returns true if a file begins like a bag of any version.
bool BeginsAsBag(std::span<const std::uint8_t> bytes);

// Reads a ROS 1 bag of version 2.0 (wiki.ros.org/Bags/Format/2.0) from its first record to its
// last, and passes every message to `sink` in the order of the file. Chunks may be packed by bzip2
// or LZ4 or not at all. The index is only counted, which reveals a truncated or unclosed bag.
//
// Throws InputError, which names the byte, for another kind of file, and if it is damaged, ends
// early, is encrypted or has no index (`rosbag reindex` makes it anew). Cost: reading and unpacking
// the file once.
std::unique_ptr<Recording> ReadBag(const std::filesystem::path& path, const MessageSink& sink);

// Reads the files of one recording of ROS 2 in their order: .db3 (ReadSqliteBag) and .mcap
// (ReadMcap), each plain or packed as a whole (.zstd: it is unpacked into a temporary file). Of a
// damaged or truncated file all readable messages are read, and the rest becomes a note. `path` is
// the file or the folder of files, for error messages. Throws InputError if no file can be read.
std::unique_ptr<Recording> ReadRosbag2(const std::filesystem::path& path,
                                       const std::vector<std::filesystem::path>& files,
                                       const MessageSink& sink);

// First bytes of SQLite's files.
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

// Returns true if a file begins like SQLite's.
bool BeginsAsSqlite(std::span<const std::uint8_t> bytes);

// Reads a .db3 file of ROS 2 (rosbag2's storage `sqlite3`, all its versions: tables `topics` and
// `messages`) from its first message to its last, and passes those of the types known to FormOf to
// `sink`. Others are not read. The file is neither changed nor locked. If a recorder's journal
// (-wal, -journal) lies beside it, both are copied to a temporary folder, and the journal is
// applied there.
//
// Messages on damaged pages, or after the end of a truncated file, are left out, with a note.
// Messages use `name`, if given, instead of the path. Throws InputError for another kind of file.
// Cost: reading the file once; later, the pages of each message again.
std::unique_ptr<Recording> ReadSqliteBag(const std::filesystem::path& path,
                                         const MessageSink& sink,
                                         const std::filesystem::path& name = {});

}  // namespace plumbline
