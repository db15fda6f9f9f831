// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"
#include "plumbline/base/units.h"
#include "plumbline/io/recordings/byte_cursor.h"
#include "plumbline/io/recordings/chunk_file.h"
#include "plumbline/io/recordings/recording_formats.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::string_view kMagicOfAny = "#ROSBAG V";
constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLargestHeader = 1 << 20;

enum Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

using ByteSpan = std::span<const std::uint8_t>;

// The header of a record or of a connection: name=value, each behind its length.
class Fields {
 public:
  // Returns false if the bytes are malformed.
  bool Parse(ByteSpan bytes) {
    fields_.clear();
    ByteCursor cursor(bytes);
    while (cursor.remaining() > 0) {
      const std::string_view field = cursor.Text32();
      const std::size_t equals = field.find('=');
      if (!cursor.ok() || equals == std::string_view::npos) return false;
      fields_.emplace_back(field.substr(0, equals), field.substr(equals + 1));
    }
    return true;
  }

  std::optional<std::string_view> Text(std::string_view name) const {
    for (const auto& [key, value] : fields_) {
      if (key == name) return value;
    }
    return std::nullopt;
  }

  // Returns a number of `size` bytes.
  std::optional<std::uint64_t> Number(std::string_view name, std::size_t size) const {
    const auto text = Text(name);
    if (!text || text->size() != size) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) {
      value = (value << 8) | static_cast<unsigned char>((*text)[i]);
    }
    return value;
  }

 private:
  std::vector<std::pair<std::string_view, std::string_view>> fields_;
};

// Goes through a bag once.
class BagReader {
 public:
  BagReader(const std::filesystem::path& path, const MessageSink& sink)
      : bag_(std::make_unique<ChunkFile>(path)), sink_(sink) {}

  std::unique_ptr<ChunkFile> Read() {
    CheckMagic();
    std::uint64_t at = kMagic.size();
    for (bool first = true; at < bag_->size(); first = false) {
      const Record record = ReadRecord(at);
      if (first != (record.op == kBagHeader)) {
        bag_->FailAt(at, "expected one bag header, in front of everything else");
      }
      Take(record);
      at = record.data + record.data_size;
    }
    CheckComplete();
    return std::move(bag_);
  }

 private:
  struct Record {
    std::uint64_t at = 0;
    std::vector<std::uint8_t> header;
    Fields fields;  // fields of the header
    std::uint64_t op = 0;
    std::uint64_t data = 0, data_size = 0;
  };

