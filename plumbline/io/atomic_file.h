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

// Throws WriteError where no file may take the place of what is at `path`: a folder, a device, a
// pipe. Changes nothing.
void CheckReplaceable(const std::filesystem::path& path);

// Writes a whole file or nothing: the contents go to a temporary file in the same folder, which
// takes the final name once complete. A killed program leaves the old file, or none, in place.
// Throws WriteError (folder missing or not writable, disk full); the temporary file is removed
// then.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view contents);

// Throws WriteError where WriteFileAtomically cannot begin to write: asked before work that takes
// hours, it saves its result. Makes the temporary file and removes it; what is at `path` stays.
void CheckWritable(const std::filesystem::path& path);

// Whether a file must be on the disk, and not only with the operating system, before it takes its
// name. With kPower even a power failure leaves the old file or the new one. Costs some
// milliseconds.
enum class Durability { kProcess, kPower };

// An atomic write of files that other code writes by name: construct, let that code write
// temporary_path(), then Commit(). Without Commit the temporary file is removed.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);  // throws as CheckReplaceable does
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

// A file to be written, and all that it is to hold.
struct FileContents {
  std::filesystem::path path;
  std::string contents;
};

// Writes several files or none, as WriteFileAtomically writes one: all are complete under temporary
// names before the first takes its own. Where one cannot take its name (another user's file in a
// shared folder), those before it get back what was there. Throws WriteError.
void WriteFilesAtomically(const std::vector<FileContents>& files);

// A folder that appears whole or not at all, where it is new: construct, let files be written below
// temporary_path(), which is beside the final place, then Commit(). Without Commit everything is
// removed.
// A folder that is there stays the same one, since a shell may be in it or a disk be mounted
// there: temporary_path() is in it then, and Commit() moves the files up one after the other.
class AtomicFolder {
 public:
  // Makes the folders above it. Throws InputError where something other than an empty folder is at
  // `path` already, or the temporary folder cannot be made.
  explicit AtomicFolder(const std::filesystem::path& path);
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  const std::filesystem::path& temporary_path() const { return temporary_; }
  // Throws InputError where the folder cannot take its name, or got other files meanwhile.
  void Commit();

 private:
  void MoveUp() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool is_there_ = false;  // empty
  bool committed_ = false;
};

// A file that is written piece by piece, in any number of calls of Write, and takes its name whole
// with Commit(). Both functions throw WriteError.
class AtomicFileWriter {
 public:
  explicit AtomicFileWriter(const std::filesystem::path& path);
  void Write(std::string_view bytes);
  // Hands over all bytes to the operating system, after which only the name is missing. Nothing is
  // written after that.
  void Close();
  void Commit(Durability durability = Durability::kProcess);

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const;
  };
  AtomicFile file_;
  std::unique_ptr<std::FILE, CloseFile> stream_;
};

// Makes a folder and those above it; throws InputError when that is impossible.
void MakeFolder(const std::filesystem::path& path);

}  // namespace plumbline
