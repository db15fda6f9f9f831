// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/input_file.h"

#include "plumbline/base/error.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

std::string Size(std::uint64_t bytes) {
  constexpr std::uint64_t kMega = std::uint64_t{1} << 20;
  return bytes < kMega ? fmt::format("{} bytes", bytes) : fmt::format("{} MB", bytes / kMega);
}

}  // namespace

bool IsTaken(const fs::path& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

std::string KindOf(const fs::path& path) {
  std::error_code error;
  switch (fs::status(path, error).type()) {
    case fs::file_type::regular:
      return "a file";
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "nothing";
  }
}

void CheckExists(const fs::path& path, std::string_view what) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw InputError(fmt::format("{}: no such {}", path.string(), what));
  }
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
}

std::string ReadInputFile(const fs::path& path, std::uint64_t largest) {
  CheckExists(path);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw InputError(path.string() + ": expected a file, found " + KindOf(path));
  }
  // Some file systems tell no sizes, so that the bytes that were read are counted.
  const auto too_large = [&] {
    throw InputError(path.string() + ": expected a file of at most " + Size(largest) +
                     ", found a larger one");
  };
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > largest) too_large();
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path.string() + ": cannot be read: " + std::generic_category().message(errno));
  }
  std::string contents;
  if (!error) contents.reserve(static_cast<std::size_t>(size));
  std::string block(std::size_t{1} << 16, '\0');
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    contents.append(block, 0, static_cast<std::size_t>(file.gcount()));
    if (contents.size() > largest) too_large();
  }
  if (file.bad()) throw InputError(path.string() + ": cannot be read");
  return contents;
}

std::optional<std::string> ReadFileIfThere(const fs::path& path) {
  try {
    return ReadInputFile(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool FileBeginsWith(const fs::path& path, std::string_view text) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string start(text.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file && start == text;
}

void RefuseForeignFiles(const fs::path& folder,
                        std::string_view writer,
                        const std::function<bool(const std::string& name)>& is_foreign) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  std::optional<std::string> first;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (is_foreign(name) && (!first || name < *first)) first = name;
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  if (!first) return;
  throw InputError(fmt::format(
      "{}: not written by an earlier {}, and this one would replace it; move it away or "
      "choose another --out",
      (folder / *first).string(),
      writer));
}

}  // namespace plumbline
