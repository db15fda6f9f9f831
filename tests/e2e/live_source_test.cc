// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/png.h"

#include "tests/e2e/euroc_frames.h"
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/e2e/same_run.h"
#include "tests/support/data_folder.h"
#include "tests/support/moving_poster.h"
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// With the damaged image of the sequence, of frame 163.
constexpr std::pair<std::size_t, std::size_t> kFrames = {155, 175};

std::string Header(int width, int height) {
  return fmt::format(
      "plumbline frames 1\nleft mono8 {0} {1}\nright mono8 {0} {1}\nend\n", width, height);
}

// Frames of a EuRoC folder as somebody sends them who could not decode one of the images.
std::vector<std::string> SentFrames(const std::filesystem::path& sequence) {
  std::vector<std::string> frames;
  std::string left;
  ForEachEurocImage(sequence, kFrames, [&](const EurocImage& image) {
    if (image.camera == 0) {
      left = image.readable ? image.bytes : "";
      return;
    }
    frames.push_back(left.empty() || !image.readable
                         ? fmt::format("missing {}\n", image.stamp_ns)
                         : fmt::format("frame {}\n", image.stamp_ns) + left + image.bytes);
  });
  return frames;
}

// Runs the program on what is written into its standard input, piece by piece at a rate.
Outcome RunFed(const ScratchFolder& folder,
               const std::string& arguments,
               const std::vector<std::string>& pieces,
               std::chrono::milliseconds interval) {
  const std::filesystem::path pipe = folder / "pipe";
  if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
  std::signal(SIGPIPE, SIG_IGN);  // of a program that reads no more
  std::thread writer([&] {
    std::ofstream out(pipe, std::ios::binary);
    for (const std::string& piece : pieces) {
      out << piece << std::flush;
      std::this_thread::sleep_for(interval);
    }
  });
  const Outcome outcome = RunProgram(folder, arguments + " < " + Quoted(pipe));
  writer.join();
  std::filesystem::remove(pipe);
  return outcome;
}

// The frames of SentFrames, each behind the samples that a run on the folder gives it.
std::vector<std::string> SentWithSamples(const std::filesystem::path& sequence) {
  const std::vector<TextRow> rows = ReadRows(sequence / "mav0/imu0/data.csv", ',');
  std::vector<std::string> pieces = SentFrames(sequence);
  std::size_t next = 0;
  for (std::string& piece : pieces) {
    constexpr std::int64_t kMore = 20'000'000;
    const std::int64_t stamp = std::stoll(piece.substr(piece.find(' ') + 1));
    std::string samples;
    for (; next < rows.size() && std::stoll(rows[next].fields[0]) <= stamp + kMore; ++next) {
      samples += fmt::format("imu {}\n", fmt::join(rows[next].fields, " "));
    }
    piece.insert(0, samples);
  }
  return pieces;
}

