// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/sequence_cache.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/atomic_file.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"
#include "worlds/write_sequence.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporary = ".tmp";

// FNV-1a, 64 bits.
std::uint64_t Hash(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3ULL;
  }
  return hash;
}

// ".room-0123456789abcdef.4711.tmp" -> 4711, for the temporary folders of this sequence.
std::optional<pid_t> WriterOf(const std::string& name, const std::string& key) {
  const std::string begin = "." + key + ".";
  if (!name.starts_with(begin) || !name.ends_with(kTemporary)) return std::nullopt;
  pid_t writer = 0;
  const char* end = name.data() + name.size() - kTemporary.size();
  const auto parsed = std::from_chars(name.data() + begin.size(), end, writer);
  if (parsed.ec != std::errc() || parsed.ptr != end || writer <= 0) return std::nullopt;
  return writer;
}

// Removes the remains of killed renderings of this sequence.
void RemoveLeftovers(const fs::path& cache, const std::string& key) {
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(cache, ignored)) {
    const auto writer = WriterOf(entry.path().filename().string(), key);
    if (!writer) continue;
    const bool lives = ::kill(*writer, 0) == 0 || errno == EPERM;
    if (!lives || *writer == ::getpid()) leftovers.push_back(entry.path());
  }
  for (const fs::path& path : leftovers) fs::remove_all(path, ignored);
}

// A folder that is removed unless it has been moved away.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(fs::path path) : path_(std::move(path)) { MakeFolder(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool IsWhole(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "world.yaml", error);
}

}  // namespace

std::string SequenceKey(std::string_view world, const SynthOptions& options) {
  const WorldSource source = OpenWorld(world);  // throws for an unknown one
  SynthOptions copy = options;
  const std::string text =
      source.name + "\n" + OptionTable(copy).Dump() + source.text + PLUMBLINE_WORLDS_ID;
  return fmt::format("{}-{:016x}", source.name, Hash(text));
}

fs::path CachedSequence(const fs::path& cache_folder,
                        std::string_view world,
                        const SynthOptions& options,
                        int threads,
                        const std::function<void(int)>& progress) {
  const std::string key = SequenceKey(world, options);
  fs::path folder = cache_folder / key;
  if (IsWhole(folder)) return folder;
  MakeFolder(cache_folder);
  RemoveLeftovers(cache_folder, key);
  const TemporaryFolder temporary(cache_folder /
                                  fmt::format(".{}.{}{}", key, ::getpid(), kTemporary));
  const SyntheticSequence sequence(world, options, threads);
  WriteSequence(sequence, SequenceFormat::kEuroc, temporary.path(), threads, progress);
  std::error_code error;
  if (fs::exists(folder, error) && !IsWhole(folder)) fs::remove_all(folder, error);
  fs::rename(temporary.path(), folder, error);
  // Another process may have been faster, with the same result.
  if (error && !IsWhole(folder)) {
    throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
  }
  return folder;
}

}  // namespace plumbline
