// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace plumbline {

// Exclusive lock of a folder during its lifetime: an flock() on the file .plumbline-lock in the
// folder, which exists only meanwhile. A killed program leaves the file, but no lock.
class FolderLock {
 public:
  // Takes the lock without waiting. Throws InputError "<folder>: <held>" if it is taken, for a file
  // of this name that is not empty (it would be lost), and "cannot write <file>: <reason>" if the
  // file cannot be made. On file systems without locks nothing is locked, and nothing is thrown.
  FolderLock(const std::filesystem::path& folder, const std::string& held);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace plumbline
