// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/recording.h"

#include "plumbline/base/input_file.h"
#include "plumbline/io/recordings/compression.h"

#include <system_error>

namespace plumbline {

std::uint32_t Recording::AddChannel(Channel channel) {
  channels_.push_back(std::move(channel));
  return static_cast<std::uint32_t>(channels_.size() - 1);
}

Expected<std::vector<std::uint8_t>, std::string> Recording::Message(
    const StoredMessage& message) const {
  auto bytes = StoredBytes(message);
  if (!bytes) return bytes;
  if (auto unpacked = UnpackedMessage(channels_.at(message.channel), *bytes)) return *unpacked;
  return bytes;
}

std::optional<Expected<std::vector<std::uint8_t>, std::string>> UnpackedMessage(
    const Channel& channel, std::span<const std::uint8_t> bytes) {
  // CDR begins with 0, Zstandard does not.
  if (channel.encoding != "cdr" || !IsZstd(bytes)) return std::nullopt;
  const auto size = ZstdSize(bytes);
  if (!size || *size > kLargestChunk) {
    return Expected<std::vector<std::uint8_t>, std::string>(
        std::string("expected a packed message that tells its size"));
  }
  return Decompress(Compression::kZstd, bytes, *size);
}

void CheckIsFile(const std::filesystem::path& path) {
  CheckExists(path);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path.string() + ": expected a file, found " + KindOf(path));
  }
}

}  // namespace plumbline
