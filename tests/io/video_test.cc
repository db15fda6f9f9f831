// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/image/opencv_bridge.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/video_file.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120, kFrames = 12;
constexpr double kRate = 25;
constexpr char kCamera[] = "model: pinhole\nsize: [160, 120]\nintrinsics: [150, 150, 80, 60]\n";

// Grey levels that tell the frames apart.
int LevelOf(int frame) { return 20 + 15 * frame; }

fs::path WriteVideo(const ScratchFolder& folder) {
  const fs::path path = folder.path() / "clip.avi";
  cv::VideoWriter writer(
      path.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate, {kWidth, kHeight});
  EXPECT_TRUE(writer.isOpened());
  for (int i = 0; i < kFrames; ++i) {
    writer.write(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(LevelOf(i))));
  }
  return path;
}

// Mean grey level of a frame.
double LevelOf(const Dataset& video, std::size_t i) {
  const auto frame = video.Read(i);
  if (!frame) return -1;
  EXPECT_EQ(frame->stamp_ns, video.stamp_ns(i));
  EXPECT_FALSE(frame->right || frame->depth);
  double sum = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) sum += frame->left.row(y)[x];
  }
  return sum / (kWidth * kHeight);
}

std::string OpeningSays(const fs::path& path, const DatasetOptions& options) {
  return MessageOf([&] { OpenDataset(path, options); });
}

TEST(Video, GivesItsFramesInAnyOrder) {
  const ScratchFolder folder;
  const fs::path path = WriteVideo(folder);
  const std::string camera = folder.Write("mine.yaml", kCamera).string();
  const auto video = OpenDataset(path, {.camera = camera});
  EXPECT_EQ(video->info().format, DatasetFormat::kVideo);
  EXPECT_EQ(video->sensor(), SensorKind::kMono);
  EXPECT_TRUE(video->info().notes.empty());
  ASSERT_EQ(video->size(), kFrames);
  ASSERT_TRUE(video->calibration().rate_hz);
  EXPECT_NEAR(*video->calibration().rate_hz, kRate, 1e-6);
  for (std::size_t i = 1; i < video->size(); ++i) {
    EXPECT_NEAR(static_cast<double>(video->stamp_ns(i) - video->stamp_ns(i - 1)), 1e9 / kRate, 1e3);
  }
  for (const std::size_t i : {0U, 1U, 5U, 11U, 3U, 3U}) {  // onwards, with gaps, and back
    EXPECT_NEAR(LevelOf(*video, i), LevelOf(static_cast<int>(i)), 3) << i;
  }
}

TEST(Video, GivesColours) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "clip.avi";
  cv::VideoWriter writer(
      path.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate, {kWidth, kHeight});
  for (int i = 0; i < 3; ++i) {
    writer.write(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(20, 60 + 20 * i, 200)));
  }
  writer.release();
  const std::string camera = folder.Write("mine.yaml", kCamera).string();
  const auto video = OpenDataset(path, {.camera = camera});
  for (const int i : {0, 2, 1}) {
    const auto index = static_cast<std::size_t>(i);
    const auto image = video->ReadColor(index);
    ASSERT_TRUE(image) << image.error().why;
    const Color color = image->at(80, 60);
    EXPECT_NEAR(color.r, 200, 8);
    EXPECT_NEAR(color.g, 60 + 20 * i, 8);
    EXPECT_NEAR(color.b, 20, 8);
    EXPECT_EQ(ToGray(*image).at(80, 60), video->Read(index)->left.at(80, 60));
  }
}

// Frames at these times, whose levels tell them apart; every second and third one a B frame.
VideoFile PhoneVideo(AVRational tick, std::vector<std::int64_t> times) {
  VideoFile file;
  file.b_frames = 2;
  file.tick = tick;
  file.times = std::move(times);
  for (std::size_t i = 0; i < file.times.size(); ++i) {
    file.levels.push_back(40 + static_cast<int>(6 * i % 150));
  }
  return file;
}

std::vector<std::int64_t> EvenTimes(std::int64_t frames, std::int64_t first = 0) {
  std::vector<std::int64_t> times;
  for (std::int64_t i = 0; i < frames; ++i) times.push_back(first + i);
  return times;
}

// The level of the middle of frame i as it was written.
int WrittenLevel(const Dataset& video, std::size_t i) {
  const auto frame = video.Read(i);
  if (!frame) return -1;
  const int gray = frame->left.at(frame->left.width() / 2, frame->left.height() / 2);
  return 16 + static_cast<int>(std::lround(gray * 219 / 255.0));
}

