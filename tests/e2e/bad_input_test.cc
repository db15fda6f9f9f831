// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kLeftList = "sequence/mav0/cam0/data.csv";
const std::string kTruth = "sequence/mav0/state_groundtruth_estimate0/data.csv";

// One line on stderr, nothing on stdout, exit code 2.
void ExpectRefused(const Outcome& outcome, const std::string& message, const std::string& what) {
  EXPECT_EQ(outcome.code, 2) << what;
  EXPECT_EQ(outcome.out, "") << what;
  EXPECT_THAT(outcome.err, StartsWith("plumbline: ")) << what;
  EXPECT_THAT(outcome.err, HasSubstr(message)) << what;
  EXPECT_THAT(outcome.err, EndsWith("\n")) << what;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

// A sequence in which `spoil` breaks something is refused before anything is written.
struct Fault {
  std::string what;
  std::function<void(const ScratchFolder&)> spoil;
  std::string message;
  std::string arguments = "";  // FOLDER stands for the test's folder
};

std::function<void(const ScratchFolder&)> Put(const std::string& file, const std::string& text) {
  return [=](const ScratchFolder& folder) { folder.Write(file, text); };
}

std::function<void(const ScratchFolder&)> Remove(const std::string& path) {
  return [=](const ScratchFolder& folder) { fs::remove_all(folder / path); };
}

void ExpectRefused(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    const ScratchFolder folder;
    const fs::path sequence = WritePosterSequence(folder, 12);
    fault.spoil(folder);
    const std::string arguments =
        std::regex_replace(fault.arguments, std::regex("FOLDER"), folder.path().string());
    const Outcome outcome = RunProgram(
        folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / "out") + arguments);
    ExpectRefused(outcome, fault.message, fault.what);
    EXPECT_FALSE(fs::exists(folder / "out")) << fault.what;
  }
}

TEST(BadInput, FilesThatAreMissing) {
  ExpectRefused(
      {{"nothing at the path", Remove("sequence"), "sequence: no such file or folder"},
       {"empty folder",
        [](const ScratchFolder& folder) {
          fs::remove_all(folder / "sequence");
          fs::create_directories(folder / "sequence");
        },
        "sequence: expected a EuRoC folder (mav0/), a TUM or ICL folder (rgb.txt), a KITTI "
        "sequence (image_0/, calib.txt) or a drive of KITTI raw (image_00/timestamps.txt), a "
        "folder "
        "of ros2 bag (.db3, .mcap) or a folder of images, found none of them"},
       {"no calibration",
        Remove("sequence/mav0/cam0/sensor.yaml"),
        "mav0/cam0/sensor.yaml: no such file"},
       {"no calibration of the right camera",
        Remove("sequence/mav0/cam1/sensor.yaml"),
        "mav0/cam1/sensor.yaml: no such file"},
       {"a calibration of one camera",
        Put("sequence/camera.yaml", "size: [400, 300]\nintrinsics: [300, 300, 200, 150]\n"),
        "sequence/camera.yaml: expected a stereo camera, found one camera"},
       {"no list", Remove(kLeftList), "cam0/data.csv: no such file"},
       {"no left images",
        Remove("sequence/mav0/cam0/data"),
        "sequence: expected images, found none of the 12 listed"},
       {"no right images",
        Remove("sequence/mav0/cam1/data"),
        "sequence: expected right images, found none of the 12 listed"},
       {"no right camera",
        Remove("sequence/mav0/cam1"),
        "sequence: expected data for stereo, found data for mono only",
        " --sensor stereo"},
       {"an unknown format",
        Remove("none"),
        "--format: expected euroc, tum, kitti, images, video, bag, mcap or rosbag2, found stream",
        " --format stream"}});
}

TEST(BadInput, FilesThatAreBroken) {
  const std::string row = "1000000000,0.png\n";
  ExpectRefused(
      {{"calibration that is none",
        Put("sequence/mav0/cam0/sensor.yaml", "resolution: [400\n"),
        "cam0/sensor.yaml:2: expected YAML"},
       {"calibration without a key",
        Put("sequence/mav0/cam0/sensor.yaml", "camera_model: pinhole\n"),
        "cam0/sensor.yaml:1: distortion_model: expected a value, found none"},
       {"a row cut off",
        Put(kLeftList, "#t,f\n" + row + "1050000000\n"),
        "cam0/data.csv:3: expected a time stamp and a file name, found 1 columns"},
       {"a row without a time",
        Put(kLeftList, row + "now,1.png\n"),
        "cam0/data.csv:2: expected a time stamp in whole nanoseconds, found 'now'"},
       {"a ground truth that was asked for and is not there",
        [](const ScratchFolder&) {},
        "none.txt: no such file",
        " --ground-truth FOLDER/none.txt"},
       {"a ground truth that was asked for and has no pose",
        Put("truth.txt", "1,2,3\n"),
        "truth.txt:1: expected at least 8 columns",
        " --ground-truth FOLDER/truth.txt"},
       {"images that are none",
        [](const ScratchFolder& folder) {
          for (int i = 0; i < 12; ++i) {
            folder.Write("sequence/mav0/cam0/data/" + std::to_string(i) + ".png", "text");
          }
        },
        "sequence: expected images, found none of 12 that can be read: "},
       {"images of another size than the calibration's",
        Put("sequence/camera.yaml",
            "size: [640, 480]\nintrinsics: [300, 300, 200, 150]\nrectified: true\nbaseline: 0.1\n"),
        "cam0/data/0.png: expected an image of 640x480 pixels as in the calibration, found "
        "400x300"}});
}

