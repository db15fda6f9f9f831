// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// What is wrong with data and does not refuse a run: it is told, and left out where it cannot be
// used. What is left may be too little for a pose.
#include "plumbline/base/crc32.h"
#include "plumbline/io/export/png.h"

#include "tests/e2e/poster_run.h"
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace tolerated_input_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kLeftList = "sequence/mav0/cam0/data.csv";
const std::string kLeftImage = "sequence/mav0/cam0/data/0.png";
const std::string kTruth = "sequence/mav0/state_groundtruth_estimate0/data.csv";

// What the data lacks but a run does not need.
TEST(ToleratedInput, ARunGoesOnWithoutGroundTruth) {
  struct Case {
    std::optional<std::string> truth;  // nullopt: the file is removed
    std::string said;
  };
  const std::vector<Case> cases = {{std::nullopt, "no errors: no ground truth to compare with"},
                                   {"9000000000,0,0,0,1,0,0,0\n9050000000,0,0,0,1,0,0,0\n",
                                    "no errors: the ground truth covers fewer than three poses"},
                                   {"1000000000,0,0,0,1,0,0,0\n1050000000,0.1,0,0,1,0,0,0\n",
                                    "no errors: the ground truth covers fewer than three poses"}};
  for (const Case& c : cases) {
    const ScratchFolder folder;
    const fs::path sequence = WritePosterSequence(folder, 6);
    if (c.truth) {
      folder.Write(kTruth, *c.truth);
    } else {
      fs::remove(folder / kTruth);
    }
    const Outcome outcome =
        RunProgram(folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / "out"));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("frames 6: 6 tracked"));
    EXPECT_THAT(outcome.out, HasSubstr(c.said));
    const auto summary = nlohmann::json::parse(Contents(folder / "out/summary.json"));
    EXPECT_TRUE(summary["accuracy"].is_null());
  }
}

// The ground truth is optional: what is wrong with it is said once, and refuses nothing.
TEST(ToleratedInput, AFaultOfTheGroundTruthIsSaidOnce) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  const std::string run = "run " + Quoted(sequence) + " --out " + Quoted(folder / "out");
  for (const auto& [content, fault] : std::vector<std::pair<std::string, std::string>>{
           {"1000000000,1,2,3,1,0\n", ":1: expected at least 8 columns"},
           {"1000000000 1 2 3 1 0 0 0 9\n", ":1: expected 8 columns (TUM)"},
           {"1000000000,1,2,3,1,1,0,0\n", ":1: expected a unit quaternion, found one of norm"},
           {"timestamp,x,y,z,qw,qx,qy,qz\n", ":1: expected a time stamp in whole nanoseconds"},
           {"", ": expected poses, found no rows"}}) {
    const fs::path truth = folder.Write(kTruth, content);
    const std::string message = truth.string() + fault;
    const Outcome outcome = RunProgram(folder, run);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("frames 6: 6 tracked"));
    EXPECT_THAT(outcome.err, HasSubstr("plumbline: no errors: " + message));
    const std::string said = outcome.out + outcome.err;
    EXPECT_EQ(said.find("no errors"), said.rfind("no errors")) << said;
    const auto summary = nlohmann::json::parse(Contents(folder / "out/summary.json"));
    EXPECT_TRUE(summary["accuracy"].is_null());
    EXPECT_THAT(summary["no_errors"].get<std::string>(), StartsWith(message));
    EXPECT_THAT(Contents(folder / "out/report.html"),
                HasSubstr("\"ground_truth_fault\":\"" + message));
    const Outcome info = RunProgram(folder, "info " + Quoted(sequence));
    EXPECT_EQ(info.code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr("ground truth  cannot be used: " + message));
    ExpectRefusal(RunProgram(folder, "evaluate " + Quoted(sequence) + " " + Quoted(folder / "out")),
                  message);
  }
  const Outcome images =
      RunProgram(folder,
                 "map export " + Quoted(folder / "out/map.plb") + " --to colmap --images " +
                     Quoted(sequence) + " --out " + Quoted(folder / "colmap"));
  EXPECT_EQ(images.code, 0) << images.err;
}

