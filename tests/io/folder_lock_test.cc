// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/folder_lock.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(FolderLock, IsHeldByOneAtATime) {
  const ScratchFolder folder;
  std::optional<FolderLock> first;
  first.emplace(folder.path(), "in use");
  EXPECT_EQ(MessageOf([&] { const FolderLock second(folder.path(), "in use"); }),
            folder.path().string() + ": in use");
  first.reset();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  const FolderLock again(folder.path(), "in use");
  EXPECT_TRUE(std::filesystem::exists(folder / ".plumbline-lock"));
}

TEST(FolderLock, TakesOverFromAProgramThatWasKilled) {
  const ScratchFolder folder;
  folder.Write(".plumbline-lock", "");
  const FolderLock lock(folder.path(), "in use");
  EXPECT_THAT(MessageOf([&] { const FolderLock second(folder.path(), "in use"); }),
              testing::EndsWith(": in use"));
}

TEST(FolderLock, LeavesTheLockOfANewFolderOfThisName) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "a");
  std::optional<FolderLock> lock;
  lock.emplace(folder / "a", "in use");
  std::filesystem::remove_all(folder / "a");
  std::filesystem::create_directory(folder / "a");
  const FolderLock other(folder / "a", "in use");
  lock.reset();
  EXPECT_TRUE(std::filesystem::exists(folder / "a/.plumbline-lock"));
}

TEST(FolderLock, TakesNoFileOfTheUsersForALock) {
  const ScratchFolder folder;
  folder.Write(".plumbline-lock", "my notes");
  EXPECT_THAT(MessageOf([&] { const FolderLock lock(folder.path(), "in use"); }),
              testing::HasSubstr("expected nothing or the empty file that locks the folder"));
  EXPECT_EQ(std::filesystem::file_size(folder / ".plumbline-lock"), 8U);
  std::filesystem::remove(folder / ".plumbline-lock");
  std::filesystem::create_symlink(folder / "elsewhere", folder / ".plumbline-lock");
  EXPECT_THAT(MessageOf([&] { const FolderLock lock(folder.path(), "in use"); }),
              testing::HasSubstr("found another"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / ".plumbline-lock"));
}

TEST(FolderLock, SaysWhereItCannotBeMade) {
  const ScratchFolder folder;
  EXPECT_THAT(MessageOf([&] { const FolderLock lock(folder / "none", "in use"); }),
              testing::StartsWith("cannot write " + (folder / "none").string()));
}

}  // namespace
}  // namespace plumbline
