// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

namespace plumbline {
namespace {

[[noreturn]] void FailWrite(const std::filesystem::path& path, const std::error_code& why) {
  throw WriteError(path, why);
}

struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

// The last write errors of a full disk may come as late as on closing.
void WriteAll(const std::filesystem::path& temporary,
              const std::filesystem::path& path,
              std::string_view contents) {
  errno = 0;
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
  if (!file) FailWrite(path, {errno, std::generic_category()});
  const bool written =
      std::fwrite(contents.data(), 1, contents.size(), file.get()) == contents.size() &&
      std::fflush(file.get()) == 0;
  if (!written) FailWrite(path, {errno, std::generic_category()});
  if (std::fclose(file.release()) != 0) FailWrite(path, {errno, std::generic_category()});
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  temporary_ =
      path_.parent_path() /
      fmt::format(".{}.{}.tmp{}", path_.stem().string(), ::getpid(), path_.extension().string());
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::Commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) FailWrite(path_, error);
  committed_ = true;
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view contents) {
  AtomicFile file(path);
  WriteAll(file.temporary_path(), path, contents);
  file.Commit();
}

AtomicFolder::AtomicFolder(std::filesystem::path path) : path_(path.lexically_normal()) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/" is "out"
  std::error_code error;
  if (std::filesystem::exists(path_, error)) {
    const bool folder = std::filesystem::is_directory(path_, error);
    if (!folder || !std::filesystem::is_empty(path_, error)) {
      throw InputError(path.string() + ": expected a new or empty folder, found " +
                       (folder ? "files in it" : "a file of this name"));
    }
  }
  if (path_.has_parent_path()) MakeFolder(path_.parent_path());
  temporary_ =
      path_.parent_path() / fmt::format(".{}.{}.tmp", path_.filename().string(), ::getpid());
  MakeFolder(temporary_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove_all(temporary_, ignored);
}

void AtomicFolder::Commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) FailWrite(path_, error);
  committed_ = true;
}

void MakeFolder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError("cannot make the folder " + path.string() + ": " + error.message());
  if (!std::filesystem::is_directory(path, error)) {
    throw InputError("cannot make the folder " + path.string() + ": a file of this name exists");
  }
}

}  // namespace plumbline
