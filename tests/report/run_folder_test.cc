// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_folder.h"

#include "plumbline/io/atomic_file.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <new>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;
using testing::StartsWith;

RunFile Text(const std::string& name, const std::string& text) {
  return {name, [text](const fs::path& path) { WriteFileAtomically(path, text); }};
}

RunFile Failing(const std::string& name, std::errc why) {
  return {name, [why](const fs::path& path) { throw WriteError(path, std::make_error_code(why)); }};
}

std::set<std::string> FilesOf(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

// A run that writes these files, each with the same text.
void WriteRun(const fs::path& out, const std::vector<std::string>& names, const std::string& text) {
  RunFolder folder(out);
  folder.Keep();
  for (const std::string& name : names) folder.Write(Text(name, text));
  folder.Commit();
}

TEST(RunList, ComesBackAsItWasWritten) {
  const ScratchFolder scratch;
  EXPECT_FALSE(ReadRunList(scratch.path()));
  WriteRunList(scratch.path(), {"trajectory.txt", "map.plb"});
  EXPECT_THAT(ReadRunList(scratch.path()), Optional(ElementsAre("map.plb", "trajectory.txt")));
}

TEST(RunList, NamesNothingThatNoRunWrites) {
  const ScratchFolder scratch;
  scratch.Write(kRunList,
                R"({"plumbline_run": 1, "complete": true,
                   "files": ["../other/trajectory.txt", "/etc/passwd", "notes.txt", 7, ".",
                             "overlay_1.png", "overlay_000001.png"]})");
  EXPECT_THAT(ReadRunList(scratch.path()), Optional(ElementsAre("overlay_000001.png")));
}

TEST(RunList, OtherFilesOfThatNameAreRefused) {
  for (const char* text : {"",
                           "notes",
                           "[]",
                           "{}",
                           R"({"plumbline_run": 2})",
                           R"({"plumbline_run": 1, "files": "map.plb"})"}) {
    const ScratchFolder scratch;
    scratch.Write(kRunList, text);
    EXPECT_THAT(MessageOf([&] { ReadRunList(scratch.path()); }),
                HasSubstr("expected the list of files that a run writes"))
        << text;
  }
}

TEST(RunFolder, ReplacesTheFilesOfTheEarlierRunAtTheEnd) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "deep/out";
  WriteRun(out, {"trajectory.txt", "trajectory_map1.txt"}, "old");
  scratch.Write("deep/out/notes.txt", "mine");
  {
    RunFolder folder(out);
    folder.Keep();
    folder.Write(Text("trajectory.txt", "new"));
    folder.Write(Text("map.plb", "new"));
    EXPECT_EQ(Contents(out / "trajectory.txt"), "old");
    EXPECT_EQ(Contents(out / "trajectory_map1.txt"), "old");
    folder.Commit();
  }
  EXPECT_EQ(FilesOf(out),
            (std::set<std::string>{".plumbline-run", "map.plb", "notes.txt", "trajectory.txt"}));
  EXPECT_EQ(Contents(out / "trajectory.txt"), "new");
  EXPECT_EQ(Contents(out / "notes.txt"), "mine");
}

TEST(RunFolder, LeavesEverythingAsItWasWhenNothingIsKept) {
  const ScratchFolder scratch;
  WriteRun(scratch / "out", {"trajectory.txt"}, "old");
  const auto before = FilesOf(scratch / "out");
  { RunFolder(scratch / "out").Write(Text("trajectory.txt", "new")); }
  EXPECT_EQ(FilesOf(scratch / "out"), before);
  EXPECT_EQ(Contents(scratch / "out/trajectory.txt"), "old");
  { RunFolder(scratch / "fresh/out").Write(Text("trajectory.txt", "new")); }
  EXPECT_FALSE(fs::exists(scratch / "fresh"));
}

TEST(RunFolder, KnowsTheEarlierRun) {
  const ScratchFolder scratch;
  EXPECT_FALSE(RunFolder(scratch / "out").Earlier());
  WriteRun(scratch / "out", {"trajectory.txt", "summary.json"}, "1 2\n3 4\n");
  EXPECT_EQ(RunFolder(scratch / "out").Earlier()->poses, 2U);
  EXPECT_EQ(RunFolder(scratch / "out").Earlier()->data, "");
  scratch.Write("out/summary.json", R"({"data": "walk"})");
  EXPECT_EQ(RunFolder(scratch / "out").Earlier()->data, "walk");
  scratch.Write("out/trajectory.txt", "");
  EXPECT_FALSE(RunFolder(scratch / "out").Earlier());
}

