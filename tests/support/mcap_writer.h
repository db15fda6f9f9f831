// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/crc32.h"

#include "tests/support/bag_writer.h"
#include "tests/support/message_writer.h"
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include <zstd.h>

namespace plumbline {

// Writes MCAP files for tests: messages in chunks packed by "lz4", "zstd" or not (""), or, for
// chunk_bytes 0, in none; with all checksums or none.
class McapWriter {
 public:
  explicit McapWriter(std::string packing = "",
                      std::size_t chunk_bytes = 1024 * 1024,
                      bool checksums = true)
      : packing_(std::move(packing)), chunk_bytes_(chunk_bytes), checksums_(checksums) {
    file_ = kMagic + Record(1, Text("") + Text("test"));
  }

  void Add(const std::string& topic,
           const std::string& type,
           const std::string& encoding,
           std::int64_t time_ns,
           const std::string& message) {
    std::string& to = chunk_bytes_ == 0 ? file_ : chunk_;
    const auto [channel, added] = channels_.try_emplace(
        {topic, type, encoding}, static_cast<std::uint16_t>(channels_.size()));
    const std::string id = LittleEndian(channel->second, 2);
    if (added) {
      const std::string schema = LittleEndian(channel->second + 1U, 2);
      to += Record(3, schema + Text(type) + Text("text") + Text("definition"));
      to += Record(4, id + schema + Text(topic) + Text(encoding) + LittleEndian(0, 4));
    }
    const std::string time = LittleEndian(static_cast<std::uint64_t>(time_ns), 8);
    to += Record(5, id + LittleEndian(0, 4) + time + time + message);
    if (chunk_bytes_ > 0 && chunk_.size() >= chunk_bytes_) EndChunk();
  }

  // The bytes of the file.
  std::string Finish() {
    EndChunk();
    const std::string crc = LittleEndian(CrcOf(file_), 4);
    file_ += Record(15, crc);
    file_ += Record(2, LittleEndian(0, 8) + LittleEndian(0, 8) + LittleEndian(0, 4));
    return file_ + kMagic;
  }

 private:
  static inline const std::string kMagic = "\x89MCAP0\r\n";

  std::uint32_t CrcOf(const std::string& bytes) const {
    if (!checksums_) return 0;
    return Crc32(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  }
  static std::string Text(const std::string& text) { return LittleEndian(text.size(), 4) + text; }
  static std::string Record(unsigned op, const std::string& data) {
    return static_cast<char>(op) + LittleEndian(data.size(), 8) + data;
  }

  std::string Packed() const {
    if (packing_ != "zstd") return PackedForBag(chunk_, packing_);
    std::string packed(ZSTD_compressBound(chunk_.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), chunk_.data(), chunk_.size(), 1));
    return packed;
  }

  void EndChunk() {
    if (chunk_.empty()) return;
    const std::string packed = Packed();
    file_ += Record(6,
                    LittleEndian(0, 8) + LittleEndian(0, 8) + LittleEndian(chunk_.size(), 8) +
                        LittleEndian(CrcOf(chunk_), 4) + Text(packing_) +
                        LittleEndian(packed.size(), 8) + packed);
    file_ += Record(7, LittleEndian(0, 2) + LittleEndian(0, 4));
    chunk_.clear();
  }

  std::string packing_;
  std::size_t chunk_bytes_;
  bool checksums_;
  std::map<std::tuple<std::string, std::string, std::string>, std::uint16_t> channels_;
  std::string file_, chunk_;
};

}  // namespace plumbline
