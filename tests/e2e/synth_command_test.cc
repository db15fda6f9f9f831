// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kSmall = " --set scale=0.25 --set texel=20 --set samples=1";

TEST(SynthCommand, RefusesBadInputInOneLine) {
  const ScratchFolder folder;
  folder.Write("full/diary.txt", "dear");
  folder.Write("file", "not a folder");
  struct Case {
    std::string arguments, message;
  };
  const std::string out = " --out " + Quoted(folder / "out");
  const std::vector<Case> cases = {
      {"moon" + out, "world: expected one of room"},
      {"" + out, "expected the name of a world"},
      {"room", "expected --out DIR"},
      {"room --format kitti" + out, "--format: expected euroc or tum, found kitti"},
      {"room --set shutter_ms=40 --set readout_ms=20" + out, "shutter_ms + readout_ms"},
      {"room --set scale=0.001" + out, "scale: expected a number, 0.1 to 4"},
      {"room --set sampels=4" + out, "samples"},
      {"room --out " + Quoted(folder / "full"), "expected an empty folder or one with a rendered"},
      {"room --out " + Quoted(folder / "file"), "file"},
      {"room --out " + Quoted(folder / "file/below"), "file/below"}};
  for (const Case& bad : cases) {
    const Outcome outcome = RunProgram(folder, "synth " + bad.arguments);
    EXPECT_EQ(outcome.code, 2) << bad.arguments;
    EXPECT_EQ(outcome.out, "") << bad.arguments;
    EXPECT_THAT(outcome.err, StartsWith("plumbline: ")) << bad.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(bad.message)) << bad.arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_EQ(Contents(folder / "full/diary.txt"), "dear");
  EXPECT_FALSE(fs::exists(folder / "out/world.yaml"));
}

TEST(SynthCommand, TheWorldThatIsReadIsNotRemoved) {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  const std::string few = " --set frames=1 --out " + Quoted(out) + kSmall;
  fs::copy_file(PLUMBLINE_EXAMPLES "/worlds/shed.yaml", folder / "shed.yaml");
  ASSERT_EQ(RunProgram(folder, "synth " + Quoted(folder / "shed.yaml") + few).code, 0);
  const fs::path described = out / "described_world.yaml";
  const std::string text = Contents(described);
  ASSERT_FALSE(text.empty());
  const Outcome outcome = RunProgram(folder, "synth " + Quoted(described) + few);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("described_world.yaml, which is read"));
  EXPECT_EQ(Contents(described), text);
  EXPECT_TRUE(fs::exists(out / "world.yaml"));
}

TEST(SynthCommand, KeepsTheSequenceWhereAnotherCannotBeMade) {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  const std::string few = "synth room --set frames=1 --out " + Quoted(out) + kSmall;
  ASSERT_EQ(RunProgram(folder, few).code, 0);
  const std::set<std::string> before = FilesOf(out);
  const fs::path image = out / "mav0/cam0/data/1500000000000000000.png";
  ASSERT_TRUE(fs::exists(image));
  for (const char* bad : {" --set shutter_ms=40 --set readout_ms=20", " --set camera=kitti"}) {
    const Outcome outcome = RunProgram(folder, few + bad);
    EXPECT_EQ(outcome.code, 2) << bad;
    EXPECT_EQ(FilesOf(out), before) << bad;
    EXPECT_TRUE(fs::exists(image)) << bad;
  }
}

TEST(SynthCommand, TellsWhenThereIsNoRoomLeft) {
  const ScratchFolder folder;
  // No file larger than 8 blocks (4 KiB): the images do not fit.
  const Outcome outcome =
      RunProgram(folder,
                 "synth room --set frames=2 --out " + Quoted(folder / "out") + kSmall,
                 "trap '' XFSZ; ulimit -f 8; ");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cannot write"));
  EXPECT_THAT(outcome.err, HasSubstr(".png"));
  EXPECT_FALSE(fs::exists(folder / "out/world.yaml"));
}

