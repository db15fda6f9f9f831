// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/mcap_file_writer.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/recordings/recording_formats.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <numeric>
#include <span>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>
#include <zstd.h>

namespace plumbline {
namespace {

constexpr std::string_view kMagic = kMcapMagic;
constexpr int kZstdLevel = 1;

using mcap::Op;
using enum mcap::Op;

// The fields of one record.
class Fields {
 public:
  template <class T>
  Fields& Number(T value) {
    writer_(value);
    return *this;
  }
  Fields& Text(std::string_view text) {
    writer_(static_cast<std::uint32_t>(text.size()));
    return Bytes(text);
  }
  Fields& Bytes(std::string_view bytes) {
    const std::span<char> to = writer_.Append(bytes.size());
    std::copy(bytes.begin(), bytes.end(), to.begin());
    return *this;
  }
  const std::string& bytes() const { return writer_.bytes(); }

 private:
  ByteWriter writer_;
};

std::string Record(Op op, const Fields& fields) {
  return Fields()
      .Number(static_cast<std::uint8_t>(op))
      .Number(std::uint64_t{fields.bytes().size()})
      .Bytes(fields.bytes())
      .bytes();
}

std::uint32_t CrcOf(std::string_view bytes, std::uint32_t crc = 0) {
  return Crc32(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), crc);
}

std::string Packed(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kZstdLevel);
  PLUMBLINE_CHECK(ZSTD_isError(size) == 0, "there is room for the worst case");
  packed.resize(size);
  return packed;
}

std::uint64_t TimeOf(std::int64_t time_ns) {
  return time_ns > 0 ? static_cast<std::uint64_t>(time_ns) : 0;
}

// Returns the last error of the operating system; there is none if a stream failed by itself.
std::string LastReason() {
  return errno == 0 ? std::string("unknown reason") : std::generic_category().message(errno);
}

// Returns true if a running program has locked the file.
bool IsBeingWritten(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  (void)::close(descriptor);
  return held;
}

// A new file, locked as long as it is open; null and errno if it cannot be made. A file that
// appeared at the path meanwhile is neither followed nor emptied. File systems without locks do
// without.
std::FILE* MakeLockedFile(const std::filesystem::path& path) {
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return nullptr;
  (void)::flock(descriptor, LOCK_EX | LOCK_NB);
  std::FILE* file = ::fdopen(descriptor, "wb");
  if (file == nullptr) (void)::close(descriptor);
  return file;
}

}  // namespace

std::string McapFileWriter::Beginning() {
  return std::string(kMagic) + Record(kHeader, Fields().Text("").Text("plumbline"));
}

std::filesystem::path McapFileWriter::PartOf(const std::filesystem::path& path) {
  return path.string() + ".part";
}

std::optional<std::string> McapFileWriter::SetPartAside(const std::filesystem::path& path) {
  const std::filesystem::path part = PartOf(path);
  if (!IsTaken(part)) return std::nullopt;
  std::error_code error;
  const bool link = std::filesystem::is_symlink(part, error);
  const bool file = !link && std::filesystem::is_regular_file(part, error);
  // A part is empty if the program died before writing.
  const bool ours =
      file && (std::filesystem::file_size(part, error) == 0 || FileBeginsWith(part, Beginning()));
  if (!ours) {
    throw InputError(
        fmt::format("{}: expected nothing, or a recording that was not completed, found {}; move "
                    "it away or record to another file",
                    part.string(),
                    link   ? "a link"
                    : file ? "another file"
                           : KindOf(part)));
  }
  if (IsBeingWritten(part)) throw InputError(part.string() + ": another run is writing this file");
  int k = 1;
  const auto kept = [&] { return fmt::format("{}-{}", part.string(), k); };
  while (IsTaken(kept())) ++k;
  std::filesystem::rename(part, kept(), error);
  if (error) throw InputError("cannot write " + kept() + ": " + error.message());
  return fmt::format("{}: an earlier run did not complete it; what it had recorded is in {}",
                     path.string(),
                     kept());
}

McapFileWriter::McapFileWriter(std::filesystem::path path)
    : path_(std::move(path)), part_(PartOf(path_)) {
  (void)SetPartAside(path_);
  errno = 0;
  file_.reset(MakeLockedFile(part_));
  if (!file_) throw InputError("cannot write " + part_.string() + ": " + LastReason());
  Append(Beginning());
}

McapFileWriter::~McapFileWriter() {
  const bool empty = std::all_of(counts_.begin(), counts_.end(), [](auto n) { return n == 0; });
  if (empty && !closed_) {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
    return;
  }
  try {
    Close();
  } catch (const std::exception&) {
    // The data remain under the name of the part.
  }
}

void McapFileWriter::Fail() const {
  throw InputError(fmt::format(
      "cannot write {}: {} ({} has what there is)", path_.string(), LastReason(), part_.string()));
}

void McapFileWriter::Append(const std::string& bytes) {
  errno = 0;
  // Nothing is written after a failed write: the file would appear complete.
  const bool broken = std::ferror(file_.get()) != 0;
  if (broken || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) Fail();
  size_ += bytes.size();
  crc_ = CrcOf(bytes, crc_);
}