// Expects frames of `file` from number `first` on, at their times after `start` ticks.
void ExpectFrames(const Dataset& video,
                  const VideoFile& file,
                  std::size_t first = 0,
                  std::int64_t start = 0) {
  ASSERT_EQ(video.size(), file.times.size() - first);
  for (std::size_t i = 0; i < video.size(); ++i) {
    const auto ticks = static_cast<double>(file.times[first + i] - start);
    EXPECT_NEAR(static_cast<double>(video.stamp_ns(i)), 1e9 * ticks * av_q2d(file.tick), 1) << i;
    EXPECT_NEAR(WrittenLevel(video, i), file.levels[first + i], 2) << i;
  }
}

TEST(Video, HasTheTimesOfItsContainerWithAndWithoutBFrames) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  std::vector<std::int64_t> gap = EvenTimes(20);
  for (std::size_t i = 10; i < gap.size(); ++i) gap[i] += 21;  // 0.7 s at 30 Hz
  std::vector<std::int64_t> varied;
  for (std::int64_t i = 0; i < 20; ++i) varied.push_back(33 * i + (i * i * 7) % 30);
  const std::vector<std::pair<AVRational, std::vector<std::int64_t>>> cases = {
      {{1, 25}, EvenTimes(20)},
      {{1001, 30000}, EvenTimes(20)},
      {{1001, 60000}, EvenTimes(20)},
      {{1, 30}, gap},
      {{1, 1000}, varied}};
  for (const auto& [tick, times] : cases) {
    for (const std::string container : {"a.mp4", "a.mov", "a.mkv", "a.ts", "a.avi"}) {
      // Matroska counts milliseconds, transport streams 90 kHz; AVI has a rate and no times.
      if (container == "a.mkv" && 1000 % tick.den != 0) continue;
      if (container == "a.ts" && 90'000 * tick.num % tick.den != 0) continue;
      if (container == "a.avi" && times != EvenTimes(20)) continue;
      for (const int b_frames : {0, 2}) {
        VideoFile file = PhoneVideo(tick, times);
        file.b_frames = b_frames;
        file.Write(folder / container);
        const auto video = OpenDataset(folder / container);
        SCOPED_TRACE(fmt::format("{} {}/{} {}", container, tick.num, tick.den, b_frames));
        // Of AVI the times are those of decoding, two frames later.
        const bool guessed = container == "a.avi" && b_frames > 0;
        ExpectFrames(*video, file, 0, guessed ? -2 : 0);
        if (guessed) {
          EXPECT_THAT(
              video->info().notes,
              testing::ElementsAre(HasSubstr("2 of 20 frames have no time: each is taken")));
        } else {
          EXPECT_THAT(video->info().notes, testing::IsEmpty());
        }
      }
    }
  }
}

// An edit list by which players begin behind the first four frames, which are only there to decode
// the others: what a cut without encoding again leaves.
TEST(Video, BeginsWhereItsEditListSays) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  const VideoFile file = PhoneVideo({1, 30}, EvenTimes(20, -4));
  file.Write(folder / "a.mp4");
  const auto video = OpenDataset(folder / "a.mp4");
  ExpectFrames(*video, file, 4);
  EXPECT_THAT(video->info().notes, testing::IsEmpty());
}

// A recording that was cut before its second key frame: what comes before cannot be decoded.
TEST(Video, BeginsWithTheFirstKeyFrame) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  VideoFile file = PhoneVideo({1, 25}, EvenTimes(30));
  file.b_frames = 0;
  file.key_every = 10;
  file.packets_cut = 4;
  file.Write(folder / "a.mkv");
  ExpectFrames(*OpenDataset(folder / "a.mkv"), file, 10, 4);
}

TEST(Video, LeavesFramesOutWhoseTimesDoNotIncrease) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  VideoFile file = PhoneVideo({1, 25}, EvenTimes(10));
  file.encoder = "mjpeg";
  file.b_frames = 0;
  file.packet_times = {0, 1, 2, 2, 4, 3, 6, 70, 8, 9};  // repeated, backward, far ahead
  file.Write(folder / "a.mkv");
  const auto video = OpenDataset(folder / "a.mkv");
  EXPECT_THAT(
      video->info().notes,
      testing::ElementsAre(HasSubstr("3 of 10 frames are left out, the first of them frame ")));
  std::vector<std::int64_t> ticks;
  for (const std::int64_t stamp_ns : video->info().stamps_ns)
    ticks.push_back(stamp_ns / 40'000'000);
  EXPECT_THAT(ticks,
              testing::AnyOf(testing::ElementsAre(0, 1, 2, 3, 6, 8, 9),
                             testing::ElementsAre(0, 1, 2, 4, 6, 8, 9)));
  for (const std::size_t i : {6U, 0U, 4U}) {
    EXPECT_NEAR(
        LevelOf(*video, i) / 255, file.levels[static_cast<std::size_t>(ticks[i])] / 255.0, 0.1);
  }
  file.packet_times = std::vector<std::int64_t>(10, 0);
  file.Write(folder / "a.mkv");
  const auto even = OpenDataset(folder / "a.mkv");
  EXPECT_THAT(even->info().notes, testing::ElementsAre(HasSubstr("its rate of 25 Hz is used")));
  ASSERT_EQ(even->size(), 10U);
  EXPECT_EQ(even->stamp_ns(9), 360'000'000);
}

