// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace plumbline {

// While it lives, nobody else holds the lock of the folder: an flock() on the file .plumbline-lock
// in it, which is there only meanwhile. A program that is killed leaves the file, and no lock.
class FolderLock {
 public:
  // Does not wait. Throws InputError "<folder>: <held>" when somebody holds the lock, "cannot write
  // <file>: <reason>" when the file cannot be made. Where the file system knows no locks,
  // there is none, and nothing is thrown.
  FolderLock(const std::filesystem::path& folder, const std::string& held);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

  // Whether the folder still has the file that is locked: not when somebody removed the folder.
  bool IsInPlace() const;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace plumbline