// Rows of a reference that cannot be used are left out and told; the errors are those of the
// others.
TEST(ToleratedInput, FramesWithABlackMaskAreSkippedAndTold) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const GrayImage image = MovingPoster().Frame(0).left;
  fs::create_directory(sequence / "mask0");
  for (const int frame : {4, 5, 6, 7}) {
    const std::uint8_t level = frame == 4 || frame == 5 ? 0 : 255;
    WriteGrayPng(sequence / fmt::format("mask0/{}.png", frame),
                 GrayImage(image.width(), image.height(), level));
  }
  const Outcome run =
      RunProgram(folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("4 of the 12 images of the data have a mask in "));
  EXPECT_THAT(run.err, HasSubstr("2 frames left out, since their masks are all black"));
  EXPECT_THAT(Contents(folder / "out/frames.csv"), HasSubstr("skipped,,mask_black,"));
  const auto summary = nlohmann::json::parse(Contents(folder / "out/summary.json"));
  EXPECT_THAT(summary["notes"].dump(), HasSubstr("2 frames left out"));
}

TEST(ToleratedInput, RowsOfTheGroundTruthAreLeftOut) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  const std::string arguments = Quoted(sequence) + " --out " + Quoted(folder / "out");
  ASSERT_EQ(RunProgram(folder, "run " + arguments).code, 0);
  const auto summary = [&] { return nlohmann::json::parse(Contents(folder / "out/summary.json")); };
  const auto accuracy = summary()["accuracy"];
  const std::string good = Contents(folder / kTruth);
  const std::string first = good.substr(good.find('\n') + 1);
  const fs::path truth =
      folder.Write(kTruth, good + first.substr(0, first.find('\n') + 1) + "1900000000,nan,0\n");
  const Outcome outcome = RunProgram(folder, "run " + arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string line =
      truth.string() + ":" + std::to_string(1 + std::count(good.begin(), good.end(), '\n'));
  EXPECT_THAT(outcome.err,
              HasSubstr("plumbline: " + line + ": 1 row goes back in time and is left out\n"));
  EXPECT_THAT(outcome.err, HasSubstr("3 columns; this row is left out\n"));
  EXPECT_THAT(outcome.out, HasSubstr("ATE "));
  EXPECT_EQ(summary()["accuracy"], accuracy);
  EXPECT_TRUE(summary()["no_errors"].is_null());
  EXPECT_EQ(summary()["notes"].size(), 2U);
  const Outcome evaluated =
      RunProgram(folder, "evaluate " + Quoted(sequence) + " " + Quoted(folder / "out"));
  EXPECT_EQ(evaluated.code, 0) << evaluated.err;
  EXPECT_THAT(evaluated.err, HasSubstr(line + ": 1 row goes back in time and is left out\n"));
  // Another file in its place, and none.
  const fs::path own = folder.Write("own.csv", good);
  const Outcome other = RunProgram(folder, "run " + arguments + " --ground-truth " + Quoted(own));
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(other.err, testing::Not(HasSubstr("left out")));
  EXPECT_EQ(summary()["accuracy"], accuracy);
  const Outcome none = RunProgram(folder, "run " + arguments + " --ground-truth none");
  EXPECT_THAT(none.out, HasSubstr("no errors: no ground truth to compare with\n"));
  EXPECT_TRUE(summary()["accuracy"].is_null());
}

// A recorder that stutters writes rows again or late; the frames are those of the good list.
TEST(ToleratedInput, RepeatedAndLateRowsOfAListRefuseNothing) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  const std::string run = "run " + Quoted(sequence) + " --out ";
  ASSERT_EQ(RunProgram(folder, run + Quoted(folder / "good")).code, 0);
  std::vector<std::string> rows;
  std::istringstream list(PosterList(6));
  for (std::string row; std::getline(list, row);) rows.push_back(row + "\n");
  const std::size_t at = rows.size() - 3;
  rows.insert(rows.begin() + static_cast<std::ptrdiff_t>(at), rows[at - 1]);
  std::swap(rows[rows.size() - 2], rows[rows.size() - 1]);
  std::string text;
  for (const std::string& row : rows) text += row;
  folder.Write(kLeftList, text);
  const Outcome outcome = RunProgram(folder, run + Quoted(folder / "out"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("cam0/data.csv:" + std::to_string(at + 1) +
                        ": 1 row repeats a time stamp and is left out\n"));
  EXPECT_THAT(outcome.err, HasSubstr(": 1 row goes back in time and is sorted in\n"));
  EXPECT_EQ(Contents(folder / "out/trajectory.txt"), Contents(folder / "good/trajectory.txt"));
}