TEST(RunFolder, RefusesFilesThatNoRunWrote) {
  const ScratchFolder scratch;
  WriteRun(scratch / "out", {"trajectory.txt"}, "old");
  for (const char* name : {"keyframes.txt", "overlay_000003.png", "trajectory_map2.txt"}) {
    for (const std::string out : {"out", "plain"}) {
      const fs::path mine = scratch.Write(out + "/" + name, "mine");
      const auto before = FilesOf(scratch / out);
      const std::string message = MessageOf([&] { const RunFolder folder(scratch / out); });
      EXPECT_THAT(message, StartsWith(mine.string() + ": not written by an earlier run"));
      EXPECT_THAT(message, HasSubstr("choose another --out"));
      EXPECT_EQ(FilesOf(scratch / out), before);
      EXPECT_EQ(Contents(mine), "mine");
      fs::remove(mine);
    }
  }
  for (const char* other : {"overlay_0.png", "my_trajectory.txt", "map.jpg"}) {
    scratch.Write(std::string("out/") + other, "mine");
  }
  WriteRun(scratch / "out", {"trajectory.txt"}, "new");
  EXPECT_EQ(Contents(scratch / "out/overlay_0.png"), "mine");
}

TEST(CheckNoResult, RefusesThePlacesOfResults) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  scratch.Write("out/notes.txt", "mine");
  for (const char* name : {"map.plb", "trajectory_map3.txt", "../out/map.plb", ".plumbline-run"}) {
    EXPECT_THAT(MessageOf([&] { CheckNoResult("--record", out / name, out); }),
                HasSubstr("expected another name, found one that the results in "))
        << name;
  }
  EXPECT_THAT(MessageOf([&] { CheckNoResult("--record", out / ".part/run.mcap", out); }),
              StartsWith("--record "));
  for (const fs::path& other : {out / "run.plbrun", scratch / "map.plb", out / "old/map.plb"}) {
    CheckNoResult("--record", other, out);
  }
}

TEST(RunFolder, RefusesAFolderOfTheUserByTheNameOfAFile) {
  const ScratchFolder scratch;
  WriteRun(scratch / "out", {"map.plb"}, "old");
  fs::remove(scratch / "out/map.plb");
  scratch.Write("out/map.plb/thing", "mine");
  EXPECT_THAT(MessageOf([&] { const RunFolder folder(scratch / "out"); }),
              HasSubstr("not written by an earlier run"));
}

TEST(RunFolder, RefusesAPartThatIsNotOfARun) {
  const ScratchFolder scratch;
  scratch.Write("out/.part/thing", "mine");
  EXPECT_THAT(MessageOf([&] { const RunFolder folder(scratch / "out"); }),
              HasSubstr(".part: not of a run of plumbline; move it away"));
  EXPECT_EQ(Contents(scratch / "out/.part/thing"), "mine");
}

TEST(RunFolder, DoesNotReplaceWhatCameDuringTheRun) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  folder.Keep();
  folder.Write(Text("trajectory.txt", "new"));
  const fs::path mine = scratch.Write("out/trajectory.txt", "mine");
  EXPECT_THAT(MessageOf([&] { folder.Commit(); }),
              HasSubstr("came there during the run; the results are in " + folder.part().string()));
  EXPECT_EQ(Contents(mine), "mine");
  EXPECT_EQ(Contents(folder.part() / "trajectory.txt"), "new");
}

TEST(RunFolder, IsForOneRunAtATime) {
  const ScratchFolder scratch;
  const RunFolder first(scratch / "out");
  EXPECT_THAT(MessageOf([&] { const RunFolder second(scratch / "out"); }),
              HasSubstr("another run is writing into this folder"));
  EXPECT_TRUE(fs::exists(first.part()));
}

TEST(RunFolder, KeepsWhatAKilledRunLeft) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  WriteRun(out, {"trajectory.txt"}, "old");
  for (const std::string kept : {"interrupted-1", "interrupted-2"}) {
    {
      RunFolder killed(out);
      killed.Keep();
      killed.Write(Text("trajectory_causal.txt", "some of " + kept));
    }
    const RunFolder next(out);
    EXPECT_THAT(next.notes(),
                ElementsAre(HasSubstr("what it had written is in " + (out / kept).string())));
    EXPECT_EQ(Contents(out / kept / "trajectory_causal.txt"), "some of " + kept);
    EXPECT_EQ(Contents(out / "trajectory.txt"), "old");
  }
}