  void CheckMagic() const {
    const auto bytes = bag_->Bytes(0, std::min<std::uint64_t>(kMagic.size(), bag_->size()));
    const std::string_view found(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (found == kMagic) return;
    const std::string path = bag_->path().string();
    if (found.starts_with(kMagicOfAny) && found.size() == kMagic.size()) {
      throw InputError(path + ": expected a bag of version 2.0, found " +
                       InQuotes(found.substr(0, found.find('\n'))));
    }
    throw InputError(path + ": expected a ROS 1 bag, found another file or a bag that ends early");
  }

  Record ReadRecord(std::uint64_t at) const {
    Record record;
    record.at = at;
    const std::uint64_t header_size = ReadLength(at);
    if (header_size > kLargestHeader) bag_->FailAt(at, "expected a record, found damage");
    record.header = bag_->Bytes(at + 4, header_size);
    ParseHeader(record.header, at, record.fields, record.op);
    const std::uint64_t length_at = at + 4 + header_size;
    record.data_size = ReadLength(length_at);
    record.data = length_at + 4;
    if (record.data_size > bag_->size() - record.data) {
      bag_->FailAt(length_at,
                   fmt::format("expected {} bytes of a record, but the file ends at {}",
                               record.data_size,
                               bag_->size()));
    }
    return record;
  }

  std::uint64_t ReadLength(std::uint64_t at) const {
    const std::vector<std::uint8_t> bytes = bag_->Bytes(at, 4);
    return ByteCursor(bytes).U32();
  }

  void ParseHeader(ByteSpan header, std::uint64_t at, Fields& fields, std::uint64_t& op) const {
    if (!fields.Parse(header)) bag_->FailAt(at, "expected the header of a record, found damage");
    const auto found = fields.Number("op", 1);
    if (!found) bag_->FailAt(at, "expected a record with an op, found none");
    op = *found;
  }

  template <std::size_t kSize>
  std::uint64_t Number(const Fields& fields, const char* name, std::uint64_t at) const {
    const auto value = fields.Number(name, kSize);
    if (!value) {
      bag_->FailAt(at, fmt::format("expected a field '{}' of {} bytes, found none", name, kSize));
    }
    return *value;
  }

  void Take(const Record& record) {
    switch (record.op) {
      case kBagHeader:
        return TakeBagHeader(record);
      case kChunk:
        return TakeChunk(record);
      case kConnection: {
        const auto data = bag_->Bytes(record.data, record.data_size);
        TakeConnection(record.fields, data, record.at);
        ++described_;
        return;
      }
      case kChunkInfo:
        ++chunk_infos_;
        return;
      case kIndex:
        return;
      default:
        bag_->FailAt(record.at, fmt::format("expected a record of a bag, found op {}", record.op));
    }
  }

  void TakeBagHeader(const Record& record) {
    const auto encryptor = record.fields.Text("encryptor");
    if (encryptor && !encryptor->empty()) {
      throw InputError(bag_->path().string() + ": expected a bag that is not encrypted, found " +
                       InQuotes(*encryptor));
    }
    index_at_ = Number<8>(record.fields, "index_pos", record.at);
    connection_count_ = Number<4>(record.fields, "conn_count", record.at);
    chunk_count_ = Number<4>(record.fields, "chunk_count", record.at);
    if (index_at_ == 0) {
      throw InputError(bag_->path().string() +
                       ": expected a bag with its index, found one that was not closed (rosbag "
                       "reindex completes it)");
    }
    if (index_at_ > bag_->size()) {
      throw InputError(fmt::format("{}: expected the index at byte {}, but the file ends at {}",
                                   bag_->path().string(),
                                   index_at_,
                                   bag_->size()));
    }
  }

  void TakeChunk(const Record& record) {
    ++chunks_;
    const std::string_view name = record.fields.Text("compression").value_or("");
    Compression compression = Compression::kNone;
    if (name == "bz2") {
      compression = Compression::kBzip2;
    } else if (name == "lz4") {
      compression = Compression::kLz4;
    } else if (name != "none") {
      bag_->FailAt(record.at,
                   "expected a chunk packed by none, bz2 or lz4, found " + InQuotes(name));
    }
    const std::uint64_t size = Number<4>(record.fields, "size", record.at);
    const std::uint32_t index = bag_->AddChunk(record.data, record.data_size, compression, size);
    const auto chunk = bag_->Chunk(index);
    if (!chunk) bag_->FailAt(record.at, chunk.error());
    TakeRecordsOf(**chunk, index, record.at);
  }

  // Takes the records in a chunk: connections and messages.
  void TakeRecordsOf(ByteSpan bytes, std::uint32_t chunk, std::uint64_t at) {
    ByteCursor cursor(bytes);
    Fields fields;
    while (cursor.remaining() > 0) {
      const ByteSpan header = cursor.Take(cursor.U32());
      const ByteSpan data = cursor.Take(cursor.U32());
      if (!cursor.ok()) bag_->FailAt(at, "expected whole records in a chunk, found damage");
      std::uint64_t op = 0;
      ParseHeader(header, at, fields, op);
      if (op == kConnection) {
        TakeConnection(fields, data, at);
      } else if (op == kMessage) {
        const std::size_t offset = cursor.position() - data.size();
        TakeMessage(fields, data, {0, chunk, static_cast<std::uint32_t>(offset), 0, 0}, at);
      } else {
        bag_->FailAt(at, fmt::format("expected messages in a chunk, found op {}", op));
      }
    }
  }

  void TakeConnection(const Fields& fields, ByteSpan data, std::uint64_t at) {
    const std::uint64_t id = Number<4>(fields, "conn", at);
    Fields about;
    const auto topic = fields.Text("topic");
    if (!topic || !about.Parse(data) || !about.Text("type")) {
      bag_->FailAt(at, "expected the topic and the type of a connection, found damage");
    }
    const auto known = channels_.find(id);
    if (known == channels_.end()) {
      channels_[id] =
          bag_->AddChannel({std::string(*topic), std::string(*about.Text("type")), "ros1"});
      return;
    }
    const Channel& channel = bag_->channels()[known->second];
    if (channel.topic != *topic || channel.type != *about.Text("type")) {
      bag_->FailAt(at, fmt::format("expected connection {} to be described once", id));
    }
  }

  void TakeMessage(const Fields& fields, ByteSpan data, StoredMessage place, std::uint64_t at) {
    const std::uint64_t id = Number<4>(fields, "conn", at);
    const std::uint64_t time = Number<8>(fields, "time", at);
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) {
      bag_->FailAt(at, fmt::format("expected connection {} to be described, found none", id));
    }
    place.channel = channel->second;
    place.size = static_cast<std::uint32_t>(data.size());
    place.logged_ns = static_cast<std::int64_t>(time & 0xFFFFFFFFU) * kNsPerSecond +
                      static_cast<std::int64_t>(time >> 32);
    sink_(bag_->channels()[place.channel], place, data);
  }

  void CheckComplete() const {
    const auto check = [&](std::uint64_t found, std::uint64_t expected, const char* what) {
      if (found == expected) return;
      throw InputError(fmt::format("{}: expected {} {}, found {}: the bag is damaged or ends early",
                                   bag_->path().string(),
                                   expected,
                                   what,
                                   found));
    };
    if (bag_->size() == kMagic.size()) bag_->FailAt(bag_->size(), "expected a bag header");
    check(chunks_, chunk_count_, "chunks");
    check(chunk_infos_, chunk_count_, "chunks in the index");
    check(described_, connection_count_, "connections in the index");
  }

  std::unique_ptr<ChunkFile> bag_;
  const MessageSink& sink_;
  std::map<std::uint64_t, std::uint32_t> channels_;  // index of each connection's channel
  // Numbers that the header tells.
  std::uint64_t index_at_ = 0, connection_count_ = 0, chunk_count_ = 0;
  std::uint64_t chunks_ = 0, chunk_infos_ = 0, described_ = 0;  // numbers that were found
};

}  // namespace

bool BeginsAsBag(ByteSpan bytes) {
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())
      .starts_with(kMagicOfAny);
}

std::unique_ptr<Recording> ReadBag(const std::filesystem::path& path, const MessageSink& sink) {
  return BagReader(path, sink).Read();
}

}  // namespace plumbline