TEST(BadInput, OptionsThatAreWrong) {
  const auto nothing = [](const ScratchFolder&) {};
  ExpectRefused(
      {{"an unknown flag",
        nothing,
        "unknown option --stide; the nearest is --stride",
        " --stide 2"},
       {"an unknown option",
        nothing,
        "--set tracking.min_initials=50: unknown option 'tracking.min_initials'; did you mean "
        "'tracking.min_initial'?",
        " --set tracking.min_initials=50"},
       {"a word for a number",
        nothing,
        "tracking.min_initial: expected a whole number",
        " --set tracking.min_initial=many"},
       {"a number out of range",
        nothing,
        "tracking.min_initial: expected a whole number",
        " --set tracking.min_initial=-3"},
       {"a word that is no choice",
        nothing,
        "features.line_detector: expected one of drawing | ",
        " --set features.line_detector=lds"},
       {"a setting without a value",
        nothing,
        "--set: expected KEY=VALUE, found 'features.points'",
        " --set features.points"},
       {"an unknown key in a file",
        Put("sequence/options.yaml", "features:\n  points: true\n  pionts: true\n"),
        "options.yaml:3: unknown option 'features.pionts'; did you mean 'features.points'?",
        " --config FOLDER/sequence/options.yaml"},
       {"a file of options that is missing", nothing, "none.yaml", " --config none.yaml"},
       {"an unknown camera", nothing, "eurok: no such camera file; built-in", " --camera eurok"},
       {"frames beyond the end", nothing, "--from 12: the sequence has 12 frames", " --from 12"},
       {"a mode that is not there",
        nothing,
        "slam.mode: expected one of inline | ",
        " --mode outline"},
       {"half a frame",
        nothing,
        "--stride: expected a whole number from 1 to 1000000000, found 0.5",
        " --stride 0.5"},
       {"a filter wider than any image",
        nothing,
        "--blur: expected a whole number from 1 to 1001, found 2147483647",
        " --blur 2147483647"},
       {"more frames than there are",
        nothing,
        "--to: expected a whole number from 1 to 1000000000, found 99999999999999999999",
        " --to 99999999999999999999"},
       {"a seed out of range",
        nothing,
        "slam.seed: expected a whole number, 0 to 2147483647, found '2147483648'",
        " --seed 2147483648"},
       {"a name that is empty",
        nothing,
        "--config: expected FILE, found an empty argument",
        " --config ''"},
       {"a file of options without any",
        Put("sequence/options.yaml", ""),
        "options.yaml: expected options as 'key: value', found an empty file",
        " --config FOLDER/sequence/options.yaml"},
       {"an option that comes twice",
        Put("sequence/options.yaml", "slam:\n  seed: 1\n  seed: 2\n"),
        "options.yaml:3: expected each key once, found 'seed' again, which is in line 2, too",
        " --config FOLDER/sequence/options.yaml"},
       {"two documents",
        Put("sequence/options.yaml", "slam:\n  seed: 1\n---\nslam:\n  seed: 2\n"),
        "expected one YAML document, found a second one",
        " --config FOLDER/sequence/options.yaml"},
       {"neither points nor lines",
        nothing,
        "features.points, features.lines: expected at least one of them, found both off",
        " --set features.points=false --set features.lines=false"},
       {"a sensor that is not there",
        nothing,
        "expected data for rgbd, found data for stereo, mono only",
        " --sensor rgbd"}});
}

TEST(BadInput, OptionsOfEarlierVersions) {
  ExpectRefused(
      {{"what is fixed now, set",
        [](const ScratchFolder&) {},
        "--set mapping.ba.rounds=2: mapping.ba.rounds is no option any more: it is fixed at 2",
        " --set mapping.ba.rounds=2"},
       {"a file with another value",
        Put("my.yaml", "mapping:\n  creation: {neighbours: 6}\n  ba:\n    rounds: 3\n"),
        "my.yaml:4: mapping.ba.rounds is no option any more: it is fixed at 2",
        " --config FOLDER/my.yaml"}});
}

