// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace plumbline {

// Writes a whole file or nothing: the contents go to a temporary file in the same folder, which
// takes the final name once complete. A killed program leaves the old file, or none, in place.
// Throws InputError "cannot write <path>: <reason>" (folder missing or not writable, disk full);
// the temporary file is removed then.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view contents);

// The same for files that other code writes by name: construct, let it write temporary_path(),
// then Commit(). Without Commit the temporary file is removed.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  // In the folder of the final file, with the same extension.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  void Commit();  // throws InputError as above

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

// A folder that appears whole or not at all: construct, let files be written below
// temporary_path(), which is beside the final place, then Commit(). Without Commit all of it is
// removed.
class AtomicFolder {
 public:
  // Makes the folders above it. Throws InputError where something is at `path` already, an empty
  // folder excepted, or the temporary folder cannot be made.
  explicit AtomicFolder(std::filesystem::path path);
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  const std::filesystem::path& temporary_path() const { return temporary_; }
  void Commit();  // throws InputError where the folder cannot take its name

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

// Makes a folder and those above it; InputError when that is impossible.
void MakeFolder(const std::filesystem::path& path);

}  // namespace plumbline
