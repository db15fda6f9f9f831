// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace plumbline {

// The error of a file that cannot be written: "cannot write <path>: <reason>".
class WriteError : public InputError {
 public:
  WriteError(std::filesystem::path path, std::string why)
      : InputError("cannot write " + path.string() + ": " + why),
        path_(std::move(path)),
        why_(std::move(why)) {}
  WriteError(std::filesystem::path path, const std::error_code& why)
      : WriteError(std::move(path), why.message()) {}
  const std::filesystem::path& path() const { return path_; }
  const std::string& why() const { return why_; }

 private:
  std::filesystem::path path_;
  std::string why_;
};

// Throws WriteError if no file may replace the object at `path`: a folder, a device, a pipe.
// Changes nothing.
void CheckReplaceable(const std::filesystem::path& path);

// Writes a whole file or nothing: the contents go to a temporary file in the same folder, which
// gets the final name once complete. A killed program leaves the old file, or none. Throws
// WriteError (folder missing or not writable, disk full) and then removes the temporary file.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view contents);

// Throws WriteError if WriteFileAtomically cannot begin to write: a check before hours of work.
// Makes the temporary file and removes it; the file at `path` does not change.
void CheckWritable(const std::filesystem::path& path);

// Moment at which a file gets its name: kProcess once the operating system has all bytes, kPower
// once they are on the disk, so that even a power failure leaves the old file or the new one. The
// latter costs some milliseconds.
enum class Durability { kProcess, kPower };

// An atomic write of files that other code writes by name: construct, let that code write
// temporary_path(), then Commit(). Without Commit the temporary file is removed.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);  // throws like CheckReplaceable
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  const std::filesystem::path& path() const { return path_; }
  // The temporary file, in the folder of the final file and with the same extension.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  void Commit(Durability durability = Durability::kProcess);  // throws WriteError

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

// A file to be written, with all its contents.
struct FileContents {
  std::filesystem::path path;
  std::string contents;
};

// Writes several files or none, each like WriteFileAtomically: all are complete under temporary
// names before the first gets its own. Throws WriteError.
void WriteFilesAtomically(const std::vector<FileContents>& files);

// A new folder that appears whole or not at all: construct, let files be written below
// temporary_path(), which is beside the final folder, then Commit(). Without Commit everything is
// removed. An existing folder is not replaced, since a shell may be in it or a disk be mounted
// there: then temporary_path() is in it, and Commit() moves the files up one after the other.
class AtomicFolder {
 public:
  // Makes the folders above it. Throws InputError if something other than a folder without files
  // (hidden ones stay) exists at `path`, or the temporary folder cannot be made.
  explicit AtomicFolder(const std::filesystem::path& path);
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  const std::filesystem::path& temporary_path() const { return temporary_; }
  // Throws InputError if the folder cannot get its name, or other files have appeared in it.
  void Commit();

 private:
  void MoveUp() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool is_there_ = false;  // true if the (empty) folder exists
  bool committed_ = false;
};

// A file written in pieces, by any number of calls of Write, which gets its name with Commit().
// Both functions throw WriteError.
class AtomicFileWriter {
 public:
  explicit AtomicFileWriter(const std::filesystem::path& path);
  void Write(std::string_view bytes);
  // Hands over all bytes to the operating system, so that only the name is missing. Nothing may be
  // written afterwards.
  void Close();
  void Commit(Durability durability = Durability::kProcess);

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const;
  };
  AtomicFile file_;
  std::unique_ptr<std::FILE, CloseFile> stream_;
};

// Makes a folder and those above it; throws InputError if that is impossible.
void MakeFolder(const std::filesystem::path& path);

}  // namespace plumbline