TEST(ToleratedInput, UnreadableImagesAndMissingPartnersAreNamedAndLeftOut) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 8);
  folder.Write(kLeftImage, "not an image");
  fs::remove(folder / "sequence/mav0/cam1/data/3.png");
  std::string right = PosterList(8);
  right.erase(right.find("1250000000"), std::string("1250000000,5.png\n").size());
  folder.Write("sequence/mav0/cam1/data.csv", right);
  const Outcome outcome =
      RunProgram(folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / "out"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("plumbline: 1 left images without a right one are left out\n"));
  EXPECT_THAT(outcome.err, HasSubstr("plumbline: 1 of 7 right images do not exist\n"));
  EXPECT_THAT(outcome.err,
              HasSubstr("frame 0 skipped: " + (folder / kLeftImage).string() +
                        ": not an image this program can decode\n"));
  EXPECT_THAT(outcome.err, HasSubstr("cam1/data/3.png: no such file\n"));
  EXPECT_THAT(outcome.out, HasSubstr("frames 7: 5 tracked, 0 lost, 2 skipped"));
  // Numbers count the frames as played, in messages, tables and names of files.
  const Outcome played = RunProgram(
      folder,
      "run " + Quoted(sequence) + " --from 1 --stride 2 --out " + Quoted(folder / "played"));
  EXPECT_EQ(played.code, 0) << played.err;
  EXPECT_THAT(played.err, HasSubstr("frame 1 skipped: "));
  EXPECT_THAT(Contents(folder / "played/frames.csv"), HasSubstr("\n1,1.150000000,skipped,"));
  EXPECT_TRUE(fs::exists(folder / "played/overlay_000002.png"));
  EXPECT_FALSE(fs::exists(folder / "played/overlay_000005.png"));
}

// A PNG file whose compressed data are damaged, with the checksum of what it holds.
std::string WithDamagedData(std::string png) {
  const std::size_t type = png.find("IDAT");
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(png.data());
  std::size_t length = 0;
  for (std::size_t i = type - 4; i < type; ++i) length = (length << 8) | bytes[i];
  for (std::size_t i = 0; i < 8; ++i) png[type + 4 + length / 2 + i] = '\xFF';
  const std::uint32_t crc = Crc32({bytes + type, length + 4});
  for (std::size_t i = 0; i < 4; ++i) {
    png[type + 4 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
  }
  return png;
}

// The libraries that decode them write to standard error as well: one through std::cerr, one
// through the stream of C.
TEST(ToleratedInput, ADamagedImageIsOneLine) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 8);
  folder.Write("sequence/mav0/cam0/data/3.png", "P5\n400 300\n255\nfew");
  const std::string other = "sequence/mav0/cam0/data/5.png";
  folder.Write(other, WithDamagedData(Contents(folder / other)));
  const std::string run = "run " + Quoted(sequence) + " --quiet --out " + Quoted(folder / "out");
  const Outcome outcome = RunProgram(folder, run);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("plumbline: frame 3 skipped: "));
  EXPECT_THAT(outcome.err, HasSubstr("\nplumbline: frame 5 skipped: "));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  // Dropped messages are shown if the environment asks for them.
  const Outcome all = RunProgram(folder, run, "OPENCV_LOG_LEVEL=ERROR ");
  EXPECT_THAT(all.err, HasSubstr("imdecode_"));
  EXPECT_THAT(all.err, HasSubstr("libpng"));
}

// Results that exist are written, but nobody may take them for a map.
TEST(ToleratedInput, ARunWithoutAnyPoseFails) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 6);
  const auto run = [&](const std::string& out) {
    return RunProgram(folder, "run " + Quoted(sequence) + " --out " + Quoted(folder / out));
  };
  ASSERT_EQ(run("kept").code, 0);
  const std::string earlier = Contents(folder / "kept/trajectory.txt");
  for (const char* camera : {"cam0", "cam1"}) {
    for (int i = 0; i < 6; ++i) {
      WriteGrayPng(folder / fmt::format("sequence/mav0/{}/data/{}.png", camera, i),
                   GrayImage(MovingPoster::kWidth, MovingPoster::kHeight, 0));
    }
  }
  const Outcome dark = run("dark");
  EXPECT_EQ(dark.code, 1);
  EXPECT_THAT(dark.err,
              HasSubstr("plumbline: no frame has a pose: too few points and lines are seen, or too "
                        "few with depth (too_few_features) in 6 of 6 frames"));
  EXPECT_THAT(dark.out, HasSubstr("frames 6: 0 tracked"));
  EXPECT_TRUE(fs::exists(folder / "dark/frames.csv"));
  EXPECT_TRUE(fs::exists(folder / "dark/summary.json"));
  // The poses of an earlier run are not replaced by none.
  const Outcome again = run("kept");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err,
              HasSubstr("kept keeps the results of an earlier run, which has more poses; "));
  EXPECT_EQ(Contents(folder / "kept/trajectory.txt"), earlier);
  EXPECT_TRUE(fs::exists(folder / "kept/.part/summary.json"));
  for (int i = 1; i < 6; ++i) {
    folder.Write(fmt::format("sequence/mav0/cam1/data/{}.png", i), "gone");
  }
  const Outcome gone = run("gone");
  EXPECT_EQ(gone.code, 1);
  EXPECT_THAT(
      gone.err,
      HasSubstr(
          "no frame has a pose: the image cannot be read (image_unreadable) in 5 of 6 frames\n"));
}

