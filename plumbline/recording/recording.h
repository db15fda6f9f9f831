// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/recording/compression.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// Chunks and messages beyond this are refused, bytes.
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 28;

// Who sends what: messages of one type under one name. A topic may have several.
struct Channel {
  std::string topic;
  std::string type;      // "sensor_msgs/Image", "sensor_msgs/msg/Image", "foxglove.RawImage"
  std::string encoding;  // "ros1", "cdr", "protobuf", or another one
};

// Where a message is.
struct StoredMessage {
  std::uint32_t channel = 0;   // index of its channel
  std::uint32_t chunk = 0;     // index of the part of the file that is unpacked for it
  std::uint32_t offset = 0;    // in the unpacked part, bytes
  std::uint32_t size = 0;      // bytes
  std::int64_t logged_ns = 0;  // when it was recorded
};

// The bytes of a message and the message without its header; valid during the call.
using MessageSink =
    std::function<void(const Channel&, const StoredMessage&, std::span<const std::uint8_t>)>;

// The bytes of unpacked parts, shared by those that read from them.
using ChunkBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// A file of messages in parts that are packed on their own; how the parts are found is up to the
// formats (ros_bag.h, mcap.h). Messages of parts that were read shortly before are found quickly.
class Recording {
 public:
  // InputError where there is no such file.
  explicit Recording(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  const std::vector<Channel>& channels() const { return channels_; }

  // Returns the index.
  std::uint32_t AddChannel(Channel channel);
  // A part of the file: `stored` bytes at `offset`, which hold `size` bytes. Returns the index.
  std::uint32_t AddChunk(std::uint64_t offset,
                         std::uint64_t stored,
                         Compression compression,
                         std::uint64_t size);

  // So many bytes of the file as they are. InputError where it has fewer.
  std::vector<std::uint8_t> Bytes(std::uint64_t offset, std::uint64_t count) const;
  // The unpacked part, or what is wrong with it. Thread-safe, as Message.
  Expected<ChunkBytes, std::string> Chunk(std::uint32_t index) const;
  Expected<std::vector<std::uint8_t>, std::string> Message(const StoredMessage& message) const;

  // Throws InputError "path: byte 4117: why".
  [[noreturn]] void FailAt(std::uint64_t offset, const std::string& why) const;

 private:
  struct ChunkPlace {
    std::uint64_t offset = 0, stored = 0, size = 0;
    Compression compression = Compression::kNone;
  };
  // The parts that were asked for last, newest first: messages of two cameras lie close together.
  using RecentChunks = std::array<std::pair<std::uint32_t, ChunkBytes>, 4>;

  std::filesystem::path path_;
  std::uint64_t size_ = 0;
  std::vector<Channel> channels_;
  std::vector<ChunkPlace> chunks_;
  mutable std::mutex mutex_;
  mutable std::ifstream file_;
  mutable RecentChunks recent_;
};

}  // namespace plumbline
