// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_outputs.h"

#include "plumbline/report/run_manifest.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace command_outputs_test {

using testing::HasSubstr;

TEST(CommandOutputs, ReplaceFilesOfTheirKindOnly) {
  const ScratchFolder folder;
  const FileKind kind = {"a drawing", "<svg "};
  for (const char* contents : {"<svg >old</svg>", ""}) {
    const auto file = folder.Write("old.svg", contents);
    EXPECT_NO_THROW(CheckReplacesItsKind("--out", file, kind)) << contents;
  }
  EXPECT_NO_THROW(CheckReplacesItsKind("--out", folder / "new.svg", kind));
  for (const char* contents : {"notes", "<svg", " <svg >"}) {
    const auto file = folder.Write("other.svg", contents);
    EXPECT_EQ(MessageOf([&] { CheckReplacesItsKind("--out", file, kind); }),
              "--out " + file.string() +
                  ": expected a drawing to replace, or a new file, found another file");
    EXPECT_EQ(Contents(file), contents);
  }
}

TEST(CommandOutputs, KeepTheResultsOfARun) {
  const ScratchFolder folder;
  const auto trajectory = folder.Write("trajectory.txt", "");
  EXPECT_NO_THROW(CheckKeepsResults("--json", trajectory));  // no run says that it is its
  WriteRunManifest(folder.path(), {true, {"trajectory.txt"}});
  EXPECT_THAT(MessageOf([&] { CheckKeepsResults("--json", trajectory); }),
              HasSubstr("--json " + trajectory.string() + ": expected another name, found one"));
  EXPECT_THAT(MessageOf([&] { CheckKeepsResults("--json", folder / ".plumbline-run"); }),
              HasSubstr("expected another name"));
  EXPECT_NO_THROW(CheckKeepsResults("--json", folder / "info.json"));
}

}  // namespace command_outputs_test
}  // namespace plumbline