TEST(RunLive, GivesTheBytesOfTheFolderFromAPipeWithAnInertialSensor) {
  const auto data = FindData("euroc/MH_01_easy_first250");
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  // EuRoC's own numbers, in one file for both.
  const auto imu = folder.Write(
      "imu.yaml",
      "imu:\n  imu_from_left: [0.0148655, -0.999881, 0.0041403, -0.0216401, 0.999557, 0.0149672, "
      "0.025715, -0.0646770, -0.0257744, 0.00375619, 0.999661, 0.00981073, 0, 0, 0, 1]\n"
      "  gyroscope_noise_density: 1.6968e-04\n  gyroscope_random_walk: 1.9393e-05\n"
      "  accelerometer_noise_density: 2.0e-3\n  accelerometer_random_walk: 3.0e-3\n"
      "  rate_hz: 200\n  time_offset: 0\n");
  std::vector<std::string> pieces = SentWithSamples(*data);
  pieces.insert(pieces.begin(),
                "plumbline frames 1\nleft mono8 752 480\nright mono8 752 480\nimu\nend\n");
  const Outcome fed = RunFed(
      folder,
      fmt::format("run - --camera euroc --imu {} --out {}", Quoted(imu), Quoted(folder / "fed")),
      pieces,
      std::chrono::milliseconds(0));
  ASSERT_EQ(fed.code, 0) << fed.err;
  const auto run = [&](const std::string& name,
                       const std::string& options,
                       const std::filesystem::path& sequence) {
    const Outcome outcome =
        RunProgram(folder,
                   fmt::format("run {} --from {} --to {} --camera euroc {} --out {}",
                               Quoted(sequence),
                               kFrames.first,
                               kFrames.second,
                               options,
                               Quoted(folder / name)));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto says = [&](const std::string& text) {
      return text.find(" turns used; found beyond its calibration: bias ") != std::string::npos;
    };
    const bool used = name == "folder" || name == "inline";
    EXPECT_EQ(says(outcome.out), used) << outcome.out;
    EXPECT_EQ(says(Contents(folder / name / "report.html")), used) << name;
  };
  run("folder", "--imu " + Quoted(imu), *data);
  ExpectSameResults(folder / "folder", folder / "fed");
  const auto summary = nlohmann::json::parse(Contents(folder / "fed/summary.json"));
  EXPECT_GE(summary["inertial"]["turns"], 15);
  run("inline", "--mode inline --imu " + Quoted(imu), *data);
  ExpectSameResults(folder / "folder", folder / "inline");
  // The sensor makes a difference; off is as if there were none.
  std::filesystem::create_directories(folder / "without/mav0");
  for (const char* part : {"cam0", "cam1", "state_groundtruth_estimate0"}) {
    std::filesystem::create_directory_symlink(*data / "mav0" / part,
                                              folder / "without/mav0" / part);
  }
  run("off", "--imu off", *data);
  run("none", "--imu auto", folder / "without");
  ExpectSameResults(folder / "off", folder / "none");
  EXPECT_NE(Contents(folder / "off/trajectory.txt"), Contents(folder / "folder/trajectory.txt"));
}

TEST(RunLive, GivesTheBytesOfTheFolderFromAPipe) {
  const auto data = FindData("euroc/MH_01_easy_first250");
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  std::vector<std::string> pieces = SentFrames(*data);
  pieces.insert(pieces.begin(), Header(752, 480));
  const Outcome fed = RunFed(folder,
                             "run - --camera euroc --out " + Quoted(folder / "fed"),
                             pieces,
                             std::chrono::milliseconds(50));
  ASSERT_EQ(fed.code, 0) << fed.err;
  EXPECT_THAT(fed.err, HasSubstr("frame 8 skipped: standard input: the sender has no image"));
  const Outcome whole =
      RunProgram(folder,
                 fmt::format("run {} --from {} --to {} --camera euroc --imu off --out {}",
                             Quoted(*data),
                             kFrames.first,
                             kFrames.second,
                             Quoted(folder / "folder")));
  ASSERT_EQ(whole.code, 0) << whole.err;
  ExpectSameResults(folder / "folder", folder / "fed");
  const auto summary = nlohmann::json::parse(Contents(folder / "fed/summary.json"));
  EXPECT_EQ(summary["frames"]["of"], 20);
  EXPECT_EQ(summary["frames"]["in"], 20);
}