TEST(SynthCommand, KilledInTheMiddleLeavesNothingWhole) {
  const ScratchFolder folder;
  const fs::path out = folder / "out";
  std::vector<std::string> arguments = {"synth", "room", "--out", out.string()};
  for (const char* setting : {"scale=0.25", "texel=20", "samples=1"}) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  const pid_t child = StartProgram(arguments);
  ASSERT_TRUE(WaitForFile(out / "mav0/cam1/data/1500000000000000000.png"));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::exists(out / "world.yaml.part"));
  EXPECT_FALSE(fs::exists(out / "world.yaml"));
  EXPECT_EQ(RunProgram(folder, "info " + Quoted(out)).code, 2);
  // The same call again makes it whole.
  const std::string again = "synth room --set frames=2 --out " + Quoted(out) + kSmall;
  ASSERT_EQ(RunProgram(folder, again).code, 0);
  EXPECT_TRUE(fs::exists(out / "world.yaml"));
  EXPECT_FALSE(fs::exists(out / "world.yaml.part"));
  const Outcome info = RunProgram(folder, "info " + Quoted(out));
  EXPECT_EQ(info.code, 0);
  EXPECT_THAT(info.out, HasSubstr("2"));
}

// In both formats, with the calibration that the file of a sensor tells.
TEST(SynthCommand, RendersAnInertialSensorAsItIs) {
  const ScratchFolder folder;
  for (const std::string format : {"euroc", "tum"}) {
    const fs::path out = folder / format;
    const std::string call = "synth room --set frames=6 --set rate_hz=1 --set imu.gap_ms=500 " +
                             std::string("--set imu.margin_s=0.5 --format ") + format + " --out " +
                             Quoted(out) + kSmall;
    ASSERT_EQ(RunProgram(folder, call).code, 0);
    const Outcome info = RunProgram(folder, "info " + Quoted(out));
    EXPECT_EQ(info.code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr(" samples in 6.000 s, 200 Hz, jitter 0 ms; "));
    EXPECT_THAT(info.out, HasSubstr(": place, noise; 0.0"));
    EXPECT_THAT(info.out, HasSubstr("gaps above 1.5 intervals, the longest 0.5"));
  }
}

// `info` finds the offset of a clock that no file tells, by the turns of the true poses.
TEST(SynthCommand, RendersAClockThatInfoFinds) {
  const ScratchFolder folder;
  const std::string call =
      "synth room --set frames=20 --set rate_hz=2 --set imu.margin_s=0.5 --set imu.bias=1 "
      "--set imu.offset_ms=-12 --out " +
      Quoted(folder / "out") + kSmall;
  ASSERT_EQ(RunProgram(folder, call).code, 0);
  const Outcome info = RunProgram(folder, "info " + Quoted(folder / "out"));
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("imu to camera measured by poses and samples: rotation to 0.0"));
  EXPECT_THAT(info.out, HasSubstr("imu fault     time_offset is 0.0000 s, but -0.0120 s by"));
  EXPECT_THAT(info.out, testing::Not(HasSubstr("imu_from_left is turned")));
}

TEST(SynthCommand, ListsWorldsAndTheirOptions) {
  const ScratchFolder folder;
  const Outcome all = RunProgram(folder, "synth --list");
  EXPECT_EQ(all.code, 0);
  EXPECT_THAT(all.out, HasSubstr("  room  "));
  EXPECT_THAT(all.out, HasSubstr("shutter_ms: 0"));
  const Outcome room = RunProgram(folder, "synth room --list");
  EXPECT_EQ(room.code, 0);
  EXPECT_THAT(room.out, HasSubstr("Purpose: small and rich, for demonstrations and tests."));
  EXPECT_THAT(room.out, HasSubstr("The whole path takes 10.0 s, 200 frames."));
}

}  // namespace
}  // namespace plumbline
