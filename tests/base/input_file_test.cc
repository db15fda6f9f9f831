// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/input_file.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plumbline {
namespace {

std::string ErrorOf(const std::filesystem::path& path, std::uint64_t largest = kLargestTable) {
  return MessageOf([&] { ReadInputFile(path, largest); });
}

TEST(ReadInputFile, GivesAllBytes) {
  const ScratchFolder folder;
  std::string contents = std::string("a\0\r\n", 4) + std::string(200'000, 'x');
  EXPECT_EQ(ReadInputFile(folder.Write("file", contents)), contents);
  EXPECT_EQ(ReadInputFile(folder.Write("empty", "")), "");
  std::filesystem::create_symlink(folder / "file", folder / "link");
  EXPECT_EQ(ReadInputFile(folder / "link"), contents);
}

TEST(ReadInputFile, RefusesWhatIsNoFile) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder / "none", folder / "dangling");
  EXPECT_EQ(ErrorOf(folder / "none"), (folder / "none").string() + ": no such file");
  EXPECT_EQ(ErrorOf(folder / "dangling"), (folder / "dangling").string() + ": no such file");
  EXPECT_EQ(ErrorOf(folder.path()), folder.path().string() + ": expected a file, found a folder");
  // Nobody writes into the pipe: opening it would never come back.
  EXPECT_EQ(ErrorOf(folder / "pipe"),
            (folder / "pipe").string() + ": expected a file, found a pipe");
  EXPECT_EQ(ErrorOf("/dev/zero"), "/dev/zero: expected a file, found a device");
  const std::filesystem::path file = folder.Write("file", "");
  EXPECT_EQ(ErrorOf(file / "below"), (file / "below").string() + ": no such file");
  std::filesystem::create_symlink("round", folder / "round");
  EXPECT_EQ(ErrorOf(folder / "round"),
            (folder / "round").string() + ": cannot be read: Too many levels of symbolic links");
}

TEST(ReadInputFile, RefusesFilesThatAreTooLarge) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.Write("file", std::string(1000, 'x'));
  EXPECT_EQ(ReadInputFile(file, 1000).size(), 1000U);
  EXPECT_EQ(ErrorOf(file, 999),
            file.string() + ": expected a file of at most 999 bytes, found a larger one");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 36);  // takes no place on the disk
  EXPECT_EQ(ErrorOf(file),
            file.string() + ": expected a file of at most 1024 MB, found a larger one");
}

TEST(ReadInputFile, SaysWhyAFileCannotBeRead) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read anything";
  const ScratchFolder folder;
  const std::filesystem::path file = folder.Write("file", "x");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_EQ(ErrorOf(file), file.string() + ": cannot be read: Permission denied");
}

TEST(ReadFileIfThere, GivesNothingWhereThereIsNoFile) {
  const ScratchFolder folder;
  EXPECT_EQ(ReadFileIfThere(folder / "none"), std::nullopt);
  EXPECT_EQ(ReadFileIfThere(folder.path()), std::nullopt);
  EXPECT_EQ(ReadFileIfThere(folder.Write("some", "text\n")), "text\n");
}

TEST(FileBeginsWith, ReadsTheBeginningOfFilesOnly) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::filesystem::path file = folder.Write("file", "a,b\n1,2\n");
  EXPECT_TRUE(FileBeginsWith(file, "a,b\n"));
  EXPECT_TRUE(FileBeginsWith(file, "a,b\n1,2\n"));
  EXPECT_TRUE(FileBeginsWith(file, ""));
  EXPECT_FALSE(FileBeginsWith(file, "a,c\n"));
  EXPECT_FALSE(FileBeginsWith(file, "a,b\n1,2\n3"));
  EXPECT_FALSE(FileBeginsWith(folder / "none", "a"));
  EXPECT_FALSE(FileBeginsWith(folder.path(), ""));
  EXPECT_FALSE(FileBeginsWith(folder / "pipe", "a"));
  std::filesystem::resize_file(file, std::uintmax_t{1} << 36);  // takes no place on the disk
  EXPECT_TRUE(FileBeginsWith(file, "a,b\n"));
}

TEST(IsTaken, IsAPathWhereThereIsSomething) {
  const ScratchFolder folder;
  EXPECT_TRUE(IsTaken(folder.path()));
  EXPECT_FALSE(IsTaken(folder / "nothing"));
  std::filesystem::create_symlink(folder / "nowhere", folder / "link");
  EXPECT_TRUE(IsTaken(folder / "link"));
}

TEST(RefuseForeignFiles, NamesTheFirstOfTheNamesThatAreTaken) {
  const ScratchFolder folder;
  const auto is_foreign = [](const std::string& name) { return name != "notes.txt"; };
  const auto message = [&] {
    return MessageOf([&] { RefuseForeignFiles(folder / "out", "run", is_foreign); });
  };
  EXPECT_NO_THROW(RefuseForeignFiles(folder / "none", "run", is_foreign));
  folder.Write("out/notes.txt", "mine\n");
  EXPECT_NO_THROW(RefuseForeignFiles(folder / "out", "run", is_foreign));
  folder.Write("out/b.csv", "mine\n");
  const auto refused = [&](const char* name) {
    return (folder / "out" / name).string() +
           ": not written by an earlier run, and this one would replace it; move it away or choose "
           "another --out";
  };
  EXPECT_EQ(message(), refused("b.csv"));
  std::filesystem::create_symlink(folder / "nowhere", folder / "out/a.csv");
  EXPECT_EQ(message(), refused("a.csv"));
}

}  // namespace
}  // namespace plumbline
