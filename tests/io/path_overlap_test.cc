// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/path_overlap.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

TEST(PathOverlap, SeesThroughSpellingAndLinks) {
  const ScratchFolder folder;
  fs::create_directories(folder / "data/images");
  fs::create_directory_symlink(folder / "data", folder / "link");
  for (const char* same : {"data", "data/", "data/.", "data/images/..", "link", "link/"}) {
    EXPECT_TRUE(IsSamePath(folder / same, folder / "data")) << same;
    EXPECT_TRUE(IsWithin(folder / same, folder / "data")) << same;
    EXPECT_TRUE(IsWithin(folder / same / "images", folder / "data")) << same;
    EXPECT_TRUE(IsWithin(folder / same, folder.path())) << same;
    EXPECT_FALSE(IsWithin(folder / same, folder / "data/images")) << same;
  }
}

TEST(PathOverlap, TellsNeighboursApart) {
  const ScratchFolder folder;
  fs::create_directories(folder / "data");
  for (const char* other : {"dat", "data2", "data 2", "other/data"}) {
    EXPECT_FALSE(IsSamePath(folder / other, folder / "data")) << other;
    EXPECT_FALSE(IsWithin(folder / other, folder / "data")) << other;
    EXPECT_FALSE(IsWithin(folder / "data", folder / other)) << other;
  }
}

TEST(PathOverlap, KnowsWhereThingsWillBe) {
  const ScratchFolder folder;
  EXPECT_TRUE(IsSamePath(folder / "a/b/../c", folder / "a/c"));
  EXPECT_TRUE(IsWithin(folder / "a/b/c", folder / "a"));
  EXPECT_TRUE(IsWithin("below", "."));
  EXPECT_FALSE(IsWithin(".", "below"));
}

TEST(PathOverlap, AFileIsWithinItself) {
  const ScratchFolder folder;
  const fs::path file = folder.Write("a/file.txt", "text");
  fs::create_hard_link(file, folder / "hard.txt");
  EXPECT_TRUE(IsSamePath(folder / "hard.txt", file));
  EXPECT_TRUE(IsWithin(file, file));
  EXPECT_TRUE(IsWithin(file, folder / "a"));
  EXPECT_FALSE(IsWithin(folder / "a", file));
}

}  // namespace
}  // namespace plumbline
