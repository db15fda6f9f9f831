// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/version.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace plumbline {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

Outcome RunProgram(const std::string& arguments) {
  const ScratchFolder folder;
  const std::string command = std::string("'" PLUMBLINE_BINARY "' ") + arguments + " > '" +
                              (folder / "out").string() + "' 2> '" + (folder / "err").string() +
                              "'";
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
  return {WEXITSTATUS(status), Contents(folder / "out"), Contents(folder / "err")};
}

TEST(Program, HelpListsTheCommands) {
  for (const char* arguments : {"help", "--help", "-h"}) {
    const Outcome outcome = RunProgram(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("usage: plumbline COMMAND"));
    EXPECT_THAT(outcome.out, HasSubstr("\n  info "));
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_EQ(RunProgram("").code, 2);
  EXPECT_EQ(RunProgram("--version").out, "plumbline " PLUMBLINE_VERSION "\n");
}

// The commands of this build: those of the worlds and of the laboratory may be left out.
std::vector<std::string> Commands() {
  std::vector<std::string> names = {"run", "evaluate", "info", "map", "config"};
#ifdef PLUMBLINE_WITH_WORLDS
  names.insert(names.end(), {"synth"});
#endif
#ifdef PLUMBLINE_WITH_LAB
  names.insert(names.end(), {"consistency", "experiment", "lines", "starts"});
#endif
  return names;
}

TEST(Program, ACommandThatWasNotBuiltSaysHowToBuildIt) {
  const std::vector<std::string> built = Commands();
  for (const std::string name : {"synth", "consistency", "experiment", "lines", "starts"}) {
    if (std::find(built.begin(), built.end(), name) != built.end()) continue;
    const Outcome outcome = RunProgram(name);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(name + " is not part of this build"));
    EXPECT_THAT(outcome.err, HasSubstr("configure with -DPLUMBLINE_"));
  }
  if (built.size() == 10) GTEST_SKIP() << "all commands were built";
}

TEST(Program, EveryCommandHasHelp) {
  for (const std::string& name : Commands()) {
    const Outcome outcome = RunProgram(name + " --help");
    EXPECT_EQ(outcome.code, 0) << name;
    EXPECT_THAT(outcome.out, StartsWith("plumbline " + name));
    EXPECT_EQ(RunProgram("help " + name).out, outcome.out);
  }
}

TEST(Program, BadInputIsOneLineAndExitCodeTwo) {
  struct Case {
    std::string arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {"inof", "plumbline: unknown command 'inof'; did you mean 'info'?"},
      {"elephants", "plumbline: unknown command 'elephants'; see plumbline help"},
      {"info", "plumbline: info: expected PATH"},
      {"info /does/not/exist", "plumbline: /does/not/exist: no such file or folder"},
      {"info . --sensr mono", "plumbline: info: unknown option --sensr; the nearest is --sensor"},
      {"info . --sensor sonar", "plumbline: --sensor: expected mono, stereo or rgbd, found sonar"},
      {"info . --format zip", "plumbline: --format: expected euroc, "},
      {"config --config /none.yaml", "plumbline: /none.yaml: no such file"},
      {"config --set slam.sede=1", "unknown option 'slam.sede'; did you mean 'slam.seed'?"},
      {"config --set slam.seed=x", "slam.seed: expected a whole number"},
      {"config x", "plumbline: config: unexpected argument x"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = RunProgram(c.arguments);
    EXPECT_EQ(outcome.code, 2) << c.arguments;
    EXPECT_EQ(outcome.out, "") << c.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  }
}

TEST(Program, ConfigOutputIsAConfigFile) {
  const Outcome first = RunProgram("config --set slam.seed=17");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("seed: 17 "));
  const ScratchFolder folder;
  const std::string file = folder.Write("c.yaml", first.out).string();
  EXPECT_EQ(RunProgram("config --config '" + file + "'").out, first.out);
  EXPECT_THAT(RunProgram("config --config '" + file + "' --set slam.seed=18").out,
              HasSubstr("seed: 18 "));
}

TEST(Program, ConfigShowsWhatUsersSetAndWhatWasChanged) {
  const auto options = [](const std::string& out) {
    return std::count_if(out.begin(), out.end(), [](char c) { return c == '('; });
  };
  const std::string users = RunProgram("config").out, all = RunProgram("config --all").out;
  EXPECT_THAT(users, HasSubstr("point_count: 1000 "));
  EXPECT_THAT(users, Not(HasSubstr("redundant_share")));
  EXPECT_THAT(all, HasSubstr("redundant_share"));
  EXPECT_THAT(all, HasSubstr("\nmapping.ba.robust: true "));
  EXPECT_GT(options(all), 2 * options(users));
  const std::string changed = RunProgram("config --set mapping.ba.robust=false").out;
  EXPECT_THAT(changed, HasSubstr("  ba:  # local bundle adjustment\n    robust: false "));
  EXPECT_THAT(changed, Not(HasSubstr("redundant_share")));
}

TEST(Program, NamesTheConstantOfAnOptionThatWasRemoved) {
  const ScratchFolder folder;
  const std::string file = folder.Write("c.yaml", "mapping:\n  ba:\n    rounds: 3\n").string();
  const std::string why =
      "mapping.ba.rounds is no option any more: it is fixed at 2 (MappingOptions::ba), found '3'\n";
  for (const auto& [arguments, where] :
       {std::pair{"--set mapping.ba.rounds=3", std::string("--set mapping.ba.rounds=3: ")},
        std::pair{"--config FILE", file + ":3: "}}) {
    std::string command = std::string("config ") + arguments;
    if (const auto at = command.find("FILE"); at != std::string::npos) command.replace(at, 4, file);
    const Outcome outcome = RunProgram(command);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, testing::EndsWith(where + why));
  }
}

TEST(Program, InfoDescribesARealSequence) {
  const auto path = FindData("euroc/MH_01_easy_first250");
  if (!path) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const Outcome outcome = RunProgram("info '" + path->string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"euroc",
                           "stereo, mono (shown: stereo)",
                           "250",
                           "20 Hz",
                           "0.1101 m",
                           "752x480",
                           "poses of the body, at 250 of 250 frames"}) {
    EXPECT_THAT(outcome.out, HasSubstr(part));
  }
}

TEST(Program, InfoTellsOfAMissingCamera) {
  const auto path = FindData("icl/office_kt3_first600");
  if (!path) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  EXPECT_THAT(RunProgram("info '" + path->string() + "'").out, HasSubstr("missing: give --camera"));
  EXPECT_THAT(RunProgram("info --camera icl_nuim '" + path->string() + "'").out,
              HasSubstr("fx 481.2"));
}

}  // namespace
}  // namespace plumbline
