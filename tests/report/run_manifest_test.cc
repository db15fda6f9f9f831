// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_manifest.h"

#include "tests/io/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(RunManifest, ComesBackAsItWasWritten) {
  const ScratchFolder folder;
  EXPECT_FALSE(ReadRunManifest(folder.path()));
  WriteRunManifest(folder.path(), {true, {"map.plb", "trajectory.txt"}});
  const auto manifest = ReadRunManifest(folder.path());
  ASSERT_TRUE(manifest);
  EXPECT_TRUE(manifest->complete);
  EXPECT_THAT(manifest->files, ElementsAre("map.plb", "trajectory.txt"));
  EXPECT_TRUE(manifest->Lists("map.plb"));
  EXPECT_FALSE(manifest->Lists("map.ply"));
}

TEST(RunManifest, NamesNothingThatNoRunWrites) {
  const ScratchFolder folder;
  folder.Write(RunManifest::kFile,
               R"({"plumbline_run": 1, "complete": true,
                   "files": ["../other/trajectory.txt", "/etc/passwd", "notes.txt", 7, ".",
                             "overlay_1.png", "overlay_000001.png"]})");
  EXPECT_THAT(ReadRunManifest(folder.path())->files, ElementsAre("overlay_000001.png"));
}

TEST(RunManifest, OtherFilesOfThatNameAreRefused) {
  for (const char* text : {"",
                           "notes",
                           "[]",
                           "{}",
                           R"({"plumbline_run": 2})",
                           R"({"plumbline_run": 1, "complete": 1, "files": []})",
                           R"({"plumbline_run": 1, "complete": true, "files": "map.plb"})"}) {
    const ScratchFolder folder;
    folder.Write(RunManifest::kFile, text);
    EXPECT_THAT(MessageOf([&] { ReadRunManifest(folder.path()); }),
                HasSubstr("expected the list of files that a run writes"))
        << text;
  }
}

}  // namespace
}  // namespace plumbline
