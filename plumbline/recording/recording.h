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

// Largest chunks and messages in bytes; larger ones are refused.
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 28;

// Messages of one type under one name. A topic may have several channels.
struct Channel {
  std::string topic;
  std::string type;      // "sensor_msgs/Image", "sensor_msgs/msg/Image", "foxglove.RawImage"
  std::string encoding;  // "ros1", "cdr", "protobuf", or another one
};

// The place of a message.
struct StoredMessage {
  std::uint32_t channel = 0;   // index of its channel
  std::uint32_t chunk = 0;     // index of the part of the file that is unpacked for it
  std::uint32_t offset = 0;    // offset in the unpacked part, bytes
  std::uint32_t size = 0;      // bytes
  std::int64_t logged_ns = 0;  // time when it was recorded
};

// Takes a message with its place and its bytes, without its header. The bytes are valid during the
// call.
using MessageSink =
    std::function<void(const Channel&, const StoredMessage&, std::span<const std::uint8_t>)>;

// The bytes of unpacked parts, shared by all that read from them.
using ChunkBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// A file of messages in parts that are each packed by themselves. The formats know how the parts
// are found (ros_bag.h, mcap.h). Messages of parts that were read recently are found quickly.
class Recording {
 public:
  // Opens a file. Throws InputError where there is no such file.
  explicit Recording(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  const std::vector<Channel>& channels() const { return channels_; }

  // Adds a channel and returns its index.
  std::uint32_t AddChannel(Channel channel);
  // Adds a part of the file and returns its index: `stored` bytes at `offset`, which hold `size`
  // bytes.
  std::uint32_t AddChunk(std::uint64_t offset,
                         std::uint64_t stored,
                         Compression compression,
                         std::uint64_t size);

  // Returns bytes of the file as they are. Throws InputError where it has fewer.
  std::vector<std::uint8_t> Bytes(std::uint64_t offset, std::uint64_t count) const;
  // Returns the unpacked part, or what is wrong with it. Thread-safe, as Message is.
  Expected<ChunkBytes, std::string> Chunk(std::uint32_t index) const;
  Expected<std::vector<std::uint8_t>, std::string> Message(const StoredMessage& message) const;

  // Throws InputError "path: byte 4117: why".
  [[noreturn]] void FailAt(std::uint64_t offset, const std::string& why) const;

 private:
  struct ChunkPlace {
    std::uint64_t offset = 0, stored = 0, size = 0;
    Compression compression = Compression::kNone;
  };
  // The parts that were used last, newest first: messages of two cameras lie close together.
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
