// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/crc32.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/recordings/byte_cursor.h"
#include "plumbline/io/recordings/chunk_file.h"
#include "plumbline/io/recordings/recording_formats.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::string_view kMagic = kMcapMagic;
constexpr std::uint64_t kRecordHeader = 9;  // op, length
// Bytes in front of the records, without the name of the compression.
constexpr std::uint64_t kChunkHeader = 32;
constexpr std::uint64_t kMessageHeader = 22;
constexpr std::uint64_t kLongestName = 1024;  // longest name of a compression

using enum mcap::Op;
using ByteSpan = std::span<const std::uint8_t>;

std::string_view AsText(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Goes through a file once.
class McapReader {
 public:
  McapReader(const std::filesystem::path& path,
             const MessageSink& sink,
             const std::filesystem::path& name = {})
      : file_(std::make_unique<ChunkFile>(path, name)), sink_(sink) {}

  std::unique_ptr<ChunkFile> Read() {
    CheckBegin();
    CheckEnd();
    ReadRecords();
    return std::move(file_);
  }

  std::unique_ptr<ChunkFile> ReadWhatIsThere() {
    CheckBegin();
    try {
      ReadRecords();
    } catch (const InputError& error) {
      if (file_->channels().empty()) throw;  // nothing comes before
      file_->AddNote(std::string(error.what()) + "; what comes before is read");
    }
    return std::move(file_);
  }

 private:
  struct Record {
    std::uint8_t op = 0;
    std::uint64_t at = 0, data = 0, size = 0;
  };

  void ReadRecords() {
    std::uint64_t at = kMagic.size();
    for (bool first = true; !ended_; first = false) {
      const Record record = ReadRecord(at);
      if (first != (record.op == kHeader)) {
        file_->FailAt(at, "expected one header, in front of everything else");
      }
      Take(record);
      at = record.data + record.size;
    }
    if (!data_ended_) file_->FailAt(at, "expected the end of the data before the footer");
    if (at + kMagic.size() != file_->size() || AsText(file_->Bytes(at, kMagic.size())) != kMagic) {
      file_->FailAt(at, "expected the end of the file, found something else");
    }
  }

  void CheckBegin() const {
    const auto begin = file_->Bytes(0, std::min<std::uint64_t>(kMagic.size(), file_->size()));
    if (AsText(begin) != kMagic) {
      throw InputError(file_->path().string() +
                       ": expected an MCAP file, found another file, or a version of it "
                       "that is not known");
    }
  }

  void CheckEnd() const {
    const bool whole = file_->size() >= 2 * kMagic.size() &&
                       AsText(file_->Bytes(file_->size() - kMagic.size(), kMagic.size())) == kMagic;
    if (!whole) {
      throw InputError(file_->path().string() +
                       ": expected the end of an MCAP file, found none: the file ends early "
                       "or was not closed (mcap recover completes it)");
    }
  }

  Record ReadRecord(std::uint64_t at) const {
    const std::vector<std::uint8_t> bytes = file_->Bytes(at, kRecordHeader);
    ByteCursor cursor(bytes);
    Record record{cursor.U8(), at, at + kRecordHeader, cursor.U64()};
    if (record.size > file_->size() - record.data) {
      file_->FailAt(at,
                    fmt::format("expected {} bytes of a record, but the file ends at {}",
                                record.size,
                                file_->size()));
    }
    return record;
  }

  void Take(const Record& record) {
    switch (record.op) {
      case kSchema:
      case kChannel:
        return TakeDescription(record.op, Contents(record), record.at);
      case kMessage:
        return TakeLooseMessage(record);
      case kChunk:
        return TakeChunk(record);
      case kDataEnd:
        data_ended_ = true;
        return CheckData(record);
      case kFooter:
        ended_ = true;
        return;
      default:  // indices, attachments, and records of later versions
        if (record.op == 0) file_->FailAt(record.at, "expected a record, found damage");
    }
  }

  std::vector<std::uint8_t> Contents(const Record& record) const {
    if (record.size > kLargestChunk) file_->FailAt(record.at, "expected a record, found damage");
    return file_->Bytes(record.data, record.size);
  }

  // Verifies the checksum of all bytes before the end of the data, if there is one.
  void CheckData(const Record& record) const {
    const std::uint32_t wanted = ByteCursor(Contents(record)).U32();
    if (wanted == 0) return;
    std::uint32_t crc = 0;
    constexpr std::uint64_t kPiece = 1 << 20;
    for (std::uint64_t at = 0; at < record.at; at += kPiece) {
      crc = Crc32(file_->Bytes(at, std::min(kPiece, record.at - at)), crc);
    }
    if (crc != wanted) {
      file_->FailAt(record.at, "expected the checksum of the data, found another: it is damaged");
    }
  }

  void TakeDescription(std::uint8_t op, ByteSpan bytes, std::uint64_t at) {
    ByteCursor cursor(bytes);
    const std::uint16_t id = cursor.U16();
    if (op == kSchema) {
      const std::string_view name = cursor.Text32();
      cursor.Text32();  // language of the schema
      cursor.Text32();
      if (!cursor.ok()) file_->FailAt(at, "expected a schema, found damage");
      if (data_ended_) return;
      const auto [known, added] = schemas_.try_emplace(id, name);
      if (!added && known->second != name) {
        file_->FailAt(at, fmt::format("expected schema {} to be described once", id));
      }
      return;
    }
    const std::uint16_t schema = cursor.U16();
    const std::string_view topic = cursor.Text32();
    const std::string_view encoding = cursor.Text32();
    if (!cursor.ok()) file_->FailAt(at, "expected a channel, found damage");
    if (!data_ended_) AddChannel(id, schema, {std::string(topic), "", std::string(encoding)}, at);
  }

  void AddChannel(std::uint16_t id, std::uint16_t schema, Channel channel, std::uint64_t at) {
    const auto type = schemas_.find(schema);
    if (schema != 0 && type == schemas_.end()) {
      file_->FailAt(at, fmt::format("expected schema {} to be described, found none", schema));
    }
    if (schema != 0) channel.type = type->second;
    const auto known = channels_.find(id);
    if (known == channels_.end()) {
      channels_[id] = file_->AddChannel(std::move(channel));
      return;
    }
    const Channel& before = file_->channels()[known->second];
    if (before.topic != channel.topic || before.type != channel.type ||
        before.encoding != channel.encoding) {
      file_->FailAt(at, fmt::format("expected channel {} to be described once", id));
    }
  }

  // Takes a message that is in no chunk; it becomes a part of the file by itself.
  void TakeLooseMessage(const Record& record) {
    const std::uint32_t index =
        file_->AddChunk(record.data, record.size, Compression::kNone, record.size);
    const auto bytes = file_->Chunk(index);
    if (!bytes) file_->FailAt(record.at, bytes.error());
    TakeMessage(**bytes, {0, index, 0, 0, 0}, record.at);
  }

  // Takes a message. place.offset is the beginning of the record in its part of the file.
  void TakeMessage(ByteSpan record, StoredMessage place, std::uint64_t at) {
    ByteCursor cursor(record);
    const std::uint16_t id = cursor.U16();
    cursor.U32();  // number of the message in its channel
    const std::uint64_t logged = cursor.U64();
    cursor.U64();  // time when it was sent
    if (!cursor.ok()) file_->FailAt(at, "expected a message, found damage");
    if (data_ended_) file_->FailAt(at, "expected no message behind the end of the data");
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) {
      file_->FailAt(at, fmt::format("expected channel {} to be described, found none", id));
    }
    place.channel = channel->second;
    place.offset += kMessageHeader;
    place.size = static_cast<std::uint32_t>(record.size() - kMessageHeader);
    place.logged_ns = static_cast<std::int64_t>(std::min<std::uint64_t>(logged, INT64_MAX));
    sink_(file_->channels()[place.channel], place, record.subspan(kMessageHeader));
  }

  void TakeChunk(const Record& record) {
    const std::uint64_t head = std::min(record.size, kChunkHeader + kLongestName + 8);
    const std::vector<std::uint8_t> bytes = file_->Bytes(record.data, head);
    ByteCursor cursor(bytes);
    cursor.U64();  // the times of the first and of the last message
    cursor.U64();
    const std::uint64_t size = cursor.U64();
    const std::uint32_t crc = cursor.U32();
    const std::string_view name = cursor.Text32();
    const std::uint64_t stored = cursor.U64();
    if (!cursor.ok() || stored != record.size - cursor.position()) {
      file_->FailAt(record.at, "expected a chunk, found damage");
    }
    const std::uint32_t index = file_->AddChunk(
        record.data + cursor.position(), stored, CompressionOf(name, record.at), size);
    const auto chunk = file_->Chunk(index);
    if (!chunk) file_->FailAt(record.at, chunk.error());
    if (crc != 0 && Crc32(**chunk) != crc) {
      file_->FailAt(record.at, "expected the checksum of a chunk, found another: it is damaged");
    }
    TakeRecordsOf(**chunk, index, record.at);
  }

  Compression CompressionOf(std::string_view name, std::uint64_t at) const {
    if (name.empty() || name == "none") return Compression::kNone;
    if (name == "lz4") return Compression::kLz4;
    if (name == "zstd") return Compression::kZstd;
    file_->FailAt(at, "expected a chunk packed by lz4, zstd or not, found " + InQuotes(name));
  }

  // Takes the records in a chunk: schemas, channels and messages.
  void TakeRecordsOf(ByteSpan bytes, std::uint32_t chunk, std::uint64_t at) {
    ByteCursor cursor(bytes);
    while (cursor.remaining() > 0) {
      const std::uint8_t op = cursor.U8();
      const ByteSpan record = cursor.Take(cursor.U64());
      if (!cursor.ok()) file_->FailAt(at, "expected whole records in a chunk, found damage");
      const std::size_t offset = cursor.position() - record.size();
      if (op == kMessage) {
        TakeMessage(record, {0, chunk, static_cast<std::uint32_t>(offset), 0, 0}, at);
      } else if (op == kSchema || op == kChannel) {
        TakeDescription(op, record, at);
      } else if (op < kFirstPrivate) {
        file_->FailAt(at, fmt::format("expected messages in a chunk, found op {}", op));
      }
    }
  }

  std::unique_ptr<ChunkFile> file_;
  const MessageSink& sink_;
  std::map<std::uint16_t, std::string> schemas_;     // name of each id
  std::map<std::uint16_t, std::uint32_t> channels_;  // index of each id
  bool data_ended_ = false, ended_ = false;
};

}  // namespace

bool BeginsAsMcap(ByteSpan bytes) { return AsText(bytes).starts_with(kMagic); }

std::unique_ptr<Recording> ReadMcap(const std::filesystem::path& path, const MessageSink& sink) {
  return McapReader(path, sink).Read();
}

std::unique_ptr<Recording> ReadMcapPart(const std::filesystem::path& path,
                                        const MessageSink& sink,
                                        const std::filesystem::path& name) {
  return McapReader(path, sink, name).ReadWhatIsThere();
}

}  // namespace plumbline