// What each step of the exchange leaves when the program is killed after it.
TEST(RunFolder, CompletesAnExchangeThatWasInterrupted) {
  const std::vector<std::string> old_names = {"map.ply", "trajectory.txt"};
  const std::vector<std::string> names = {"keyframes.txt", "map.plb", "trajectory.txt"};
  for (std::size_t steps = 0; steps <= names.size() + 1; ++steps) {
    const ScratchFolder scratch;
    const fs::path out = scratch / "out";
    WriteRun(out, old_names, "old");
    {
      RunFolder killed(out);
      killed.Keep();
      for (const std::string& name : names) killed.Write(Text(name, "new"));
    }
    WriteRunList(out / ".part", names);
    if (steps > 0) fs::remove(out / "map.ply");
    for (std::size_t i = 0; i + 1 < steps; ++i) {
      fs::rename(out / ".part" / names[i], out / names[i]);
    }
    {
      const RunFolder next(out);
      EXPECT_THAT(next.notes(), ElementsAre(HasSubstr("they are complete now"))) << steps;
    }
    EXPECT_EQ(
        FilesOf(out),
        (std::set<std::string>{".plumbline-run", "keyframes.txt", "map.plb", "trajectory.txt"}))
        << steps;
    for (const std::string& name : names) EXPECT_EQ(Contents(out / name), "new") << steps;
    EXPECT_EQ(ReadRunList(out), names) << steps;
  }
}

// After the last step but one the list is in place and the part is left.
TEST(RunFolder, RemovesThePartOfACompletedExchange) {
  const ScratchFolder scratch;
  WriteRun(scratch / "out", {"trajectory.txt"}, "new");
  fs::create_directories(scratch / "out/.part");
  scratch.Write("out/.part/.map.4711.tmp.plb", "half");
  { const RunFolder next(scratch / "out"); }
  EXPECT_EQ(FilesOf(scratch / "out"), (std::set<std::string>{".plumbline-run", "trajectory.txt"}));
}

// Poses and frames as first reported are results where the final ones could not be written.
TEST(RunFolder, TakesTheJournalForWhatCouldNotBeWritten) {
  const ScratchFolder scratch;
  RunFolder folder(scratch / "out");
  folder.Keep();
  for (const char* name : {"frames.csv", "trajectory_causal.txt", "keyframes.txt"}) {
    scratch.Write(std::string("out/.part/") + name, "journal");
  }
  scratch.Write("out/.part/notes.txt", "mine");
  EXPECT_TRUE(folder.Write(Text("trajectory.txt", "new")));
  EXPECT_TRUE(folder.Write(Text("frames.csv", "new")));
  EXPECT_FALSE(folder.Write(Failing("trajectory_causal.txt", std::errc::no_space_on_device)));
  folder.Commit();
  EXPECT_EQ(Contents(scratch / "out/frames.csv"), "new");
  EXPECT_EQ(Contents(scratch / "out/trajectory_causal.txt"), "journal");
  EXPECT_FALSE(fs::exists(scratch / "out/keyframes.txt"));
  EXPECT_EQ(FilesOf(scratch / "out/.part"), std::set<std::string>{"notes.txt"});
}

TEST(RunFolder, AFileThatCannotBeWrittenDoesNotHinderTheOthers) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  RunFolder folder(out);
  folder.Keep();
  EXPECT_FALSE(folder.Failures());
  EXPECT_TRUE(folder.Write(Text("trajectory.txt", "new")));
  EXPECT_FALSE(folder.Write(Failing("map.plb", std::errc::no_space_on_device)));
  EXPECT_FALSE(folder.Write(Failing("map.ply", std::errc::no_space_on_device)));
  EXPECT_FALSE(folder.Write({"report.html", [](const auto&) { throw std::bad_alloc(); }}));
  EXPECT_TRUE(folder.Write(Text("summary.json", "new")));
  EXPECT_EQ(*folder.Failures(),
            "cannot write " + (out / "map.plb").string() +
                ": No space left on device; map.ply: No space left on device; report.html: out of "
                "memory");
  EXPECT_FALSE(folder.WouldLose());
  folder.Commit();
  EXPECT_EQ(FilesOf(out),
            (std::set<std::string>{
                ".plumbline-lock", ".plumbline-run", "summary.json", "trajectory.txt"}));
}

