// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/video.h"

#include "plumbline/base/error.h"
#include "plumbline/io/open_dataset.h"
#include "plumbline/io/reversed_dataset.h"

#include "tests/io/scratch_folder.h"
#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
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

// Writes an MP4 file that asks players to turn its images by a quarter, as phones do.
fs::path WriteTurnedVideo(const ScratchFolder& folder) {
  const fs::path path = folder.path() / "upright.mp4";
  {
    cv::VideoWriter writer(path.string(),
                           cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                           kRate,
                           {kWidth, kHeight});
    EXPECT_TRUE(writer.isOpened());
    for (int i = 0; i < kFrames; ++i) {
      writer.write(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(LevelOf(i))));
    }
  }
  // The matrix of the track header, whose first rows are (1, 0, 0) and (0, 1, 0) in 16.16 bits.
  std::string file = Contents(path);
  const std::string one("\0\1\0\0", 4), zero(4, '\0'), minus_one("\xff\xff\0\0", 4);
  const std::size_t header = file.find("tkhd");
  const std::size_t at = file.find(one + zero + zero + zero + one, header);
  EXPECT_TRUE(header != std::string::npos && at != std::string::npos);
  if (at != std::string::npos) file.replace(at, 20, zero + one + zero + minus_one + zero);
  return folder.Write("turned.mp4", file);
}

TEST(Video, SaysThatItsImagesAreUsedAsStored) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", kCamera);
  const fs::path turned = WriteTurnedVideo(folder);
  EXPECT_THAT(OpenDataset(folder / "upright.mp4")->info().notes, testing::IsEmpty());
  const auto video = OpenDataset(turned);
  EXPECT_THAT(video->info().notes,
              testing::ElementsAre("the file says that its images are turned by 90 degrees; they "
                                   "are used as stored"));
  const auto frame = video->Read(0);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->left.width(), kWidth);
  EXPECT_EQ(frame->left.height(), kHeight);
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

TEST(Video, IsNotPlayedBackwards) {
  const ScratchFolder folder;
  const fs::path path = WriteVideo(folder);
  folder.Write("camera.yaml", kCamera);
  EXPECT_THAT(MessageOf([&] {
                PlayedBackwards(OpenDataset(path, {}), {0, 1});
              }),
              HasSubstr("clip.avi: expected image files to play backwards, found a video"));
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