// What OpenCV reads of the first frame, turned clockwise. (By itself, version 4.6 turns quarters to
// the other side.)
GrayImage FirstFrameByOpenCv(const fs::path& path, int degrees = 0) {
  cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
  capture.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  cv::Mat image, gray;
  EXPECT_TRUE(capture.read(image));
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  if (degrees == 90) cv::rotate(gray, gray, cv::ROTATE_90_CLOCKWISE);
  if (degrees == 180) cv::rotate(gray, gray, cv::ROTATE_180);
  if (degrees == 270) cv::rotate(gray, gray, cv::ROTATE_90_COUNTERCLOCKWISE);
  return ToImage<std::uint8_t>(gray);
}

bool SamePixels(const GrayImage& a, const GrayImage& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::equal(a.data(), a.data() + std::ptrdiff_t{a.width()} * a.height(), b.data());
}

TEST(Video, IsTurnedAsItsFileAsks) {
  const ScratchFolder folder;
  const std::string upright = "size: [120, 160]\nintrinsics: [150, 140, 50, 90]\n";
  const std::string stored = "size: [160, 120]\nintrinsics: [140, 150, 90, 69]\n";
  const std::vector<std::pair<std::array<std::int32_t, 4>, int>> turns = {
      {{1, 0, 0, 1}, 0}, {{0, 1, -1, 0}, 90}, {{-1, 0, 0, -1}, 180}, {{0, -1, 1, 0}, 270}};
  for (const auto& [display, degrees] : turns) {
    VideoFile file = PhoneVideo({1, 25}, EvenTimes(4));
    file.display = display;
    file.Write(folder / "a.mp4");
    folder.Write("camera.yaml", stored);
    const auto video = OpenDataset(folder / "a.mp4");
    EXPECT_TRUE(SamePixels(video->Read(0)->left, FirstFrameByOpenCv(folder / "a.mp4", degrees)))
        << degrees;
    const CameraIntrinsics& in = video->calibration().left.intrinsics();
    EXPECT_EQ(in.fx, degrees % 180 == 0 ? 140 : 150);
    const auto kept = OpenDataset(folder / "a.mp4", {.rotate = Rotation::kNone});
    EXPECT_EQ(kept->calibration().left.intrinsics().cx, 90);
    EXPECT_EQ(kept->Read(0)->left.at(5, 5), 255);  // the corner that is bright as stored
    if (degrees == 0) {
      EXPECT_THAT(video->info().notes, testing::IsEmpty());
      continue;
    }
    const std::string words = fmt::format("turned by {} degrees clockwise", degrees);
    EXPECT_THAT(video->info().notes,
                testing::ElementsAre("images are " + words +
                                     " as the file asks, and the calibration with them"));
    EXPECT_THAT(kept->info().notes,
                testing::ElementsAre("the file asks for images that are " + words +
                                     "; they are used as stored"));
    if (degrees == 180) continue;
    EXPECT_EQ(in.cx, degrees == 90 ? 119 - 69 : 69);
    // A calibration whose size fits the turned images alone is of these.
    folder.Write("camera.yaml", upright);
    const auto of_turned = OpenDataset(folder / "a.mp4");
    EXPECT_EQ(of_turned->calibration().left.intrinsics().fx, 150);
    EXPECT_NEAR(of_turned->calibration().left.intrinsics().cx, 50, 1e-9);
    EXPECT_THAT(of_turned->info().notes,
                testing::ElementsAre("images are " + words +
                                     " as the file asks; the calibration is of turned images"));
    EXPECT_THAT(OpeningSays(folder / "a.mp4", {.rotate = Rotation::kNone}),
                HasSubstr("120x160 pixels as in the calibration, found 160x120"));
  }
}

TEST(Video, IsTurnedAndReducedAsAskedFor) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [160, 120]\nintrinsics: [140, 150, 90, 69]\n");
  VideoFile file = PhoneVideo({1, 25}, EvenTimes(4));
  file.display = {0, 1, -1, 0};
  file.Write(folder / "a.mp4");
  const auto video = OpenDataset(folder / "a.mp4", {.rotate = Rotation::k270, .max_width = 60});
  const GrayImage image = video->Read(0)->left;
  EXPECT_EQ(image.width(), 60);
  EXPECT_EQ(image.height(), 80);
  EXPECT_EQ(image.at(3, 76), 255);  // upper left as stored
  EXPECT_EQ(video->calibration().left.width(), 60);
  EXPECT_NEAR(video->calibration().left.intrinsics().cx, (69 + 0.5) / 2 - 0.5, 1e-9);
  EXPECT_THAT(video->info().notes,
              testing::ElementsAre(
                  "images are turned by 270 degrees clockwise, and the calibration with them",
                  "images of 120x160 pixels are reduced to 60x80, and the calibration with them"));
}

