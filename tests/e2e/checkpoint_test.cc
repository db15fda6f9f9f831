// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs that stop in the middle and are gone on with: --checkpoint and --resume.
//
// PLUMBLINE_PAUSES=5 stops each recorded sequence and world at five frames, one after the other.
#include "plumbline/io/checkpoint_io.h"
#include "worlds/sequence_cache.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include "tests/e2e/poster_run.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

void ExpectTheSameResults(const fs::path& a, const fs::path& b) {
  int compared = 0;
  for (const std::string& name : FilesOf(a)) {
    if (!IsRepeatable(name)) continue;
    ++compared;
    EXPECT_TRUE(Contents(a / name) == Contents(b / name)) << name;
  }
  EXPECT_GE(compared, 7);
}

// A run over some data, whole and in two parts.
struct PausedRun {
  ScratchFolder folder;
  fs::path data;
  std::string arguments;

  fs::path whole() const { return folder / "whole"; }
  fs::path checkpoint() const { return folder / "c.plbrun"; }
  Outcome Run(const std::string& more) const {
    return RunProgram(folder, "run " + Quoted(data) + " --quiet " + arguments + " " + more);
  }
  void ExpectToRun(const std::string& more) const {
    const Outcome outcome = Run(more);
    // 1: no frame had a pose, as in the first seconds of OfficeMono.
    ASSERT_LE(outcome.code, 1) << more << "\n" << outcome.err;
  }
  // Pauses before frame `pause` of `frames`.
  void ExpectNoDifference(int pause, int frames) const {
    const std::string part = Quoted(folder / "part");
    ExpectToRun(fmt::format("--to {} --checkpoint {} --out {}", pause, Quoted(checkpoint()), part));
    ExpectToRun(fmt::format(
        "--to {} --mode inline --resume {} --out {}", frames, Quoted(checkpoint()), part));
    ExpectTheSameResults(whole(), folder / "part");
  }
};

int PausesOfEach() {
  const char* wanted = std::getenv("PLUMBLINE_PAUSES");  // NOLINT(concurrency-mt-unsafe)
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : 1;
}

void CheckPauses(const fs::path& data, const std::string& arguments, int frames) {
  const PausedRun run{{}, data, arguments};
  run.ExpectToRun(fmt::format("--to {} --out {}", frames, Quoted(run.whole())));
  const int pauses = PausesOfEach();
  for (int k = 1; k <= pauses; ++k) {
    const int pause = k * frames / (pauses + 1);
    SCOPED_TRACE(fmt::format("paused before frame {}", pause));
    run.ExpectNoDifference(pause, frames);
  }
}

TEST(CheckpointOfRun, IsGoneOnWithAsIfTheRunHadNotStopped) {
  const PausedRun run{{}, Posters().sequence, ""};
  run.ExpectToRun("--to 7 --checkpoint " + Quoted(run.checkpoint()) + " --out " +
                  Quoted(run.folder / "part"));
  // Once more in the middle, by way of the same file.
  run.ExpectToRun("--to 15 --resume " + Quoted(run.checkpoint()) + " --checkpoint " +
                  Quoted(run.checkpoint()) + " --out " + Quoted(run.folder / "part"));
  run.ExpectToRun("--resume " + Quoted(run.checkpoint()) + " --out " + Quoted(run.folder / "part"));
  ExpectTheSameResults(Posters().out, run.folder / "part");
}

TEST(CheckpointOfRun, HasTheOptionsAndTheMapOfTheRun) {
  const PausedRun run{{}, Posters().sequence, "--from 2 --stride 2"};
  const std::string how = "--set slam.seed=4 --set mapping.window.free_keyframes=3 --map " +
                          Quoted(Posters().map) + " ";
  run.ExpectToRun(how + "--out " + Quoted(run.whole()));
  run.ExpectToRun(how + "--to 11 --checkpoint " + Quoted(run.checkpoint()) + " --out " +
                  Quoted(run.folder / "part"));
  run.ExpectToRun("--resume " + Quoted(run.checkpoint()) + " --out " + Quoted(run.folder / "part"));
  ExpectTheSameResults(run.whole(), run.folder / "part");
}

