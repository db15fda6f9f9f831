// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/io/recordings/compression.h"
#include "plumbline/io/recordings/recording.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// The bytes of unpacked chunks, shared by all their readers.
using ChunkBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// A file of messages in separately packed chunks. Messages of recently read chunks are found
// quickly.
class ChunkFile : public Recording {
 public:
  // Opens a file; messages use `name`, if given, instead of its path. Throws InputError if the file
  // is missing.
  explicit ChunkFile(const std::filesystem::path& path, const std::filesystem::path& name = {});

  std::uint64_t size() const { return size_; }

  // Adds a chunk of the file and returns its index: `stored` bytes at `offset`, `size` bytes when
  // unpacked.
  std::uint32_t AddChunk(std::uint64_t offset,
                         std::uint64_t stored,
                         Compression compression,
                         std::uint64_t size);

  // Returns bytes of the file unchanged. Throws InputError if it has fewer.
  std::vector<std::uint8_t> Bytes(std::uint64_t offset, std::uint64_t count) const;
  // Returns the unpacked chunk, or its fault. Thread-safe.
  Expected<ChunkBytes, std::string> Chunk(std::uint32_t index) const;
  Expected<std::vector<std::uint8_t>, std::string> StoredBytes(
      const StoredMessage& message) const override;

  // Throws InputError "path: byte 4117: why".
  [[noreturn]] void FailAt(std::uint64_t offset, const std::string& why) const;

 private:
  struct ChunkPlace {
    std::uint64_t offset = 0, stored = 0, size = 0;
    Compression compression = Compression::kNone;
  };
  // The most recently used chunks, newest first: messages of two cameras lie close together.
  using RecentChunks = std::array<std::pair<std::uint32_t, ChunkBytes>, 4>;

  std::uint64_t size_ = 0;
  std::vector<ChunkPlace> chunks_;
  mutable std::mutex mutex_;
  mutable std::ifstream file_;
  mutable RecentChunks recent_;
};

}  // namespace plumbline
