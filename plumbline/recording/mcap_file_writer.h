// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline {

// What the messages of a channel are.
struct McapChannel {
  std::string topic;
  std::string encoding;         // "protobuf"
  std::string type;             // "foxglove.CompressedImage"
  std::string schema_encoding;  // "protobuf"
  std::string schema;           // of this type
};

// Writes an MCAP file (mcap.dev/spec, version 0): messages in chunks packed by Zstandard, each with
// an index of its messages, and a summary at the end; all with checksums. The file grows under the
// name FILE.part, from which `mcap recover` makes a whole one when the program dies, and gets its
// own name when it is complete.
class McapFileWriter {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

  // What every file begins with: the format's magic, and a header that names this library.
  static std::string Beginning();

  // InputError where it cannot be written; so throw all functions.
  explicit McapFileWriter(std::filesystem::path path);
  // Completes the file, and says nothing where that fails.
  ~McapFileWriter();
  McapFileWriter(const McapFileWriter&) = delete;
  McapFileWriter& operator=(const McapFileWriter&) = delete;

  // Returns the number of the channel.
  std::uint16_t AddChannel(const McapChannel& channel);
  void Write(std::uint16_t channel, std::int64_t time_ns, std::string_view message);
  // Completes the file; nothing may be written after.
  void Close();

 private:
  struct ChunkPlace {
    std::uint64_t first_ns = 0, last_ns = 0;
    std::uint64_t offset = 0, size = 0;              // of its record
    std::uint64_t packed = 0, unpacked = 0;          // bytes of its messages
    std::uint64_t index_size = 0;                    // of the records of indices behind it
    std::map<std::uint16_t, std::uint64_t> indices;  // offsets, by channel
  };
  using Index = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // time, offset in the chunk

  [[noreturn]] void Fail() const;  // with what the operating system said last
  void Append(const std::string& bytes);
  void EndChunk();
  void AppendSummary();

  std::filesystem::path path_, part_;
  std::ofstream file_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;                  // of all bytes so far, or of the summary
  std::vector<std::string> descriptions_;  // records of schemas and channels
  std::string chunk_;
  ChunkPlace chunk_place_;
  std::map<std::uint16_t, Index> chunk_index_;
  std::vector<ChunkPlace> chunks_;
  std::vector<std::uint64_t> counts_;  // messages by channel
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
  bool closed_ = false;
};

}  // namespace plumbline