TEST(CheckpointOfRun, IsWrittenWhenASignalStopsIt) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 300);
  const PausedRun run{{}, sequence, ""};
  const pid_t program = StartProgram({"run",
                                      sequence.string(),
                                      "--checkpoint",
                                      run.checkpoint().string(),
                                      "--out",
                                      (run.folder / "part").string()});
  // The table of frames begins with a row of names.
  const auto tells_of_frames = [&] {
    const std::string table = Contents(run.folder / "part/.part/frames.csv");
    return std::count(table.begin(), table.end(), '\n') > 3;
  };
  for (int i = 0; i < 6000 && !tells_of_frames(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_TRUE(tells_of_frames());
  ::kill(program, SIGINT);
  int status = 0;
  ::waitpid(program, &status, 0);
  ASSERT_TRUE(fs::exists(run.checkpoint()));
  run.ExpectToRun("--resume " + Quoted(run.checkpoint()) + " --out " + Quoted(run.folder / "part"));
  run.ExpectToRun("--out " + Quoted(run.whole()));
  ExpectTheSameResults(run.whole(), run.folder / "part");
}

// What is given as it is by default is the same choice of frames, also in the words of a
// checkpoint.
TEST(CheckpointOfRun, DoesNotMindDefaultsThatAreSpeltOut) {
  const PausedRun run{{}, Posters().sequence, ""};
  const std::string spelt_out = "--from 0 --stride 1 --blur 1 ";
  const std::string part = " --out " + Quoted(run.folder / "part");
  for (const auto& [before, after] :
       {std::pair{spelt_out, std::string()}, {std::string(), spelt_out}}) {
    run.ExpectToRun(before + "--to 5 --checkpoint " + Quoted(run.checkpoint()) + part);
    run.ExpectToRun(after + "--to 8 --resume " + Quoted(run.checkpoint()) + part);
  }
  SavedRun saved = LoadCheckpoint(run.checkpoint());
  EXPECT_EQ(saved.input, "");
  saved.input = "--from 0 --blur 1";
  SaveCheckpoint(run.checkpoint(), saved);
  run.ExpectToRun("--to 8 --resume " + Quoted(run.checkpoint()) + part);
  ExpectRefusal(run.Run("--from 1 --resume " + Quoted(run.checkpoint()) + part),
                "expected the run's choice of frames again (none), found --from 1");
}

TEST(CheckpointOfRun, IsRefusedForAnotherRunAndNothingIsTouched) {
  const PausedRun run{{}, Posters().sequence, ""};
  const std::string from = " --resume " + Quoted(run.checkpoint());
  run.ExpectToRun("--to 9 --stride 2 --checkpoint " + Quoted(run.checkpoint()) + " --out " +
                  Quoted(run.folder / "part"));
  const auto expect_refused = [&](const std::string& arguments, const std::string& why) {
    ExpectRefusal(run.Run(arguments + " --out " + Quoted(run.folder / "out")), why);
    EXPECT_FALSE(fs::exists(run.folder / "out")) << arguments;
  };
  expect_refused(from, "expected the run's choice of frames again (--stride 2), found none");
  expect_refused("--stride 2 --to 3" + from, "expected the 5 frames of the checkpoint and more");
  expect_refused("--stride 2 --set slam.seed=3" + from,
                 "slam.seed: expected 0 as in the checkpoint, found 3");
  expect_refused("--stride 2 --sensor mono" + from, "of the same rectified camera, found");
  expect_refused("--map " + Quoted(Posters().map) + from, "--map: expected without --resume");
  expect_refused("--resume " + Quoted(Posters().map), "expected a Plumbline checkpoint");
  expect_refused("--map " + Quoted(run.checkpoint()), "expected a Plumbline map");
  expect_refused("--checkpoint " + Quoted(run.folder / "none/c"), "no such folder");
  expect_refused("--checkpoint " + Quoted(run.folder.path()), "Is a directory");
  // Where nobody may make a file, and under a name that has no room for that of its beginnings.
  expect_refused("--checkpoint /proc/plumbline.plbrun", "cannot write /proc/plumbline.plbrun: ");
  expect_refused("--checkpoint " + Quoted(run.folder / std::string(250, 'c')), "name too long");
  expect_refused("--checkpoint " + Quoted(run.folder / "out/map.plb"), "expected another name");
  expect_refused("--record " + Quoted(run.folder.path()), "Is a directory");
  expect_refused("--record " + Quoted(run.folder / "out/map.plb"), "expected another name");
  expect_refused("--checkpoint " + Quoted(fs::path(Posters().sequence) / "c"), "which is read");
  const fs::path notes = run.folder.Write("notes.txt", "mine");
  expect_refused("--record " + Quoted(notes),
                 "expected a recording by plumbline to replace, or a new file");
  expect_refused("--checkpoint " + Quoted(notes),
                 "expected a checkpoint to replace, or a new file");
  EXPECT_EQ(Contents(notes), "mine");
  // A recording that a camera made.
  const std::string recorded = "\x89MCAP0\r\n\x01 of others";
  const fs::path camera = run.folder.Write("camera.mcap", recorded);
  expect_refused("--record " + Quoted(camera), "expected a recording by plumbline to replace");
  EXPECT_EQ(Contents(camera), recorded);
  const std::string same = Quoted(run.folder / "same");
  expect_refused("--record " + same + " --checkpoint " + same, "expected another file");
  const std::string bytes = Contents(run.checkpoint());
  run.folder.Write("c.plbrun", bytes.substr(0, bytes.size() / 2));
  expect_refused("--stride 2" + from, "c.plbrun: ");
}

struct Recorded {
  const char* name;
  const char* sequence;
  const char* arguments;
  int frames;
};

class CheckpointOfRecording : public testing::TestWithParam<Recorded> {};
INSTANTIATE_TEST_SUITE_P(
    Recorded,
    CheckpointOfRecording,
    testing::Values(
        Recorded{"MachineHall", "euroc/MH_01_easy_first250", "", 40},
        Recorded{"Floor", "tum/rgbd_dataset_freiburg1_floor_first90", "", 30},
        Recorded{"OfficeMono", "icl/office_kt3_first600", "--sensor mono --camera icl_nuim", 60}),
    [](const auto& recorded) { return std::string(recorded.param.name); });

TEST_P(CheckpointOfRecording, IsGoneOnWithAsIfTheRunHadNotStopped) {
  const auto data = FindData(GetParam().sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  CheckPauses(*data, GetParam().arguments, GetParam().frames);
}

class CheckpointOfWorld : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Worlds, CheckpointOfWorld, testing::Values("room", "lowtexture"));

// The sequences are those of the gates of accuracy, so that they are rendered once.
TEST_P(CheckpointOfWorld, IsGoneOnWithAsIfTheRunHadNotStopped) {
  constexpr int kThreads = 2;
  SynthOptions options;
  if (const auto adjust = FindWorld(GetParam()).adjust) adjust(options);
  options.scale = 0.5;
  options.frames = 100;
  CheckPauses(CachedSequence(PLUMBLINE_RENDERED_FOLDER, GetParam(), options, kThreads), "", 50);
}

}  // namespace
}  // namespace plumbline
