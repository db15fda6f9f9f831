// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/atomic_file.h"

#include "plumbline/base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <list>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

namespace plumbline {
namespace {

[[noreturn]] void FailWrite(const std::filesystem::path& path, const std::error_code& why) {
  throw WriteError(path, why);
}

std::error_code LastError() { return {errno, std::generic_category()}; }

// Returns true if the contents of a file or folder are on the disk.
bool Synchronized(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool done = ::fsync(descriptor) == 0;
  const int error = errno;
  (void)::close(descriptor);
  errno = error;
  return done;
}

}  // namespace

void CheckReplaceable(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  if (std::filesystem::is_directory(status)) {
    FailWrite(path, std::make_error_code(std::errc::is_a_directory));
  }
  throw WriteError(path, "expected a file or nothing there, found " + KindOf(path));
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  CheckReplaceable(path_);
  temporary_ =
      path_.parent_path() /
      fmt::format(".{}.{}.tmp{}", path_.stem().string(), ::getpid(), path_.extension().string());
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

// Gives the file its name. The name is on the disk when the folder is; not all file systems can say
// when.
void AtomicFile::Commit(Durability durability) {
  const bool durable = durability == Durability::kPower;
  if (durable && !Synchronized(temporary_)) FailWrite(path_, LastError());
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) FailWrite(path_, error);
  committed_ = true;
  const std::filesystem::path folder = path_.parent_path();
  if (durable) (void)Synchronized(folder.empty() ? "." : folder);
}

void AtomicFileWriter::CloseFile::operator()(std::FILE* file) const { (void)std::fclose(file); }

AtomicFileWriter::AtomicFileWriter(const std::filesystem::path& path) : file_(path) {
  errno = 0;
  stream_.reset(std::fopen(file_.temporary_path().c_str(), "wb"));
  if (!stream_) FailWrite(path, LastError());
}

void AtomicFileWriter::Write(std::string_view bytes) {
  if (bytes.empty()) return;  // the view may have no pointer, which fwrite does not allow
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) {
    FailWrite(file_.path(), LastError());
  }
}

// A full disk may report the error of the last write only on closing.
void AtomicFileWriter::Close() {
  if (!stream_) return;
  if (std::fflush(stream_.get()) != 0) FailWrite(file_.path(), LastError());
  if (std::fclose(stream_.release()) != 0) FailWrite(file_.path(), LastError());
}

void AtomicFileWriter::Commit(Durability durability) {
  Close();
  file_.Commit(durability);
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view contents) {
  AtomicFileWriter file(path);
  file.Write(contents);
  file.Commit();
}

void WriteFilesAtomically(const std::vector<FileContents>& files) {
  std::list<AtomicFileWriter> writers;
  for (const FileContents& file : files) {
    writers.emplace_back(file.path).Write(file.contents);
    writers.back().Close();
  }
  for (AtomicFileWriter& writer : writers) writer.Commit();
}

void CheckWritable(const std::filesystem::path& path) { const AtomicFileWriter begun(path); }

namespace {

// Returns true if a folder has other files than hidden ones: those of the system, and what a
// program left that was killed while it filled the folder.
bool HoldsFiles(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::directory_iterator entries(folder, error);
  return std::any_of(begin(entries), end(entries), [](const auto& entry) {
    return entry.path().filename().string().front() != '.';
  });
}

}  // namespace

AtomicFolder::AtomicFolder(const std::filesystem::path& path) : path_(path.lexically_normal()) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/" becomes "out"
  std::error_code error;
  if (std::filesystem::exists(path_, error)) {
    const bool folder = std::filesystem::is_directory(path_, error);
    if (!folder || HoldsFiles(path_)) {
      throw InputError(path.string() + ": expected a new or empty folder, found " +
                       (folder ? "files in it" : "a file of this name"));
    }
    is_there_ = true;
  }
  if (!is_there_ && path_.has_parent_path()) MakeFolder(path_.parent_path());
  const std::filesystem::path above = is_there_ ? path_ : path_.parent_path();
  temporary_ = above / fmt::format(".{}.{}.tmp", path_.filename().string(), ::getpid());
  MakeFolder(temporary_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove_all(temporary_, ignored);
}

void AtomicFolder::Commit() {
  std::error_code error;
  if (is_there_) {
    MoveUp();
    std::filesystem::remove(temporary_, error);
  } else {
    std::filesystem::rename(temporary_, path_, error);
  }
  if (error) FailWrite(path_, error);
  committed_ = true;
}

void AtomicFolder::MoveUp() const {
  std::error_code error;
  if (HoldsFiles(path_)) FailWrite(path_, std::make_error_code(std::errc::directory_not_empty));
  std::vector<std::filesystem::path> names;
  for (const auto& entry : std::filesystem::directory_iterator(temporary_, error)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  for (const std::filesystem::path& name : names) {
    if (!error) std::filesystem::rename(temporary_ / name, path_ / name, error);
  }
  if (error) FailWrite(path_, error);
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