std::string Pair(const std::string& intrinsics, const std::string& more) {
  return "size: [400, 300]\nintrinsics: [" + intrinsics + "]\nrectified: true\n" + more;
}

TEST(BadInput, CalibrationsThatCannotBe) {
  const std::string camera = "sequence/camera.yaml";
  const std::string good = "300, 300, 200, 150", base = "baseline: 0.1\n";
  const std::string right = "right: {size: [400, 300], intrinsics: [" + good + "]}\n";
  const std::string sensor = "sequence/mav0/cam1/sensor.yaml";
  const auto turned = [&](const std::string& from, const std::string& to) {
    return [=](const ScratchFolder& folder) {
      std::string text = Contents(folder / sensor);
      text.replace(text.find(from), from.size(), to);
      folder.Write(sensor, text);
    };
  };
  ExpectRefused(
      {{"no baseline",
        Put(camera, Pair(good, "baseline: 0\n")),
        "camera.yaml:4: baseline: expected a number above 0, found '0'"},
       {"hardly any",
        Put(camera, Pair(good, "baseline: 1e-9\n")),
        "camera.yaml:4: baseline: expected a baseline from 0.0001 to 1000 m, found 1e-09"},
       {"one of light years",
        Put(camera, Pair(good, "baseline: 1e30\n")),
        "camera.yaml:4: baseline: expected a baseline from 0.0001 to 1000 m, found 1e+30"},
       {"a vertical pair",
        Put(camera,
            Pair(good, right + "right_from_left: [1,0,0,0, 0,1,0,-0.1, 0,0,1,0, 0,0,0,1]\n")),
        "camera.yaml:5: right_from_left: expected "},
       {"a pair that is exchanged",
        Put(camera,
            Pair(good, right + "right_from_left: [1,0,0,0.1, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n")),
        "camera.yaml:5: right_from_left: expected "},
       {"cameras in one place",
        turned("[1,0,0,", "[1,0,0,-9"),
        "cam1/sensor.yaml:2: T_BS: expected the right camera to the right (+x) of the left one"},
       {"a focal length that overflows",
        Put(camera, Pair("1e300, 300, 200, 150", base)),
        "camera.yaml:2: intrinsics: expected fx from 4 to 400000 px, found 1e+300"},
       {"one that is nothing",
        Put(camera, Pair("1e-300, 300, 200, 150", base)),
        "camera.yaml:2: intrinsics: expected fx from 4 to 400000 px, found 1e-300"},
       {"a rate without end",
        Put(camera, Pair(good, base + "rate_hz: 1e300\n")),
        "camera.yaml:5: rate_hz: expected a rate from 0.0001 to 100000 Hz, found 1e+300"},
       {"a rate of nothing",
        Put(camera, Pair(good, base + "rate_hz: 1e-300\n")),
        "camera.yaml:5: rate_hz: expected a rate from 0.0001 to 100000 Hz, found 1e-300"}});
}

// Input reaches the terminal in one line without commands to it, and not a megabyte of it.
TEST(BadInput, InputIsRepeatedPrintableAndShort) {
  const ScratchFolder folder;
  const std::string megabyte(100'000, 'x');
  const std::string red = "\x1b[31m\x1b]0;title\x07\n";
  const auto file = [&](const std::string& contents) {
    return Quoted(folder.Write("bad", contents));
  };
  fs::create_directories(folder / "a\x1b[2J\nb");
  for (const std::string& arguments :
       {"run " + Quoted("/" + red),
        "run " + Quoted(folder / "a\x1b[2J\nb"),
        "run /none --sensor " + Quoted(red + megabyte),
        "run /none --" + megabyte,
        "run /" + megabyte,
        Quoted(red),
        megabyte,
        "config --set " + Quoted(red + "=1"),
        "config --set slam.seed=" + megabyte,
        "config --set " + megabyte + "=1",
        "config --config " + file("slam: {seed: \"\\e[31m" + megabyte + "\"}\n"),
        "config --config " + file("\"\\e[31m\\n" + megabyte + "\": 1\n"),
        "config --config " + file(std::string("a: \0\x1b[31m]", 10)),
        "evaluate " + file(red + megabyte + " 0 0 0 0 0 0 1\n") + " /none"}) {
    const Outcome outcome = RunProgram(folder, arguments);
    ExpectRefused(outcome, "", arguments.substr(0, 60));
    EXPECT_LT(outcome.err.size(), 2200U);
    const bool printable = std::all_of(outcome.err.begin(), outcome.err.end() - 1, [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
    });
    EXPECT_TRUE(printable) << outcome.err;
  }
}

// Nothing is waited for, and libraries say nothing of their own.
TEST(BadInput, FilesThatAreNoneOrNotWhatTheySeem) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const fs::path video =
      folder.Write("video.mp4", std::string("\0\0\0\x18", 4) + "ftypmp42" + std::string(2000, 'x'));
  const std::string pipe = Quoted(folder / "pipe");
  const std::string found = "pipe: expected a file, found a pipe";
  ExpectRefused(RunProgram(folder, "run " + pipe), "found a pipe", "a pipe as data");
  ExpectRefused(RunProgram(folder, "info " + pipe), "found a pipe", "a pipe to look at");
  ExpectRefused(RunProgram(folder, "config --config " + pipe), found, "a pipe of options");
  ExpectRefused(RunProgram(folder, "run / --format images --camera " + pipe), found, "a camera");
  ExpectRefused(RunProgram(folder, "evaluate " + pipe + " " + pipe), found, "trajectories");
  ExpectRefused(RunProgram(folder, "config --config /dev/zero"), "found a device", "a device");
  ExpectRefused(RunProgram(folder, "run " + Quoted(video) + " --camera tum_fr1"),
                "video.mp4: expected a folder or a video, found a file that cannot be decoded",
                "a video without frames");
}