// The pixels of a video are those that OpenCV reads.
TEST(Video, HasThePixelsThatOpenCvReads) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  const fs::path avi = WriteVideo(folder);
  EXPECT_TRUE(SamePixels(OpenDataset(avi)->Read(0)->left, FirstFrameByOpenCv(avi)));
  for (const auto& [width, height] : {std::pair{160, 120}, {638, 358}, {1280, 720}, {1920, 1080}}) {
    VideoFile file = PhoneVideo({1, 25}, EvenTimes(3));
    file.width = width;
    file.height = height;
    file.Write(folder / "a.mp4");
    folder.Write("camera.yaml",
                 fmt::format("size: [{}, {}]\nintrinsics: [700, 700, {}, {}]\n",
                             width,
                             height,
                             width / 2,
                             height / 2));
    EXPECT_TRUE(SamePixels(OpenDataset(folder / "a.mp4")->Read(0)->left,
                           FirstFrameByOpenCv(folder / "a.mp4")))
        << width;
  }
}

TEST(Video, TakesTheCameraFileBesideIt) {
  const ScratchFolder folder;
  const fs::path path = WriteVideo(folder);
  EXPECT_THAT(OpeningSays(path, {}), HasSubstr("--camera"));
  EXPECT_FALSE(OpenDataset(path, {.allow_missing_camera = true})->info().has_calibration);
  folder.Write("camera.yaml", kCamera);
  EXPECT_EQ(OpenDataset(path, {})->size(), kFrames);
}

TEST(Video, RefusesWhatDoesNotFit) {
  const ScratchFolder folder;
  const fs::path path = WriteVideo(folder);
  folder.Write("camera.yaml", "model: pinhole\nsize: [160, 100]\nintrinsics: [150, 150, 80, 50]\n");
  EXPECT_THAT(OpeningSays(path, {}),
              HasSubstr("160x100 pixels as in the calibration, found 160x120"));
  EXPECT_THAT(OpeningSays(path, {.sensor = SensorKind::kStereo}), HasSubstr("mono"));
  EXPECT_THAT(OpeningSays(path, {.format = DatasetFormat::kTum}), HasSubstr("expected a folder"));
  EXPECT_THAT(OpeningSays(folder.path(), {.format = DatasetFormat::kVideo}),
              HasSubstr("expected a video file, found a folder"));
  folder.Write("camera.yaml", kCamera);
  EXPECT_THAT(OpeningSays(folder.Write("text.avi", "no video"), {}),
              HasSubstr("cannot be decoded"));
}

// FFmpeg plays a text as a terminal would show it.
TEST(Video, IsNoText) {
  const ScratchFolder folder;
  std::string poses;
  for (int i = 0; i < 100; ++i) poses += std::to_string(i) + ".5 0 0 0 0 0 0 1\n";
  EXPECT_THAT(OpeningSays(folder.Write("trajectory.txt", poses), {}),
              HasSubstr("trajectory.txt: expected a folder or a video, found a text"));
  // Raw video with a line in front, and no byte that a text could not have.
  folder.Write("camera.yaml", kCamera);
  const std::string frame = "FRAME\n" + std::string(kWidth * kHeight * 3 / 2, 'P');
  const fs::path raw =
      folder.Write("raw.y4m", "YUV4MPEG2 W160 H120 F25:1 Ip A1:1 C420jpeg\n" + frame + frame);
  EXPECT_EQ(OpenDataset(raw, {})->size(), 2U);
  // An image with a text before its pixels, which are as bright as letters of other languages.
  const fs::path bright =
      folder.Write("bright.pgm", "P5\n160 120\n255\n" + std::string(kWidth * kHeight, '\xc8'));
  EXPECT_EQ(OpenDataset(bright, {})->size(), 1U);
}

TEST(Video, EndsWhereTheFileWasCutShort) {
  const ScratchFolder folder;
  const fs::path path = WriteVideo(folder);
  folder.Write("camera.yaml", kCamera);
  fs::resize_file(path, fs::file_size(path) * 8 / 10);
  const auto video = OpenDataset(path, {});
  EXPECT_GT(video->size(), 2U);
  EXPECT_LT(video->size(), kFrames);
  EXPECT_NEAR(LevelOf(*video, 1), LevelOf(1), 3);
}

}  // namespace
}  // namespace plumbline
