// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/atomic_file.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

std::ptrdiff_t FileCount(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(WriteFileAtomically, WritesAndReplaces) {
  const ScratchFolder folder;
  WriteFileAtomically(folder / "a.txt", "one");
  WriteFileAtomically(folder / "a.txt", std::string_view("t\0wo", 4));
  EXPECT_EQ(Contents(folder / "a.txt"), std::string("t\0wo", 4));
  EXPECT_EQ(FileCount(folder.path()), 1);
}

TEST(WriteFileAtomically, NamesTheFileAndTheReason) {
  const ScratchFolder folder;
  EXPECT_THAT(MessageOf([&] { WriteFileAtomically(folder / "none/a.txt", "x"); }),
              testing::AllOf(HasSubstr("cannot write "),
                             HasSubstr("none/a.txt: No such file or directory")));
  std::filesystem::create_directories(folder / "b.txt/full");
  EXPECT_THAT(MessageOf([&] { WriteFileAtomically(folder / "b.txt", "x"); }),
              HasSubstr("b.txt: Is a directory"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(MessageOf([&] { WriteFileAtomically(folder / "pipe", "x"); }),
              HasSubstr("pipe: expected a file or nothing there, found a pipe"));
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_THAT(MessageOf([] { CheckReplaceable("/dev/null"); }),
              HasSubstr("/dev/null: expected a file or nothing there, found a device"));
  EXPECT_EQ(FileCount(folder.path()), 2);
}

TEST(CheckWritable, ChangesNothing) {
  const ScratchFolder folder;
  folder.Write("a.txt", "old");
  CheckWritable(folder / "a.txt");
  CheckWritable(folder / "b.txt");
  EXPECT_EQ(Contents(folder / "a.txt"), "old");
  EXPECT_EQ(FileCount(folder.path()), 1);
  EXPECT_THAT(MessageOf([&] { CheckWritable(folder / "none/a.txt"); }),
              HasSubstr("none/a.txt: No such file or directory"));
  EXPECT_THAT(MessageOf([&] { CheckWritable(folder.path()); }), HasSubstr("Is a directory"));
  EXPECT_THAT(MessageOf([&] { CheckWritable(folder / std::string(300, 'x')); }),
              HasSubstr("File name too long"));
}

TEST(AtomicFile, LeavesTheOldFileWithoutCommit) {
  const ScratchFolder folder;
  folder.Write("a.png", "old");
  {
    const AtomicFile file(folder / "a.png");
    EXPECT_EQ(file.temporary_path().extension(), ".png");
    EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
    WriteFileAtomically(file.temporary_path(), "new");
  }
  EXPECT_EQ(Contents(folder / "a.png"), "old");
  EXPECT_EQ(FileCount(folder.path()), 1);
}

TEST(WriteFileAtomically, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const ScratchFolder folder;
  // The temporary name leads to a device that is always full.
  const AtomicFile probe(folder / "a.txt");
  std::filesystem::create_symlink("/dev/full", probe.temporary_path());
  EXPECT_THAT(MessageOf([&] { WriteFileAtomically(folder / "a.txt", std::string(100000, 'x')); }),
              HasSubstr("a.txt: No space left on device"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

TEST(WriteFilesAtomically, WritesAllOfThem) {
  const ScratchFolder folder;
  folder.Write("b.txt", "before");
  WriteFilesAtomically({{folder / "a.txt", "one"}, {folder / "b.txt", "two"}});
  EXPECT_EQ(Contents(folder / "a.txt"), "one");
  EXPECT_EQ(Contents(folder / "b.txt"), "two");
  EXPECT_EQ(FileCount(folder.path()), 2);
}

TEST(WriteFilesAtomically, WritesNoneWhereOneCannotBeWritten) {
  const ScratchFolder folder;
  folder.Write("a.txt", "before");
  EXPECT_THAT(MessageOf([&] {
                WriteFilesAtomically({{folder / "a.txt", "one"}, {folder / "none/b.txt", "two"}});
              }),
              HasSubstr("none/b.txt: No such file or directory"));
  EXPECT_EQ(Contents(folder / "a.txt"), "before");
  EXPECT_EQ(FileCount(folder.path()), 1);
}

TEST(AtomicFolder, AppearsWithAllItsFilesOrNotAtAll) {
  const ScratchFolder folder;
  for (const bool commit : {false, true}) {
    AtomicFolder made(folder / "a/b/");
    EXPECT_EQ(made.temporary_path().parent_path(), folder / "a");
    WriteFileAtomically(made.temporary_path() / "x.txt", "x");
    EXPECT_FALSE(std::filesystem::exists(folder / "a/b"));
    if (commit) made.Commit();
  }
  EXPECT_EQ(Contents(folder / "a/b/x.txt"), "x");
  EXPECT_EQ(FileCount(folder / "a"), 1);
}

TEST(AtomicFolder, TakesThePlaceOfAnEmptyFolderOnly) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "empty");
  {
    AtomicFolder made(folder / "empty");
    WriteFileAtomically(made.temporary_path() / "x.txt", "x");
    made.Commit();
  }
  EXPECT_EQ(Contents(folder / "empty/x.txt"), "x");
  EXPECT_THAT(MessageOf([&] { AtomicFolder again(folder / "empty"); }),
              HasSubstr("empty: expected a new or empty folder, found files in it"));
  EXPECT_THAT(MessageOf([&] { AtomicFolder again(folder / "empty/x.txt"); }),
              HasSubstr("x.txt: expected a new or empty folder, found a file of this name"));
  EXPECT_THAT(MessageOf([&] { AtomicFolder again(folder / "empty/x.txt/y"); }),
              HasSubstr("cannot make the folder"));
  EXPECT_EQ(FileCount(folder.path()), 1);
}

// Another folder of this name would leave whoever is in it in one that is gone.
TEST(AtomicFolder, FillsAFolderThatIsThere) {
  const ScratchFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const bool commit : {false, true}) {
    AtomicFolder made(".");
    MakeFolder(made.temporary_path() / "images");
    WriteFileAtomically(made.temporary_path() / "images/x.txt", "x");
    WriteFileAtomically(made.temporary_path() / "y.txt", "y");
    if (commit) made.Commit();
    EXPECT_EQ(std::filesystem::exists("y.txt"), commit);
  }
  std::filesystem::current_path(before);
  EXPECT_EQ(Contents(folder / "images/x.txt"), "x");
  EXPECT_EQ(FileCount(folder.path()), 2);
}

TEST(AtomicFolder, FillsAFolderOfHiddenFiles) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "out";
  MakeFolder(path / ".out.4711.tmp");  // of a program that was killed
  folder.Write("out/.notes", "mine");
  AtomicFolder made(path);
  WriteFileAtomically(made.temporary_path() / "x.txt", "x");
  made.Commit();
  EXPECT_EQ(Contents(path / "x.txt"), "x");
  EXPECT_EQ(Contents(path / ".notes"), "mine");
}

TEST(AtomicFolder, ReplacesNothingThatCameMeanwhile) {
  const ScratchFolder folder;
  AtomicFolder made(folder.path());
  WriteFileAtomically(made.temporary_path() / "x.txt", "x");
  folder.Write("x.txt", "mine");
  EXPECT_THAT(MessageOf([&] { made.Commit(); }), HasSubstr("Directory not empty"));
  EXPECT_EQ(Contents(folder / "x.txt"), "mine");
}

TEST(MakeFolder, MakesThoseAboveAndRefusesFiles) {
  const ScratchFolder folder;
  MakeFolder(folder / "a/b/c");
  MakeFolder(folder / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  folder.Write("file", "x");
  EXPECT_THAT(MessageOf([&] { MakeFolder(folder / "file"); }), HasSubstr("cannot make the folder"));
  EXPECT_THAT(MessageOf([&] { MakeFolder(folder / "file/a"); }),
              HasSubstr("cannot make the folder"));
}

}  // namespace
}  // namespace plumbline
