// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs that are asked to stop, that are killed, and whose listeners go away.
#include "plumbline/base/random.h"

#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace run_interruption_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string RunArguments(const fs::path& sequence, const fs::path& out, const std::string& more) {
  return "run " + Quoted(sequence) + " --quiet --out " + Quoted(out) + " " + more;
}

std::ptrdiff_t Rows(const fs::path& path) {
  const std::string text = Contents(path);
  return std::count(text.begin(), text.end(), '\n');
}

// Waits, at most a minute, until a table has so many rows.
bool WaitForRows(const fs::path& path, std::ptrdiff_t rows) {
  for (int i = 0; i < 6000 && Rows(path) < rows; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return Rows(path) >= rows;
}

struct Interruption {
  int signal = 0;
  const char* name = "";
  int code = 0;
  const char* mode = "";
};

class Interrupted : public ::testing::TestWithParam<Interruption> {};
INSTANTIATE_TEST_SUITE_P(Signals,
                         Interrupted,
                         ::testing::Values(Interruption{SIGTERM, "SIGTERM", 143, "inline"},
                                           Interruption{SIGINT, "SIGINT", 130, "lockstep"},
                                           Interruption{SIGHUP, "SIGHUP", 143, "live"}),
                         [](const auto& how) { return std::string(how.param.name); });

TEST_P(Interrupted, ARunWritesEverythingAndSaysSo) {
  const Interruption& how = GetParam();
  const ScratchFolder folder;
  const fs::path out = folder / "run";
  const fs::path sequence = WritePosterSequence(folder, 4000);
  const pid_t child = StartProgram(
      {"run", sequence.string(), "--mode", how.mode, "--quiet", "--out", out.string()});
  // The journal of the first frames is the sign that it runs.
  EXPECT_TRUE(WaitForRows(out / ".part/frames.csv", 2));
  ASSERT_EQ(::kill(child, how.signal), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), how.code);
  const auto summary = nlohmann::json::parse(Contents(out / "summary.json"));
  EXPECT_EQ(summary["interrupted"], how.name);
  EXPECT_EQ(summary["frames"]["of"], 4000);
  const int frames = summary["frames"]["in"];
  EXPECT_GT(frames, 0);
  EXPECT_LT(frames, 4000);
  EXPECT_EQ(Rows(out / "frames.csv"), frames + 1);
  EXPECT_EQ(Rows(out / "trajectory.txt"), summary["frames"]["tracked"]);
  EXPECT_THAT(Contents(out / "report.html"),
              HasSubstr(std::string("\"interrupted\":\"") + how.name + "\""));
  for (const char* name :
       {"trajectory_causal.txt", "keyframes.txt", "timing.json", "map.plb", "lines.obj"}) {
    EXPECT_TRUE(fs::exists(out / name)) << name;
  }
  for (const std::string& name : FilesOf(out)) {
    EXPECT_TRUE(name.front() != '.' || name == ".plumbline-run") << name;
  }
}

// The end of a run, as the adjustment of the whole map, can be cut short as its frames can.
TEST(Interruption, AtTheEndKeepsAnEarlierRunOfMorePoses) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 40);
  const fs::path out = folder / "out";
  constexpr int kTrials = 5;  // where the machine is busy, the run may end before its signal
  int code = 0;
  for (int k = 0; k < kTrials && code != 130; ++k) {
    fs::remove_all(out);
    ASSERT_EQ(RunProgram(folder, RunArguments(sequence, out, "")).code, 0);
    const pid_t child = StartProgram({"run",
                                      sequence.string(),
                                      "--to",
                                      "30",
                                      "--mode",
                                      "inline",
                                      "--quiet",
                                      "--out",
                                      out.string()});
    EXPECT_TRUE(WaitForRows(out / ".part/frames.csv", 31));
    ::kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    code = WEXITSTATUS(status);
  }
  ASSERT_EQ(code, 130);
  EXPECT_EQ(Rows(out / "trajectory.txt"), 40);
  EXPECT_EQ(Rows(out / ".part/frames.csv"), 31);
  EXPECT_EQ(nlohmann::json::parse(Contents(out / ".part/summary.json"))["interrupted"], "SIGINT");
}

TEST(Interruption, AHangupThatIsIgnoredStaysSo) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 300);
  const fs::path out = folder / "out";
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = SIG_IGN;
  ASSERT_EQ(::sigaction(SIGHUP, &ignore, &before), 0);
  const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
  ::sigaction(SIGHUP, &before, nullptr);
  EXPECT_TRUE(WaitForFile(out / ".part/trajectory_causal.txt"));
  ::kill(child, SIGHUP);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(nlohmann::json::parse(Contents(out / "summary.json"))["frames"]["in"], 300);
}

// The reader ends at once, while the run says something for every frame.
TEST(Interruption, ListenersMayGoAway) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 40);
  for (const int i : {1, 2, 3, 4, 5, 6}) {
    folder.Write(fmt::format("sequence/mav0/cam0/data/{}.png", i), "not an image");
  }
  for (const char* pipe : {"2>&1 >/dev/null | true", "2>/dev/null | true", "2>&1 | true"}) {
    const fs::path out = folder / "out";
    const std::string command =
        fmt::format("bash -c \"set -o pipefail; '{}' run '{}' --out '{}' {}\"",
                    PLUMBLINE_BINARY,
                    sequence.string(),
                    out.string(),
                    pipe);
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0)
        << pipe;  // NOLINT(concurrency-mt-unsafe)
    EXPECT_EQ(Rows(out / "frames.csv"), 41) << pipe;
    EXPECT_TRUE(fs::exists(out / "report.html")) << pipe;
    fs::remove_all(out);
  }
}

