// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace plumbline {

// While it lives, nobody else holds the lock of the folder. The lock is an flock() on the file
// .plumbline-lock in the folder, which exists only meanwhile. A program that is killed leaves the
// file, but no lock.
class FolderLock {
 public:
  // Takes the lock without waiting. Throws InputError "<folder>: <held>" when somebody holds it,
  // and "cannot write <file>: <reason>" when the file cannot be made. On file systems without locks
  // nothing is locked, and nothing is thrown.
  FolderLock(const std::filesystem::path& folder, const std::string& held);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

  // Whether the folder still has the locked file; it has not when somebody removed the folder.
  bool IsInPlace() const;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace plumbline