std::uint16_t McapFileWriter::AddChannel(const McapChannel& channel) {
  const auto id = static_cast<std::uint16_t>(counts_.size());
  const auto schema = static_cast<std::uint16_t>(id + 1);  // 0 means none
  counts_.push_back(0);
  descriptions_.push_back(Record(kSchema,
                                 Fields()
                                     .Number(schema)
                                     .Text(channel.type)
                                     .Text(channel.schema_encoding)
                                     .Text(channel.schema)));
  descriptions_.push_back(Record(kChannel,
                                 Fields()
                                     .Number(id)
                                     .Number(schema)
                                     .Text(channel.topic)
                                     .Text(channel.encoding)
                                     .Number(std::uint32_t{0})));
  Append(descriptions_[descriptions_.size() - 2]);
  Append(descriptions_.back());
  return id;
}

void McapFileWriter::Write(std::uint16_t channel, std::int64_t time_ns, std::string_view message) {
  const std::uint64_t time = TimeOf(time_ns);
  if (chunk_.empty()) {
    chunk_place_ = {};
    chunk_place_.first_ns = chunk_place_.last_ns = time;
  }
  chunk_place_.first_ns = std::min(chunk_place_.first_ns, time);
  chunk_place_.last_ns = std::max(chunk_place_.last_ns, time);
  chunk_index_[channel].emplace_back(time, chunk_.size());
  chunk_ += Record(kMessage,
                   Fields()
                       .Number(channel)
                       .Number(static_cast<std::uint32_t>(counts_.at(channel)))
                       .Number(time)
                       .Number(time)
                       .Bytes(message));
  ++counts_[channel];
  if (chunk_.size() >= kChunkBytes) EndChunk();
}

void McapFileWriter::EndChunk() {
  if (chunk_.empty()) return;
  const std::string packed = Packed(chunk_);
  ChunkPlace place = std::exchange(chunk_place_, {});
  place.offset = size_;
  place.packed = packed.size();
  place.unpacked = chunk_.size();
  Append(Record(kChunk,
                Fields()
                    .Number(place.first_ns)
                    .Number(place.last_ns)
                    .Number(place.unpacked)
                    .Number(CrcOf(chunk_))
                    .Text("zstd")
                    .Number(place.packed)
                    .Bytes(packed)));
  place.size = size_ - place.offset;
  for (const auto& [channel, index] : chunk_index_) {
    place.indices[channel] = size_;
    Fields entries;
    for (const auto& [time, offset] : index) entries.Number(time).Number(offset);
    Append(Record(kMessageIndex, Fields().Number(channel).Text(entries.bytes())));
  }
  place.index_size = size_ - place.offset - place.size;
  const bool first = chunks_.empty();
  first_ns_ = first ? place.first_ns : std::min(first_ns_, place.first_ns);
  last_ns_ = std::max(last_ns_, place.last_ns);
  chunks_.push_back(std::move(place));
  chunk_.clear();
  chunk_index_.clear();
}

// Appends schemas and channels again, the places of the chunks, and the number of messages in each
// channel.
void McapFileWriter::AppendSummary() {
  for (const std::string& description : descriptions_) Append(description);
  for (const ChunkPlace& place : chunks_) {
    Fields indices;
    for (const auto& [channel, offset] : place.indices) indices.Number(channel).Number(offset);
    Append(Record(kChunkIndex,
                  Fields()
                      .Number(place.first_ns)
                      .Number(place.last_ns)
                      .Number(place.offset)
                      .Number(place.size)
                      .Text(indices.bytes())
                      .Number(place.index_size)
                      .Text("zstd")
                      .Number(place.packed)
                      .Number(place.unpacked)));
  }
  Fields counts;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts.Number(static_cast<std::uint16_t>(i)).Number(counts_[i]);
  }
  Append(Record(kStatistics,
                Fields()
                    .Number(std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}))
                    .Number(static_cast<std::uint16_t>(counts_.size()))
                    .Number(static_cast<std::uint32_t>(counts_.size()))
                    .Number(std::uint32_t{0})  // number of attachments
                    .Number(std::uint32_t{0})  // number of metadata records
                    .Number(static_cast<std::uint32_t>(chunks_.size()))
                    .Number(first_ns_)
                    .Number(last_ns_)
                    .Text(counts.bytes())));
}

void McapFileWriter::Close() {
  if (std::exchange(closed_, true)) return;
  EndChunk();
  Append(Record(kDataEnd, Fields().Number(crc_)));
  const std::uint64_t summary = size_;
  crc_ = 0;
  AppendSummary();
  // The checksum covers the summary and the footer before it.
  const std::string footer_head = Fields()
                                      .Number(static_cast<std::uint8_t>(kFooter))
                                      .Number(std::uint64_t{20})
                                      .Number(summary)
                                      .Number(std::uint64_t{0})
                                      .bytes();
  Append(footer_head);
  Append(Fields().Number(crc_).bytes());
  Append(std::string(kMagic));
  errno = 0;
  if (std::fflush(file_.get()) != 0) Fail();
  if (std::fclose(file_.release()) != 0) Fail();
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  errno = error.value();
  if (error) Fail();
}

}  // namespace plumbline