// How many frames a run had read when it failed, as its message says: "after N of M frames".
int FramesBefore(const std::string& message) {
  const std::size_t place = message.find(" after ");
  return place == std::string::npos ? 0 : std::atoi(message.c_str() + place + 7);
}

// With so little address space the run fails before it begins, in its middle or not at all. The
// first keyframes are made while the next frames are read: a run that fails then may have no map.
TEST(Interruption, ShortMemoryLosesNothingThatWasDone) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer has all address space for itself";
#endif
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 60);
  for (const int megabytes : {200, 300, 400, 500, 600, 800}) {
    const fs::path out = folder / fmt::format("out{}", megabytes);
    const Outcome outcome = RunProgram(
        folder, RunArguments(sequence, out, ""), fmt::format("ulimit -v {}; ", megabytes * 1024));
    if (outcome.code == 0) continue;
    if (outcome.code == 127) continue;  // the program itself does not fit
    EXPECT_EQ(outcome.code, 2) << megabytes << outcome.err;
    EXPECT_TRUE(outcome.err.find("out of memory") != std::string::npos ||
                outcome.err.find("no further thread") != std::string::npos)
        << megabytes << outcome.err;
    if (FramesBefore(outcome.err) < 5) continue;
    EXPECT_GT(Rows(out / "trajectory.txt"), 0) << megabytes << outcome.err;
    EXPECT_TRUE(fs::exists(out / "frames.csv"));
  }
}

// How often a run is killed; more in the full test.
int Kills() {
  const char* wanted = std::getenv("PLUMBLINE_KILLS");  // NOLINT(concurrency-mt-unsafe)
  return wanted != nullptr ? std::atoi(wanted) : 6;
}

// The file as the next run would find it in the results: new ones may wait in the part.
fs::path PlaceOf(const fs::path& out, const std::string& name) {
  const bool complete = fs::exists(out / ".part/.plumbline-run");
  return complete && fs::exists(out / ".part" / name) ? out / ".part" / name : out / name;
}

bool IsWhole(const fs::path& out, const fs::path& whole) {
  for (const std::string& name : FilesOf(whole)) {
    if (!IsRepeatable(name)) continue;
    if (Contents(PlaceOf(out, name)) != Contents(whole / name)) return false;
  }
  return true;
}

// Killed at any moment, the folder has the earlier results whole, or the new ones.
// Whether the next run tells of what a killed one left: all results, or at least one frame.
bool IsToldOf(const fs::path& part) {
  if (fs::exists(part / ".plumbline-run")) return true;
  if (!fs::exists(part / "frames.csv")) return false;
  const std::string frames = Contents(part / "frames.csv");
  return std::count(frames.begin(), frames.end(), '\n') > 1;  // the first line names the columns
}

TEST(Interruption, AKillLosesNeitherTheEarlierResultsNorTheLastSeconds) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 60);
  const fs::path out = folder / "out";
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "old", "--to 30")).code, 0);
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(RunProgram(folder, RunArguments(sequence, folder / "new", "")).code, 0);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Rng rng(7, "kill");
  int kept = 0, replaced = 0;
  for (int k = 0; k < Kills(); ++k) {
    fs::remove_all(out);
    fs::copy(folder / "old", out, fs::copy_options::recursive);
    const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
    std::this_thread::sleep_for(std::chrono::duration<double>(rng.Uniform(0, 1.1 * seconds)));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const bool old_whole = IsWhole(out, folder / "old");
    const bool new_whole = IsWhole(out, folder / "new");
    EXPECT_TRUE(old_whole || new_whole) << k;
    kept += old_whole;
    replaced += new_whole;
    if (fs::exists(out / ".part/trajectory_causal.txt")) {
      // A beginning of the whole one, row by row.
      const std::string causal = Contents(out / ".part/trajectory_causal.txt");
      EXPECT_TRUE(causal.empty() || causal.back() == '\n') << k;
      EXPECT_TRUE(Contents(folder / "new/trajectory_causal.txt").starts_with(causal)) << k;
    }
    const bool told = IsToldOf(out / ".part");
    const Outcome next = RunProgram(folder, RunArguments(sequence, out, "--to 2"));
    EXPECT_EQ(next.code, 0) << next.err;
    EXPECT_EQ(next.err.find("an earlier run was cut off") != std::string::npos, told) << k;
  }
  RecordProperty("kept", kept);
  RecordProperty("replaced", replaced);
}

TEST(Interruption, TheJournalIsThereBeforeTheEnd) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 4000);
  const fs::path out = folder / "out";
  const pid_t child = StartProgram({"run", sequence.string(), "--quiet", "--out", out.string()});
  EXPECT_TRUE(WaitForRows(out / ".part/trajectory_causal.txt", 20));
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(FilesOf(out), (std::set<std::string>{".part", ".plumbline-lock"}));
  for (const char* name :
       {"trajectory_causal.txt", "frames.csv", "keyframes.txt", "options.yaml"}) {
    EXPECT_TRUE(fs::exists(out / ".part" / name)) << name;
  }
  const Outcome next = RunProgram(folder, RunArguments(sequence, out, "--to 3"));
  EXPECT_EQ(next.code, 0);
  EXPECT_THAT(next.err, HasSubstr("what it had written is in " + (out / "interrupted-1").string()));
  EXPECT_GE(Rows(out / "interrupted-1/trajectory_causal.txt"), 20);
  EXPECT_EQ(Rows(out / "trajectory.txt"), 3);
}

}  // namespace run_interruption_test
}  // namespace plumbline
