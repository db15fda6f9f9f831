// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline {

// The type of the messages of a channel.
struct McapChannel {
  std::string topic;
  std::string encoding;         // "protobuf"
  std::string type;             // "foxglove.CompressedImage"
  std::string schema_encoding;  // "protobuf"
  std::string schema;           // the schema of this type
};

// Writes an MCAP file (mcap.dev/spec, version 0): messages in chunks packed by Zstandard, each with
// an index of its messages, and a summary at the end, all with checksums. The file grows under the
// name FILE.part, from which `mcap recover` makes a complete one if the program dies. It gets its
// own name when it is complete. One program at a time writes a file: the part is locked.
class McapFileWriter {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

  // Returns the beginning of every file: the format's magic, and a header that names this library.
  static std::string Beginning();

  // Returns the path of the growing part of the file `path`.
  static std::filesystem::path PartOf(const std::filesystem::path& path);

  // Moves the part of a program that died while writing to the first free name of FILE.part-1,
  // FILE.part-2 ..., and returns a sentence about it; nullopt if there is none. Throws InputError
  // with instructions if anything else is there: a link, a file of another kind, a file being
  // written by another program.
  static std::optional<std::string> SetPartAside(const std::filesystem::path& path);

  // Begins a file, and sets an existing part aside. Throws InputError if the file cannot be
  // written, as do all functions.
  explicit McapFileWriter(std::filesystem::path path);
  // Completes the file, and reports no failure. A file without messages is removed: it would
  // replace an earlier one if a program fails before its first message.
  ~McapFileWriter();
  McapFileWriter(const McapFileWriter&) = delete;
  McapFileWriter& operator=(const McapFileWriter&) = delete;

  // Adds a channel and returns its number.
  std::uint16_t AddChannel(const McapChannel& channel);
  void Write(std::uint16_t channel, std::int64_t time_ns, std::string_view message);
  // Completes the file. Nothing may be written afterwards.
  void Close();

 private:
  struct ChunkPlace {
    std::uint64_t first_ns = 0, last_ns = 0;
    std::uint64_t offset = 0, size = 0;              // position and size of its record
    std::uint64_t packed = 0, unpacked = 0;          // bytes of its messages
    std::uint64_t index_size = 0;                    // bytes of its index records
    std::map<std::uint16_t, std::uint64_t> indices;  // offset of the index of each channel
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  // Times, and offsets in the chunk.
  using Index = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

  [[noreturn]] void Fail() const;  // throws with the last error of the operating system
  void Append(const std::string& bytes);
  void EndChunk();
  void AppendSummary();

  std::filesystem::path path_, part_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;                  // checksum of all bytes so far, or of the summary
  std::vector<std::string> descriptions_;  // records of schemas and channels
  std::string chunk_;
  ChunkPlace chunk_place_;
  std::map<std::uint16_t, Index> chunk_index_;
  std::vector<ChunkPlace> chunks_;
  std::vector<std::uint64_t> counts_;  // number of messages in each channel
  std::uint64_t first_ns_ = 0, last_ns_ = 0;
  bool closed_ = false;
};

}  // namespace plumbline
