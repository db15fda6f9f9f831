// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/message_writer.h"
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <bzlib.h>
#include <lz4frame.h>

namespace plumbline {

// Compresses by bzip2 ("bz2"), LZ4 ("lz4") or not at all ("none").
inline std::string PackedForBag(const std::string& bytes, const std::string& how) {
  std::string packed;
  if (how == "bz2") {
    auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 64 + 1024);
    packed.resize(size);
    BZ2_bzBuffToBuffCompress(packed.data(),
                             &size,
                             const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()),
                             9,
                             0,
                             0);
    packed.resize(size);
    return packed;
  }
  if (how == "lz4") {
    // Frames as written by ROS: its own reader accepts no others.
    LZ4F_preferences_t frame{};
    frame.frameInfo.blockMode = LZ4F_blockIndependent;
    frame.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    packed.resize(LZ4F_compressFrameBound(bytes.size(), &frame));
    packed.resize(
        LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &frame));
    return packed;
  }
  return bytes;
}

// Writes ROS 1 bags of version 2.0 for tests, with the index required by players.
class BagWriter {
 public:
  // A new chunk begins after this number of bytes.
  explicit BagWriter(std::string packing = "none", std::size_t chunk_bytes = 768 * 1024)
      : packing_(std::move(packing)), chunk_bytes_(chunk_bytes) {}

  void Add(const std::string& topic,
           const std::string& type,
           std::int64_t time_ns,
           const std::string& message) {
    const auto [connection, added] =
        connections_.try_emplace({topic, type}, static_cast<std::uint32_t>(connections_.size()));
    const std::uint32_t id = connection->second;
    const std::string number = LittleEndian(id, 4);
    if (added) chunk_ += Connection(topic, type, id);
    index_[id].emplace_back(Time(time_ns), chunk_.size());
    if (index_.size() == 1 && index_[id].size() == 1) first_ = Time(time_ns);
    last_ = Time(time_ns);
    chunk_ += Record({{"op", "\x02"}, {"conn", number}, {"time", Time(time_ns)}}, message);
    if (chunk_.size() >= chunk_bytes_) EndChunk();
  }

  // The bytes of the file.
  std::string Finish() {
    EndChunk();
    const std::string magic = "#ROSBAG V2.0\n";
    std::string index;
    for (const auto& [name, id] : connections_) index += Connection(name.first, name.second, id);
    index += chunk_infos_;
    const std::uint64_t at = magic.size() + kHeaderRecord + chunks_.size();
    const std::vector<std::pair<std::string, std::string>> fields = {
        {"op", "\x03"},
        {"index_pos", LittleEndian(at, 8)},
        {"conn_count", LittleEndian(connections_.size(), 4)},
        {"chunk_count", LittleEndian(chunk_count_, 4)}};
    const std::size_t used = Record(fields, "").size();
    return magic + Record(fields, std::string(kHeaderRecord - used, ' ')) + chunks_ + index;
  }

 private:
  static constexpr std::size_t kHeaderRecord = 4096 + 8;
  using Fields = std::vector<std::pair<std::string, std::string>>;

  static std::string Joined(const Fields& fields) {
    std::string bytes;
    for (const auto& [name, value] : fields) {
      bytes += LittleEndian(name.size() + 1 + value.size(), 4) + name + '=' + value;
    }
    return bytes;
  }
  static std::string Record(const Fields& fields, const std::string& data) {
    const std::string header = Joined(fields);
    return LittleEndian(header.size(), 4) + header + LittleEndian(data.size(), 4) + data;
  }
  static std::string Connection(const std::string& topic,
                                const std::string& type,
                                std::uint32_t id) {
    const Fields about = {
        {"topic", topic}, {"type", type}, {"md5sum", "*"}, {"message_definition", ""}};
    return Record({{"op", "\x07"}, {"conn", LittleEndian(id, 4)}, {"topic", topic}}, Joined(about));
  }
  static std::string Time(std::int64_t ns) {
    return LittleEndian(static_cast<std::uint64_t>(ns / 1'000'000'000), 4) +
           LittleEndian(static_cast<std::uint64_t>(ns % 1'000'000'000), 4);
  }

  void EndChunk() {
    if (chunk_.empty()) return;
    const std::uint64_t at = std::string("#ROSBAG V2.0\n").size() + kHeaderRecord + chunks_.size();
    chunks_ += Record(
        {{"op", "\x05"}, {"compression", packing_}, {"size", LittleEndian(chunk_.size(), 4)}},
        PackedForBag(chunk_, packing_));
    std::string counts;
    for (const auto& [id, entries] : index_) {
      std::string data;
      for (const auto& [time, offset] : entries) data += time + LittleEndian(offset, 4);
      chunks_ += Record({{"op", "\x04"},
                         {"ver", LittleEndian(1, 4)},
                         {"conn", LittleEndian(id, 4)},
                         {"count", LittleEndian(entries.size(), 4)}},
                        data);
      counts += LittleEndian(id, 4) + LittleEndian(entries.size(), 4);
    }
    chunk_infos_ += Record({{"op", "\x06"},
                            {"ver", LittleEndian(1, 4)},
                            {"chunk_pos", LittleEndian(at, 8)},
                            {"start_time", first_},
                            {"end_time", last_},
                            {"count", LittleEndian(index_.size(), 4)}},
                           counts);
    ++chunk_count_;
    chunk_.clear();
    index_.clear();
  }

  std::string packing_;
  std::size_t chunk_bytes_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> connections_;
  std::string chunk_, chunks_, chunk_infos_, first_, last_;
  std::map<std::uint32_t, std::vector<std::pair<std::string, std::size_t>>> index_;
  std::uint32_t chunk_count_ = 0;
};

}  // namespace plumbline
