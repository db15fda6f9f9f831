// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
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

// Location of a message.
struct StoredMessage {
  std::uint32_t channel = 0;   // index of its channel
  std::uint32_t chunk = 0;     // index of the chunk of the message, or its row
  std::uint32_t offset = 0;    // offset in the unpacked part, bytes
  std::uint32_t size = 0;      // bytes
  std::int64_t logged_ns = 0;  // time of recording
  std::uint32_t file = 0;      // index of the file, in a recording of several
};

// Receives a message with its location and its bytes, without its header. The bytes are valid
// during the call.
using MessageSink =
    std::function<void(const Channel&, const StoredMessage&, std::span<const std::uint8_t>)>;

// Recorded messages, in one file or in several. recording_formats.h reads the formats.
class Recording {
 public:
  explicit Recording(std::filesystem::path path) : path_(std::move(path)) {}
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  virtual ~Recording() = default;

  // The file or folder, for error messages.
  const std::filesystem::path& path() const { return path_; }
  const std::vector<Channel>& channels() const { return channels_; }
  // Missing parts: one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

  // Adds a channel and returns its index.
  std::uint32_t AddChannel(Channel channel);
  void AddNote(std::string note) { notes_.push_back(std::move(note)); }

  // Returns the bytes of a message, unpacked if it was packed by itself (UnpackedMessage), or its
  // fault. Thread-safe.
  Expected<std::vector<std::uint8_t>, std::string> Message(const StoredMessage& message) const;
  // Returns the stored bytes of a message. Thread-safe.
  virtual Expected<std::vector<std::uint8_t>, std::string> StoredBytes(
      const StoredMessage& message) const = 0;

 private:
  std::filesystem::path path_;
  std::vector<Channel> channels_;
  std::vector<std::string> notes_;
};

// Returns the unpacked bytes of a message that ROS 2 packed by itself (`--compression-mode
// message`), or the reason of a failure; nullopt if the message is not packed.
std::optional<Expected<std::vector<std::uint8_t>, std::string>> UnpackedMessage(
    const Channel& channel, std::span<const std::uint8_t> bytes);

// Throws InputError if there is no file at the path, or something else.
void CheckIsFile(const std::filesystem::path& path);

}  // namespace plumbline
