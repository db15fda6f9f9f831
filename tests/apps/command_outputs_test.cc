// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_outputs.h"

#include "plumbline/io/geometry_files.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/run_folder.h"

#include "apps/exported_map.h"
#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

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

TEST(CommandOutputs, AreNotStandardOutput) {
  EXPECT_EQ(MessageOf([] { CheckOutput("--out", "-", {}, MapFileKind()); }),
            "--out: expected a file or folder, found -");
}

TEST(CommandOutputs, KeepTheResultsOfARun) {
  const ScratchFolder folder;
  const auto trajectory = folder.Write("trajectory.txt", "");
  EXPECT_NO_THROW(CheckKeepsResults("--json", trajectory));  // no run says that it is its
  WriteRunList(folder.path(), {"trajectory.txt"});
  EXPECT_THAT(MessageOf([&] { CheckKeepsResults("--json", trajectory); }),
              HasSubstr("--json " + trajectory.string() + ": expected another name, found one"));
  EXPECT_THAT(MessageOf([&] { CheckKeepsResults("--json", folder / ".plumbline-run"); }),
              HasSubstr("expected another name"));
  EXPECT_NO_THROW(CheckKeepsResults("--json", folder / "info.json"));
}

// What a user may have at a place that is named by a slip.
std::map<std::string, std::string> Victims() {
  return {{"camera.yaml", "model: pinhole\nsize: [160, 120]\n"},
          {"README.md", "# My data\n"},
          {"summary.json", "{\n  \"program\": \"plumbline\"\n}\n"},
          {"groundtruth.txt", "# timestamp tx ty tz qx qy qz qw\n1.5 0 0 0 0 0 0 1\n"},
          {"image.png", "\x89PNG\r\n\x1a\n"}};
}

// Every file that the program or Python writes to a place that users name, and what no file of its
// kind takes the place of.
TEST(CommandOutputs, OfNoKindTakeThePlaceOfAUsersFiles) {
  std::vector<FileKind> writers = {MapFileKind(), TrajectoryFileKind()};
  for (const auto& [form, name] : EnumNames(std::type_identity<ExportFormat>{})) {
    if (form != ExportFormat::kColmap && form != ExportFormat::kNerfstudio) {
      writers.push_back(KindOfExport(form));
    }
  }
  for (const FileKind& writer : writers) {
    const ScratchFolder folder;
    for (const auto& [name, contents] : Victims()) {
      const auto file = folder.Write(name, contents);
      EXPECT_THAT(MessageOf([&] { CheckOutput("path", file, {}, writer); }),
                  HasSubstr("path " + file.string() + ": expected " + std::string(writer.name) +
                            " to replace, or a new file, found another file"));
      EXPECT_EQ(Contents(file), contents);
    }
    EXPECT_NO_THROW(CheckOutput("path", folder / "new", {}, writer));
    // A result of a run, even of the same kind.
    const auto result = folder.Write("trajectory.txt", std::string(writer.begin));
    WriteRunList(folder.path(), {"trajectory.txt"});
    EXPECT_THAT(MessageOf([&] { CheckOutput("path", result, {}, writer); }),
                HasSubstr("expected another name"));
    const std::filesystem::path input = folder / "camera.yaml";
    EXPECT_THAT(MessageOf([&] {
                  CheckOutput("path", input, {&input, 1}, writer);
                }),
                HasSubstr("expected another file than " + input.string() + ", which is read"));
  }
}

TEST(CommandOutputs, TakeThePlaceOfTheirOwn) {
  const ScratchFolder folder;
  const Trajectory trajectory = {{1, {{1, 0, 0, 0}, {-1, 2, 3}}}};
  WriteTum(folder / "t.txt", trajectory);
  EXPECT_NO_THROW(CheckOutput("path", folder / "t.txt", {}, TrajectoryFileKind()));
  SaveMap(folder / "m.plb", {}, Eigen::Quaterniond::Identity(), Map(MapId{0}));
  EXPECT_NO_THROW(CheckOutput("path", folder / "m.plb", {}, MapFileKind()));
  EXPECT_NE(MessageOf([&] { CheckOutput("path", folder / "m.plb", {}, TrajectoryFileKind()); }),
            "no error");
  WritePly(folder / "p.ply", {}, {});
  WriteObjLines(folder / "p.obj", {});
  WriteDxfLines(folder / "p.dxf", {});
  EXPECT_NO_THROW(CheckOutput("path", folder / "p.ply", {}, KindOfExport(ExportFormat::kPly)));
  EXPECT_NO_THROW(CheckOutput("path", folder / "p.obj", {}, KindOfExport(ExportFormat::kObj)));
  EXPECT_NO_THROW(CheckOutput("path", folder / "p.dxf", {}, KindOfExport(ExportFormat::kDxf)));
}

}  // namespace command_outputs_test
}  // namespace plumbline