TEST(RunFolder, KnowsWhenLessWouldReplaceMore) {
  const ScratchFolder scratch;
  WriteRun(scratch / "out", {"trajectory.txt", "map.plb"}, "old");
  RunFolder folder(scratch / "out");
  folder.Write(Text("trajectory.txt", "new"));
  EXPECT_FALSE(folder.WouldLose());
  folder.Write(Failing("map.plb", std::errc::no_space_on_device));
  EXPECT_TRUE(folder.WouldLose());
}

TEST(RunFolder, IsMadeAgainWhereItWasRemoved) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  {
    RunFolder folder(out);
    folder.Keep();
    folder.Write(Text("trajectory.txt", "lost"));
    fs::remove_all(out);
    EXPECT_TRUE(folder.Write(Text("trajectory.txt", "new")));
    folder.Commit();
  }
  EXPECT_EQ(Contents(out / "trajectory.txt"), "new");
  EXPECT_EQ(FilesOf(out), (std::set<std::string>{".plumbline-run", "trajectory.txt"}));
}

TEST(CheckApart, RefusesToWriteAmongWhatIsRead) {
  const ScratchFolder scratch;
  const fs::path image = scratch.Write("data/images/1.png", "");
  const fs::path map = scratch.Write("run/map.plb", "");
  const std::vector<RunInput> folder = {{scratch / "data"}};
  const auto message = [&](const fs::path& out, const std::vector<RunInput>& inputs) {
    return MessageOf([&] { CheckApart(out, inputs); });
  };
  EXPECT_THAT(message(scratch / "data", folder), HasSubstr("is " + (scratch / "data").string()));
  EXPECT_THAT(message(scratch / "data/new", folder), HasSubstr("lies in"));
  EXPECT_THAT(message(scratch.path(), folder), HasSubstr("holds"));
  EXPECT_THAT(message(scratch / "data/images", {{image}}), HasSubstr("holds " + image.string()));
  EXPECT_THAT(message(scratch / "data", folder), HasSubstr("choose another folder"));
  EXPECT_EQ(message(scratch / "run", {{scratch / "data"}, {map, true}}), "no error");
  EXPECT_THAT(message(scratch / "run", {{map}}), HasSubstr("holds"));
}

TEST(CheckFileApart, RefusesToReplaceWhatIsRead) {
  const ScratchFolder scratch;
  const fs::path image = scratch.Write("data/images/1.png", "");
  const fs::path map = scratch.Write("run/map.plb", "");
  const std::vector<RunInput> inputs = {{scratch / "data"}, {map, true}};
  const auto message = [&](const fs::path& file) {
    return MessageOf([&] { CheckFileApart("--record", file, inputs); });
  };
  EXPECT_THAT(message(image), HasSubstr("outside of " + (scratch / "data").string()));
  EXPECT_THAT(message(scratch / "data/new"), HasSubstr("--record"));
  EXPECT_THAT(message(map), HasSubstr("another file than one that is read"));
  EXPECT_EQ(message(scratch / "run/new"), "no error");
  EXPECT_EQ(message(scratch / "database"), "no error");
}

// Else every run that fails at its start would leave a folder.
TEST(RunFolder, ForgetsARunThatHadNoPose) {
  const ScratchFolder scratch;
  const fs::path out = scratch / "out";
  WriteRun(out, {"trajectory.txt"}, "old");
  {
    RunFolder killed(out);
    killed.Keep();
    killed.Write(Text("options.yaml", "slam: {}"));
    killed.Write(Text("trajectory_causal.txt", ""));
    killed.Write(Text("keyframes.txt", ""));
    killed.Write(Text("frames.csv", "frame,timestamp\n0,1.0\n"));
  }
  ASSERT_TRUE(fs::exists(out / ".part/frames.csv"));
  {
    const RunFolder next(out);
    EXPECT_THAT(next.notes(), ElementsAre());
  }
  EXPECT_EQ(FilesOf(out), (std::set<std::string>{".plumbline-run", "trajectory.txt"}));
  // A pose in another map than the first is one.
  {
    RunFolder killed(out);
    killed.Keep();
    killed.Write(Text("trajectory_causal.txt", ""));
    killed.Write(Text("trajectory_causal_map1.txt", "1.0 0 0 0 0 0 0 1\n"));
  }
  const RunFolder next(out);
  EXPECT_THAT(next.notes(), ElementsAre(HasSubstr("interrupted-1")));
}

}  // namespace
}  // namespace plumbline