TEST(BadInput, OutputThatCannotBeWritten) {
  const ScratchFolder folder;
  const std::string run = "run " + Quoted(WritePosterSequence(folder, 2)) + " --out ";
  const fs::path file = folder.Write("file", "text");
  ExpectRefused(RunProgram(folder, run + Quoted(file)),
                "cannot make the folder " + file.string(),
                "a file of this name");
  ExpectRefused(RunProgram(folder, run + Quoted(file / "below")),
                "cannot make the folder " + (file / "below").string() + ": Not a directory",
                "below a file");
  ExpectRefused(RunProgram(folder, run + "/proc/plumbline"),
                "cannot make the folder /proc/plumbline: No such file or directory",
                "a file system that takes no folders");
  ExpectRefused(RunProgram(folder,
                           "evaluate " + Quoted(folder / kTruth) + " " + Quoted(folder / kTruth) +
                               " --reference-frame camera --json " + Quoted(file / "x.json")),
                "cannot write " + (file / "x.json").string() + ": Not a directory",
                "a table below a file");
  EXPECT_EQ(Contents(file), "text");
  if (::geteuid() == 0) return;  // root may write anywhere
  fs::create_directories(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  ExpectRefused(
      RunProgram(folder, run + Quoted(folder / "locked")), "Permission denied", "no permission");
}

TEST(BadInput, MoreThanOneCommandKnows) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const fs::path empty = folder.Write("empty.txt", "");
  const fs::path late = folder.Write("late.txt", "9.0 0 0 0 0 0 0 1\n9.1 0 0 0 0 0 0 1\n");
  fs::create_directories(folder / "nothing");
  const std::string evaluate = "evaluate " + Quoted(sequence) + " ";
  ExpectRefused(RunProgram(folder, evaluate + Quoted(folder / "none.txt")),
                "none.txt: no such file",
                "no estimate");
  ExpectRefused(RunProgram(folder, evaluate + Quoted(empty)),
                "empty.txt: expected poses, found no rows",
                "an empty estimate");
  ExpectRefused(RunProgram(folder, evaluate + Quoted(late)),
                "no pose of the estimate has a reference pose at its time: the reference covers "
                "1.000000000 to 1.550000000, the estimate 9.000000000 to 9.100000000",
                "another time");
  ExpectRefused(RunProgram(folder, "evaluate " + Quoted(folder / "nothing") + " " + Quoted(late)),
                "nothing: expected ground truth (mav0/state_groundtruth_estimate0/data.csv, "
                "groundtruth.txt, poses.txt or KITTI's ../../poses/NUMBER.txt), found none",
                "no ground truth");
  ExpectRefused(RunProgram(folder, "evaluate " + Quoted(sequence)), "expected ESTIMATE", "one");
  ExpectRefused(RunProgram(folder, "info " + Quoted(folder / "nothing")),
                "nothing: expected a EuRoC",
                "info");
  ExpectRefused(RunProgram(folder, "run / --out -"), "--out: expected a folder, found -", "-");
  ExpectRefused(RunProgram(folder, "rum"), "unknown command 'rum'; did you mean 'run'?", "rum");
  ExpectRefused(RunProgram(folder, "config --preset riple"),
                "preset: expected good-line-cutting or rippl, found 'riple'",
                "config");
  ExpectRefused(RunProgram(folder, "config --set features.pionts=false"),
                "did you mean 'features.points'?",
                "config");
}

}  // namespace
}  // namespace plumbline