// Frames of a moving poster, and the camera file that belongs to them.
class FedPoster : public testing::Test {
 protected:
  std::string Arguments(const std::string& out) const {
    const auto camera = folder_.Write(
        "camera.yaml",
        fmt::format(
            "size: [{0}, {1}]\nintrinsics: [{2}, {2}, {3}, {4}]\nrectified: true\nbaseline: {5}\n"
            "right:\n  size: [{0}, {1}]\n  intrinsics: [{2}, {2}, {3}, {4}]\n",
            MovingPoster::kWidth,
            MovingPoster::kHeight,
            MovingPoster::kFocal,
            MovingPoster::kWidth / 2.0,
            MovingPoster::kHeight / 2.0,
            MovingPoster::kBaseline));
    return " --camera " + Quoted(camera) + " --out " + Quoted(folder_ / out);
  }
  std::vector<std::string> Pieces(const std::vector<int>& images) const {
    std::vector<std::string> pieces = {Header(MovingPoster::kWidth, MovingPoster::kHeight)};
    for (const int i : images) {
      const SensorFrame frame = poster_.Frame(i);
      const auto bytes = [](const GrayImage& image) {
        return std::string(
            reinterpret_cast<const char*>(image.data()),
            static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
      };
      pieces.push_back(fmt::format("frame {}\n", frame.stamp_ns) + bytes(frame.left) +
                       bytes(*frame.right));
    }
    return pieces;
  }
  nlohmann::json Summary(const std::string& out) const {
    return nlohmann::json::parse(Contents(folder_ / out / "summary.json"));
  }

  ScratchFolder folder_;
  MovingPoster poster_;
};

TEST_F(FedPoster, IsCompleteWhenTheSourceEndsInAFrame) {
  std::vector<std::string> pieces = Pieces({0, 1, 2, 3, 4, 5});
  pieces.back().resize(pieces.back().size() / 2);
  const Outcome outcome =
      RunFed(folder_, "run -" + Arguments("run"), pieces, std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("standard input ends in the middle of a frame, behind 5 whole ones"));
  EXPECT_EQ(Summary("run")["frames"]["tracked"], 5);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run/.part"));
}

TEST_F(FedPoster, GoesOnWhenStampsJumpBack) {
  const Outcome outcome = RunFed(folder_,
                                 "run -" + Arguments("run"),
                                 Pieces({3, 4, 5, 6, 3, 4, 5}),
                                 std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frame 4: standard input: the stamps jump back by"));
  EXPECT_EQ(Summary("run")["frames"]["in"], 7);
  EXPECT_EQ(Summary("run")["frames"]["tracked"], 7);
}

// A recording that begins again somewhere else: what is seen there is a map of its own.
TEST_F(FedPoster, StartsAnotherMapWhereTheImagesJumpWithTheStamps) {
  std::vector<std::string> pieces = Pieces({4, 5, 6, 7, 8, 9, 10, 11, 12, 13});
  std::vector<std::string> elsewhere =
      Pieces({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19});
  for (std::size_t i = 1; i < elsewhere.size(); ++i) {
    std::string& frame = elsewhere[i];
    // Upside down, in the negative, each image on its own.
    const std::size_t begin = frame.find('\n') + 1, size = (frame.size() - begin) / 2;
    for (const std::size_t image : {begin, begin + size}) {
      std::reverse(frame.begin() + static_cast<std::ptrdiff_t>(image),
                   frame.begin() + static_cast<std::ptrdiff_t>(image + size));
      for (std::size_t row = 0; row < MovingPoster::kHeight; ++row) {
        const auto first =
            frame.begin() + static_cast<std::ptrdiff_t>(image + row * MovingPoster::kWidth);
        std::reverse(first, first + MovingPoster::kWidth);
      }
      for (std::size_t k = image; k < image + size; ++k) frame[k] = static_cast<char>(~frame[k]);
    }
    pieces.push_back(frame);
  }
  const Outcome outcome =
      RunFed(folder_, "run -" + Arguments("run"), pieces, std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frame 10: standard input: the stamps jump back by"));
  EXPECT_GT(Summary("run")["frames"]["lost"], 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "run/trajectory_map1.txt") ||
              std::filesystem::exists(folder_ / "run/trajectory_map0.txt"))
      << Contents(folder_ / "run/frames.csv");
}

TEST_F(FedPoster, KeepsWhatCameBeforeNonsense) {
  std::vector<std::string> pieces = Pieces({0, 1, 2, 3});
  pieces.emplace_back("hello\n");
  const Outcome outcome =
      RunFed(folder_, "run -" + Arguments("run"), pieces, std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("standard input: behind 4 frames: expected 'frame' or 'missing'"));
  EXPECT_EQ(Summary("run")["frames"]["tracked"], 4);
}

TEST_F(FedPoster, LeavesNothingWhereNoFrameComes) {
  const Outcome outcome =
      RunFed(folder_, "run -" + Arguments("run"), Pieces({}), std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("standard input: expected frames, found none"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run/summary.json"));
}

TEST_F(FedPoster, ChoosesFramesAndRefusesWhatNeedsARecording) {
  const Outcome outcome = RunFed(folder_,
                                 "run - --from 1 --stride 2 --to 6" + Arguments("run"),
                                 Pieces({0, 1, 2, 3, 4, 5, 6, 7}),
                                 std::chrono::milliseconds(1));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Summary("run")["frames"]["in"], 3);
  for (const std::string option : {"--topic /a", "--format euroc"}) {
    const Outcome refused =
        RunProgram(folder_, "run - " + option + Arguments("no") + " < /dev/null");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("expected a recording, found a live source"));
  }
}

// Nothing comes, and the pipe stays open: a signal ends it all the same.
TEST_F(FedPoster, EndsOnASignalWhileItWaits) {
  const std::vector<std::string> pieces = Pieces({0, 1, 2});
  const std::string start = "(cat " +
                            Quoted(folder_.Write("frames",
                                                 [&] {
                                                   std::string all;
                                                   for (const std::string& piece : pieces)
                                                     all += piece;
                                                   return all;
                                                 }())) +
                            "; sleep 4) | timeout -s INT 2 ";
  const Outcome outcome = RunProgram(folder_, "run -" + Arguments("run"), start);
  EXPECT_EQ(Summary("run")["interrupted"], "SIGINT");
  EXPECT_EQ(Summary("run")["frames"]["tracked"], 3);
  EXPECT_THAT(outcome.err, HasSubstr("SIGINT after 3 frames: finishing"));
}

// A pipeline that reads pictures at their rate in place of a camera with two lenses.
TEST_F(FedPoster, ComesFromAPipeline) {
  for (int i = 0; i < 12; ++i) {
    const SensorFrame frame = poster_.Frame(i);
    GrayImage both(2 * frame.left.width(), frame.left.height());
    for (int y = 0; y < both.height(); ++y) {
      std::copy_n(frame.left.row(y), frame.left.width(), both.row(y));
      std::copy_n(frame.right->row(y), frame.left.width(), both.row(y) + frame.left.width());
    }
    WriteGrayPng(folder_ / fmt::format("both_{}.png", i), both);
  }
  const std::string pipeline =
      "'gst:multifilesrc location=" + (folder_ / "both_%d.png").string() +
      " index=0 stop-index=11 caps=image/png,framerate=(fraction)20/1 ! pngdec'";
  const Outcome outcome =
      RunProgram(folder_, "run " + pipeline + " --side-by-side --mode lockstep" + Arguments("run"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("no more frames: the stream has ended, or the device is gone"));
  EXPECT_EQ(Summary("run")["frames"]["in"], 12);
  EXPECT_EQ(Summary("run")["frames"]["tracked"], 12);
  EXPECT_EQ(Summary("run")["sensor"], "stereo");
}

TEST(RunLive, SaysInOneLineThatThereIsNoSource) {
  const ScratchFolder folder;
  for (const std::string source : {"camera:99",
                                   "rtsp://me:secret@127.0.0.1:1/x",
                                   "'gst:filesrc location=/none'",
                                   "camera:x"}) {
    const Outcome outcome =
        RunProgram(folder, "run " + source + " --camera euroc --out " + Quoted(folder / "run"));
    EXPECT_EQ(outcome.code, 2) << source;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.err.find("secret"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  }
}

}  // namespace
}  // namespace plumbline
