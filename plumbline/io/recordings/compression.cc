// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/recordings/compression.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <limits>
#include <memory>
#include <system_error>

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

namespace plumbline {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kFirstBytes = 65536;

// The result of one step of unpacking.
struct Step {
  std::size_t taken = 0;  // number of packed bytes that were used
  std::size_t given = 0;
  bool end = false;  // the packed data has ended
  bool failed = false;
};

// Unpacks from `in` to `out` until one of them ends.
class Unpacker {
 public:
  Unpacker() = default;
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  virtual ~Unpacker() = default;
  virtual Step Do(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) = 0;
};

class Bzip2Unpacker : public Unpacker {
 public:
  Bzip2Unpacker() { open_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK; }
  ~Bzip2Unpacker() override {
    if (open_) BZ2_bzDecompressEnd(&stream_);
  }

  Step Do(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    constexpr std::size_t kMost = std::numeric_limits<unsigned>::max() / 2;
    const auto in_size = static_cast<unsigned>(std::min(in.size(), kMost));
    const auto out_size = static_cast<unsigned>(std::min(out.size(), kMost));
    // The library does not write to its input.
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data()));
    stream_.avail_in = in_size;
    stream_.next_out = reinterpret_cast<char*>(out.data());
    stream_.avail_out = out_size;
    const int status = open_ ? BZ2_bzDecompress(&stream_) : BZ_MEM_ERROR;
    return {in_size - stream_.avail_in,
            out_size - stream_.avail_out,
            status == BZ_STREAM_END,
            status != BZ_OK && status != BZ_STREAM_END};
  }

 private:
  bz_stream stream_{};
  bool open_ = false;
};

class Lz4Unpacker : public Unpacker {
 public:
  Lz4Unpacker() { LZ4F_createDecompressionContext(&context_, LZ4F_VERSION); }
  ~Lz4Unpacker() override { LZ4F_freeDecompressionContext(context_); }

  Step Do(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    if (context_ == nullptr) return {0, 0, false, true};
    std::size_t taken = in.size(), given = out.size();
    const std::size_t hint =
        LZ4F_decompress(context_, out.data(), &given, in.data(), &taken, nullptr);
    return {taken, given, hint == 0, LZ4F_isError(hint) != 0};
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class ZstdUnpacker : public Unpacker {
 public:
  ZstdUnpacker() : context_(ZSTD_createDCtx()) {}
  ~ZstdUnpacker() override { ZSTD_freeDCtx(context_); }

  Step Do(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) override {
    if (context_ == nullptr) return {0, 0, false, true};
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(context_, &to, &from);
    return {from.pos, to.pos, hint == 0, ZSTD_isError(hint) != 0};
  }

 private:
  ZSTD_DCtx* context_;
};

std::unique_ptr<Unpacker> MakeUnpacker(Compression compression) {
  switch (compression) {
    case Compression::kBzip2:
      return std::make_unique<Bzip2Unpacker>();
    case Compression::kLz4:
      return std::make_unique<Lz4Unpacker>();
    case Compression::kZstd:
      return std::make_unique<ZstdUnpacker>();
    case Compression::kNone:
      break;
  }
  throw BugError("nothing to unpack");
}

std::string OtherSize(std::uint64_t size, const char* found) {
  return fmt::format("expected packed data of {} bytes, found {}", size, found);
}

}  // namespace

Expected<Bytes, std::string> Decompress(Compression compression,
                                        std::span<const std::uint8_t> packed,
                                        std::uint64_t size) {
  if (compression == Compression::kNone) {
    if (packed.size() < size) return OtherSize(size, "fewer");
    if (packed.size() > size) return OtherSize(size, "more");
    return Bytes(packed.begin(), packed.end());
  }
  const std::unique_ptr<Unpacker> unpacker = MakeUnpacker(compression);
  // One byte more than expected, so that too many bytes show.
  const std::uint64_t most = size + 1;
  Bytes bytes;
  std::size_t filled = 0;
  while (true) {
    if (filled == bytes.size()) {
      const std::uint64_t wanted = std::max(kFirstBytes, 2 * bytes.size());
      bytes.resize(static_cast<std::size_t>(std::min(most, wanted)));
    }
    const Step step = unpacker->Do(packed, std::span(bytes).subspan(filled));
    if (step.failed) return std::string("expected packed data, found damage");
    filled += step.given;
    packed = packed.subspan(step.taken);
    if (filled > size) return OtherSize(size, "more");
    if (step.end) break;
    if (step.taken == 0 && step.given == 0) return OtherSize(size, "fewer");
  }
  if (filled < size) return OtherSize(size, "fewer");
  bytes.resize(filled);
  return bytes;
}

bool IsZstd(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 4> kMagic = {0x28, 0xB5, 0x2F, 0xFD};
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

std::optional<std::uint64_t> ZstdSize(std::span<const std::uint8_t> bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
  return size;
}

std::optional<std::string> UnpackZstdFile(const std::filesystem::path& from,
                                          const std::filesystem::path& to) {
  constexpr std::size_t kPiece = 1 << 20;
  constexpr std::uintmax_t kRoomForOthers = std::uintmax_t{1} << 26;
  std::ifstream in(from, std::ios::binary);
  std::ofstream out(to, std::ios::binary);
  const auto no_room = [&] {
    return InputError(from.string() + ": cannot be unpacked into " + to.parent_path().string() +
                      ": no room (TMPDIR names another folder)");
  };
  if (!in) throw InputError(from.string() + ": cannot be read");
  if (!out) throw no_room();
  ZstdUnpacker unpacker;
  Bytes packed(kPiece), unpacked(kPiece);
  bool whole = false;
  while (true) {
    in.read(reinterpret_cast<char*>(packed.data()), static_cast<std::streamsize>(kPiece));
    std::span<const std::uint8_t> left(packed.data(), static_cast<std::size_t>(in.gcount()));
    if (left.empty()) break;
    for (bool more = true; more;) {
      const Step step = unpacker.Do(left, unpacked);
      if (step.failed) return "the packed data is damaged";
      left = left.subspan(step.taken);
      whole = step.end;
      more = !left.empty() || step.given == unpacked.size();
      std::error_code error;
      const auto room = std::filesystem::space(to.parent_path(), error).available;
      if (error || room < kRoomForOthers) throw no_room();
      out.write(reinterpret_cast<const char*>(unpacked.data()),
                static_cast<std::streamsize>(step.given));
      if (!out) throw no_room();
    }
  }
  out.close();
  if (!out) throw no_room();
  return whole ? std::nullopt : std::optional<std::string>("the packed data ends early");
}

}  // namespace plumbline
