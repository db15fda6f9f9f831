// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/chunk_file.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include <fmt/format.h>

namespace plumbline {

ChunkFile::ChunkFile(const std::filesystem::path& path, const std::filesystem::path& name)
    : Recording(name.empty() ? path : name) {
  CheckIsFile(path);
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  file_.open(path, std::ios::binary);
  if (!file_ || error) throw InputError(this->path().string() + ": cannot be read");
}

std::uint32_t ChunkFile::AddChunk(std::uint64_t offset,
                                  std::uint64_t stored,
                                  Compression compression,
                                  std::uint64_t size) {
  if (size > kLargestChunk || stored > kLargestChunk) {
    FailAt(offset,
           fmt::format("expected at most {} bytes in one piece, found {}",
                       kLargestChunk,
                       std::max(size, stored)));
  }
  if (chunks_.size() == std::numeric_limits<std::uint32_t>::max()) {
    FailAt(offset, "expected fewer chunks");
  }
  chunks_.push_back({offset, stored, size, compression});
  return static_cast<std::uint32_t>(chunks_.size() - 1);
}

std::vector<std::uint8_t> ChunkFile::Bytes(std::uint64_t offset, std::uint64_t count) const {
  if (offset > size_ || count > size_ - offset) {
    FailAt(offset, fmt::format("expected {} bytes, but the file ends at {}", count, size_));
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  const std::lock_guard lock(mutex_);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!file_) FailAt(offset, "cannot be read");
  return bytes;
}

Expected<ChunkBytes, std::string> ChunkFile::Chunk(std::uint32_t index) const {
  const ChunkPlace& place = chunks_.at(index);
  {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(recent_.begin(), recent_.end(), [&](const auto& chunk) {
      return chunk.second != nullptr && chunk.first == index;
    });
    if (known != recent_.end()) {
      std::rotate(recent_.begin(), known, known + 1);
      return recent_.front().second;
    }
  }
  std::vector<std::uint8_t> packed;
  try {
    packed = Bytes(place.offset, place.stored);
  } catch (const InputError& error) {
    return std::string(error.what());
  }
  if (place.compression != Compression::kNone || packed.size() != place.size) {
    const auto unpacked = Decompress(place.compression, packed, place.size);
    if (!unpacked) return unpacked.error();
    packed = *unpacked;
  }
  auto bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(packed));
  const std::lock_guard lock(mutex_);
  std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
  recent_.front() = {index, bytes};
  return ChunkBytes(bytes);
}

Expected<std::vector<std::uint8_t>, std::string> ChunkFile::StoredBytes(
    const StoredMessage& message) const {
  const auto chunk = Chunk(message.chunk);
  if (!chunk) return chunk.error();
  const std::vector<std::uint8_t>& bytes = **chunk;
  if (message.offset > bytes.size() || message.size > bytes.size() - message.offset) {
    return std::string("the file has changed");
  }
  const auto begin = bytes.begin() + message.offset;
  return std::vector<std::uint8_t>(begin, begin + message.size);
}

void ChunkFile::FailAt(std::uint64_t offset, const std::string& why) const {
  throw InputError(fmt::format("{}: byte {}: {}", path().string(), offset, why));
}

}  // namespace plumbline
