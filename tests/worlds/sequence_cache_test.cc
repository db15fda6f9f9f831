// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/sequence_cache.h"

#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

SynthOptions Tiny() {
  SynthOptions options;
  options.frames = 2;
  options.scale = 0.2;
  options.texel = 8;
  return options;
}

const std::string kWorld = "planar";  // prepared in a moment

std::set<std::string> NamesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(SequenceCache, RendersOnceAndThenGivesTheSameFolder) {
  const ScratchFolder folder;
  int calls = 0;
  const auto count = [&](int) { ++calls; };
  const fs::path first = CachedSequence(folder / "cache", kWorld, Tiny(), 1, count);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(first, folder / "cache" / SequenceKey(kWorld, Tiny()));
  EXPECT_EQ(OpenDataset(first)->size(), 2U);
  EXPECT_TRUE(fs::exists(first / "world.yaml"));
  EXPECT_TRUE(fs::exists(first / "lines.csv"));
  EXPECT_EQ(CachedSequence(folder / "cache", kWorld, Tiny(), 1, count), first);
  EXPECT_EQ(calls, 2);
  EXPECT_THAT(NamesIn(folder / "cache"), ElementsAre(first.filename().string()));
}

TEST(SequenceCache, OtherOptionsAreAnotherSequence) {
  SynthOptions other = Tiny();
  other.seed += 1;
  EXPECT_NE(SequenceKey(kWorld, Tiny()), SequenceKey(kWorld, other));
  EXPECT_EQ(SequenceKey(kWorld, Tiny()), SequenceKey(kWorld, Tiny()));
  EXPECT_THAT(SequenceKey(kWorld, Tiny()), StartsWith(kWorld + "-"));
}

TEST(SequenceCache, WhatIsNotWholeIsMadeAnew) {
  const ScratchFolder folder;
  const std::string key = SequenceKey(kWorld, Tiny());
  folder.Write(key + "/mav0/cam0/data.csv", "half of it");
  // No process has a number as high as this one.
  folder.Write("." + key + ".2000000000.tmp/world.yaml", "of a killed program");
  const fs::path path = CachedSequence(folder.path(), kWorld, Tiny(), 2);
  EXPECT_EQ(OpenDataset(path)->size(), 2U);
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre(key));
}

TEST(SequenceCache, WorkOfALivingProcessIsLeftAlone) {
  const ScratchFolder folder;
  const std::string key = SequenceKey(kWorld, Tiny());
  const std::string others = "." + key + "." + std::to_string(::getppid()) + ".tmp";
  folder.Write(others + "/mav0/cam0/data.csv", "half of it");
  CachedSequence(folder.path(), kWorld, Tiny(), 1);
  EXPECT_TRUE(fs::exists(folder / others / "mav0/cam0/data.csv"));
}

TEST(SequenceCache, AnEndInTheMiddleLeavesNothing) {
  const ScratchFolder folder;
  const auto stop = [](int) { throw std::runtime_error("stopped"); };
  EXPECT_THROW(CachedSequence(folder.path(), kWorld, Tiny(), 1, stop), std::runtime_error);
  EXPECT_THAT(NamesIn(folder.path()), IsEmpty());
}

TEST(SequenceCache, RefusesWhatItCannotMake) {
  const ScratchFolder folder;
  EXPECT_THAT(MessageOf([&] { CachedSequence(folder.path(), "attic", Tiny(), 1); }),
              HasSubstr(std::string("world: expected one of ") + Worlds().front().name));
  folder.Write("file", "text");
  EXPECT_THAT(MessageOf([&] { CachedSequence(folder / "file", kWorld, Tiny(), 1); }),
              HasSubstr("cannot make the folder"));
}

}  // namespace
}  // namespace plumbline
