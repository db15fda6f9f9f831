// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <set>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kStereo = "euroc/MH_01_easy_first250";
constexpr const char* kRgbd = "tum/rgbd_dataset_freiburg1_floor_first90";

std::set<std::string> FilesOf(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

// Those of the files of a run that must have the same bytes in every run.
bool IsRepeatable(const std::string& name) {
  return name.starts_with("trajectory") || name.starts_with("keyframes") || name == "frames.csv" ||
         name.starts_with("map.") || name == "lines.obj";
}

TEST(Run, WritesTheSameBytesEveryTime) {
  for (const char* sequence : {kStereo, kRgbd}) {
    const auto data = FindData(sequence);
    if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
    const ScratchFolder folder;
    for (const char* run : {"first", "second"}) {
      // The second time with other threads: all of it one after the other.
      const std::string threads =
          run == std::string("second") ? " --mode inline --set features.parallel=false" : "";
      const Outcome outcome = RunProgram(
          folder,
          "run " + Quoted(*data) + " --to 40 --quiet" + threads + " --out " + Quoted(folder / run));
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    const auto names = FilesOf(folder / "first");
    EXPECT_EQ(names, FilesOf(folder / "second"));
    std::set<std::string> compared;
    for (const std::string& name : names) {
      if (!IsRepeatable(name)) continue;
      compared.insert(name);
      EXPECT_EQ(Contents(folder / "first" / name) == Contents(folder / "second" / name), true)
          << name;
    }
    EXPECT_GE(compared.size(), 6U);
    EXPECT_GT(Contents(folder / "first/trajectory.txt").size(), 1000U);
  }
}

TEST(Run, BadInputIsOneLineAndExitCodeTwo) {
  const auto data = FindData(kRgbd);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  const fs::path file = folder.Write("file", "text");
  const fs::path camera = folder.Write("camera.yaml", "model: pinhole\nwidth: 640\nfx: none\n");
  fs::create_directories(folder / "empty");
  const std::string good = "run " + Quoted(*data) + " --to 2 --out " + Quoted(folder / "out");
  struct Case {
    std::string arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {"run", "PATH"},
      {"run " + Quoted(folder / "nowhere"), "nowhere"},
      {"run " + Quoted(folder / "empty"), "empty"},
      {good + " --camera " + Quoted(camera), "camera.yaml"},
      {good + " --camera " + Quoted(folder / "none.yaml"), "none.yaml"},
      {good + " --set tracking.min_inlier=5", "did you mean 'tracking.min_inliers'?"},
      {good + " --set tracking.min_inliers=many", "tracking.min_inliers"},
      {good + " --set tracking.min_inliers=-3", "tracking.min_inliers"},
      {good + " --stide 2", "the nearest is --stride"},
      {good + " --sensor stereo", "stereo"},
      {good + " --from 5000", "--from"},
      {good + " --stride 0", "--stride"},
      {"run " + Quoted(*data) + " --to 2 --out " + Quoted(file / "below"), "below"},
      {"run " + Quoted(*data) + " --to 2 --out " + Quoted(file), "file"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = RunProgram(folder, c.arguments);
    EXPECT_EQ(outcome.code, 2) << c.arguments;
    EXPECT_EQ(outcome.out, "") << c.arguments;
    EXPECT_THAT(outcome.err, HasSubstr(c.message)) << c.arguments;
    EXPECT_THAT(outcome.err, testing::StartsWith("plumbline: "));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

// A copy of the first frames of a EuRoC folder whose files the test may break.
void CopyEuroc(const fs::path& from, const fs::path& to, std::size_t frames) {
  for (const char* camera : {"cam0", "cam1"}) {
    const fs::path source = from / "mav0" / camera;
    const fs::path target = to / "mav0" / camera;
    fs::create_directories(target / "data");
    fs::copy_file(source / "sensor.yaml", target / "sensor.yaml");
    std::istringstream list(Contents(source / "data.csv"));
    std::ofstream copy(target / "data.csv");
    std::string line;
    for (std::size_t i = 0; i < frames + 1 && std::getline(list, line); ++i) {
      copy << line << '\n';
      if (i == 0) continue;  // heading
      std::string name = line.substr(line.find(',') + 1);
      name.erase(name.find_last_not_of("\r ") + 1);
      fs::copy_file(source / "data" / name, target / "data" / name);
    }
  }
}

TEST(Run, GoesOnAfterAnUnreadableImage) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  CopyEuroc(*data, folder / "sequence", 6);
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder / "sequence/mav0/cam0/data")) {
    images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  ASSERT_EQ(images.size(), 6U);
  std::ofstream(images[2]) << "not an image";
  fs::remove(images[4]);
  const Outcome outcome = RunProgram(
      folder, "run " + Quoted(folder / "sequence") + " --quiet --out " + Quoted(folder / "run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(images[2].filename().string()));
  EXPECT_THAT(outcome.err, HasSubstr(images[4].filename().string()));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  EXPECT_EQ(summary["frames"]["in"], 6);
  EXPECT_EQ(summary["frames"]["skipped"], 2);
  EXPECT_EQ(summary["frames"]["tracked"], 4);
  EXPECT_TRUE(summary["accuracy"].is_null());  // no ground truth in the copy
  EXPECT_THAT(Contents(folder / "run/frames.csv"), HasSubstr(",skipped,,image_unreadable,"));
}

TEST(Run, ABrokenCalibrationNamesTheFile) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  CopyEuroc(*data, folder / "sequence", 2);
  folder.Write("sequence/mav0/cam1/sensor.yaml", "intrinsics: [1, 2]\n");
  const Outcome outcome = RunProgram(
      folder, "run " + Quoted(folder / "sequence") + " --quiet --out " + Quoted(folder / "run"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cam1/sensor.yaml"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

// Starts the program without waiting for it; its output goes nowhere.
pid_t Start(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), PLUMBLINE_BINARY);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int null = ::open("/dev/null", O_WRONLY);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  return child;
}

TEST(Run, EndsEarlyAndWritesEverythingWhenAsked) {
  const auto data = FindData(kStereo);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  for (const int signal : {SIGTERM, SIGINT}) {
    const ScratchFolder folder;
    const fs::path out = folder / "run";
    const pid_t child = Start({"run", data->string(), "--quiet", "--out", out.string()});
    // The options are written just before the first frame.
    for (int i = 0; i < 600 && !fs::exists(out / "options.yaml"); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
    ASSERT_EQ(::kill(child, signal), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    const auto summary = nlohmann::json::parse(Contents(out / "summary.json"));
    const int frames = summary["frames"]["in"];
    EXPECT_GT(frames, 0);
    EXPECT_LT(frames, 250);
    const std::string table = Contents(out / "frames.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), frames + 1);
    const std::string poses = Contents(out / "trajectory.txt");
    EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), summary["frames"]["tracked"]);
    for (const char* name :
         {"trajectory_causal.txt", "keyframes.txt", "timing.json", "map.ply", "report.html"}) {
      EXPECT_TRUE(fs::exists(out / name)) << name;
    }
  }
}

}  // namespace
}  // namespace plumbline