TEST(ToleratedInput, ACameraThatStandsStillIsTold) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 8);
  for (int i = 1; i < 8; ++i) {
    fs::copy_file(folder / kLeftImage,
                  folder / fmt::format("sequence/mav0/cam0/data/{}.png", i),
                  fs::copy_options::overwrite_existing);
  }
  const Outcome still = RunProgram(
      folder, "run " + Quoted(sequence) + " --sensor mono --out " + Quoted(folder / "out"));
  EXPECT_EQ(still.code, 1);
  EXPECT_THAT(still.err,
              HasSubstr("plumbline: no frame has a pose: the camera moves too little sideways "
                        "(too_little_parallax) in "));
}

TEST(ToleratedInput, DepthThatIsZeroEverywhereIsTold) {
  const ScratchFolder folder;
  const MovingPoster poster;
  std::string images, depths;
  for (const char* kind : {"rgb", "depth"}) fs::create_directories(folder / "tum" / kind);
  for (int i = 0; i < 12; ++i) {
    WriteGrayPng(folder / fmt::format("tum/rgb/{}.png", i), poster.Frame(i).left);
    WriteDepthPng(folder / fmt::format("tum/depth/{}.png", i),
                  DepthImage(MovingPoster::kWidth, MovingPoster::kHeight, 0),
                  5000);
    images += fmt::format("{:.2f} rgb/{}.png\n", 1 + 0.05 * i, i);
    depths += fmt::format("{:.2f} depth/{}.png\n", 1 + 0.05 * i, i);
  }
  folder.Write("tum/rgb.txt", images);
  folder.Write("tum/depth.txt", depths);
  const fs::path camera = folder.Write("camera.yaml",
                                       "size: [400, 300]\nintrinsics: [300, 300, 200, 150]\n"
                                       "depth_factor: 5000\n");
  const Outcome outcome = RunProgram(folder,
                                     "run " + Quoted(folder / "tum") + " --camera " +
                                         Quoted(camera) + " --out " + Quoted(folder / "out"));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("depth is zero everywhere in the first 10 depth images"));
  EXPECT_THAT(outcome.err,
              HasSubstr("(too_few_features) in 12 of 12 frames; depth is zero everywhere\n"));
}

TEST(ToleratedInput, AnInertialSensorThatIsNotUsedIsTold) {
  const ScratchFolder folder;
  const fs::path sequence = WritePosterSequence(folder, 12);
  const auto run = [&](const std::string& imu) {
    return RunProgram(folder,
                      "run " + Quoted(sequence) + " " + imu + " --out " + Quoted(folder / "out"));
  };
  EXPECT_THAT(run("").err, testing::Not(HasSubstr("inertial")));
  const Outcome without = run("--imu auto");
  EXPECT_EQ(without.code, 0) << without.err;
  EXPECT_THAT(without.err, HasSubstr("--imu auto: the data have no samples"));
  // Samples of another day.
  folder.Write("sequence/mav0/imu0/data.csv",
               "1,0,0,0,0,0,9.81\n5000001,0,0,0.01,0,0,9.81\n10000001,0,0,0,0,0,9.81\n");
  const fs::path imu = folder.Write(
      "imu.yaml", "imu:\n  imu_from_left: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  EXPECT_THAT(run("").err, HasSubstr("the inertial sensor is left out: "));
  EXPECT_THAT(run("--preset good-line-cutting").err, testing::Not(HasSubstr("inertial")));
  const Outcome elsewhere = run("--imu " + Quoted(imu));
  EXPECT_EQ(elsewhere.code, 0) << elsewhere.err;
  EXPECT_THAT(elsewhere.err, HasSubstr("not used, as no turn between frames was covered"));
  EXPECT_THAT(elsewhere.err, HasSubstr("; frames from "));
  EXPECT_THAT(run("--to 1 --imu " + Quoted(imu)).err,
              HasSubstr("not used, as too few frames were tracked: 1 of 1\n"));
}

}  // namespace tolerated_input_test
}  // namespace plumbline
