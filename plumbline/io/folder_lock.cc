// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/folder_lock.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plumbline {
namespace {

bool IsFileAt(int file, const std::filesystem::path& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// Throws InputError for a file of this name that no lock is, since the lock is removed at the end.
void CheckIsLock(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (!std::filesystem::exists(status)) return;
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0) {
    return;
  }
  throw InputError(path.string() +
                   ": expected nothing or the empty file that locks the folder, found another");
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& held)
    : path_(folder / ".plumbline-lock") {
  CheckIsLock(path_);
  // The former holder of the lock may remove the file after it was opened here; then it is opened
  // again.
  while (true) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw WriteError(path_, {errno, std::generic_category()});
    const bool locked = ::flock(file_, LOCK_EX | LOCK_NB) == 0;
    if (!locked && errno == EWOULDBLOCK) {
      ::close(file_);
      throw InputError(folder.string() + ": " + held);
    }
    if (!locked || IsFileAt(file_, path_)) return;
    ::close(file_);
  }
}

FolderLock::~FolderLock() {
  if (IsFileAt(file_, path_)) ::unlink(path_.c_str());  // not that of another folder of this name
  ::close(file_);
}

}  // namespace plumbline
