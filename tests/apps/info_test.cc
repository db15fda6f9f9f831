// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/commands.h"
#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace info_test {

using testing::HasSubstr;

// What `info` prints, which is not to fail.
std::string Info(const std::vector<std::string>& arguments) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(MessageOf([&] { EXPECT_EQ(InfoCommand(arguments), 0); }), "no error");
  return testing::internal::GetCapturedStdout();
}

TEST(Info, ChecksAllImages) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  const std::string good = "P5\n8 6\n255\n" + std::string(48, 'a');
  folder.Write("0.pgm", good);
  folder.Write("1.pgm", "P5\n4 3\n255\n" + std::string(12, 'a'));
  folder.Write("2.pgm", "not an image");
  folder.Write("3.pgm", good);
  const std::string out = Info({folder.path().string(), "--check"});
  EXPECT_THAT(out,
              HasSubstr("bad image     frame 1: " + (folder / "1.pgm").string() +
                        ": expected an image of 8x6 pixels as in the calibration, found 4x3\n"));
  EXPECT_THAT(out, HasSubstr("bad image     frame 2: " + (folder / "2.pgm").string()));
  EXPECT_THAT(out, HasSubstr("checked       2 of 4 frames can be used\n"));
}

// As it does without a camera file. A run needs it.
TEST(Info, TellsThatTheRateIsMissing) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\n");
  folder.Write("0.pgm", "P5\n8 6\n255\n" + std::string(48, 'a'));
  const std::string out = Info({folder.path().string()});
  EXPECT_THAT(out, HasSubstr("camera        8x6, fx 5 "));
  EXPECT_THAT(out, HasSubstr("note          the frame rate is not known; "));
}

// A second one is of the right camera, which there is none of.
TEST(Info, TakesAMaskForEachCamera) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  folder.Write("0.pgm", "P5\n8 6\n255\n" + std::string(48, 'a'));
  const std::string mask =
      folder
          .Write("masks/left.pgm", "P5\n8 6\n255\n" + std::string(24, '\0') + std::string(24, 'a'))
          .string();
  const std::string data = folder.path().string();
  EXPECT_THAT(Info({data, "--mask", mask}), HasSubstr("leaves out 50 % of the image"));
  EXPECT_THAT(MessageOf([&] {
                InfoCommand(std::vector<std::string>{data, "--mask", mask, "--mask", mask});
              }),
              HasSubstr("expected at most 1 mask, one for each camera, found 2"));
}

TEST(Info, TellsHowImagesAreTurnedAndReduced) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [80, 60]\nintrinsics: [50, 51, 40, 30]\nrate_hz: 3\n");
  folder.Write("0.pgm", "P5\n80 60\n255\n" + std::string(4800, 'a'));
  const std::string out =
      Info({folder.path().string(), "--rotate", "90", "--max-width", "30", "--check"});
  EXPECT_THAT(out, HasSubstr("camera        30x40, fx 25.5 fy 25 cx 14.25 cy 19.75,"));
  EXPECT_THAT(out, HasSubstr("note          images are turned by 90 degrees clockwise"));
  EXPECT_THAT(out, HasSubstr("note          images of 60x80 pixels are reduced to 30x40"));
  EXPECT_THAT(out, HasSubstr("checked       1 of 1 frames can be used"));
}

TEST(Info, TellsWhatIsUsedOfALens) {
  const ScratchFolder folder;
  const auto info = [&](const std::string& camera) {
    folder.Write("camera.yaml", "size: [80, 60]\nintrinsics: " + camera + "rate_hz: 3\n");
    return Info({folder.path().string(), "--view-angle", "90"});
  };
  folder.Write("0.pgm", "P5\n80 60\n255\n" + std::string(4800, 'a'));
  EXPECT_THAT(info("[30, 30, 39.5, 29.5]\ndistortion: equidistant\n"
                   "distortion_coefficients: [0, 0, 0, 0]\n"),
              HasSubstr("used view     90 x 90 of 188 degrees, "));
  EXPECT_THAT(info("[22, 22, 39.5, 29.5]\ndistortion: double_sphere\n"
                   "distortion_coefficients: [0.1, 0.6]\n"),
              HasSubstr("as 41x41 pixels of 100 % of the resolution in the middle\n"));
  EXPECT_THAT(info("[22, 22, 39.5, 29.5]\n"),
              HasSubstr("no distortion\nused view     90 x 90 of "));
}

// Samples of a sensor that lies still, at 200 Hz for 4 s, with a pause of 0.1 s. The file has noise
// that is ten times as small.
std::string StillSamples() {
  std::string rows = "#timestamp [ns],w,w,w,a,a,a\n";
  for (int i = 0; i < 800; ++i) {
    if (i >= 700 && i < 719) continue;
    const double noise = i % 2 == 0 ? 1 : -1;
    rows += std::to_string(1 + std::int64_t{i} * 5'000'000) + "," + std::to_string(0.003 * noise) +
            ",0,0,0,0," + std::to_string(9.81 + 0.01 * noise) + "\n";
  }
  return rows;
}

TEST(Info, TellsOfAnInertialSensor) {
  const ScratchFolder folder;
  const std::string camera = "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n";
  const std::string noise =
      "  gyroscope_noise_density: 1.7e-5\n  gyroscope_random_walk: 1.9e-5\n"
      "  accelerometer_noise_density: 6.0e-4\n  accelerometer_random_walk: 3.0e-3\n";
  folder.Write("camera.yaml", camera + "imu:\n" + noise);
  folder.Write("0.pgm", "P5\n8 6\n255\n" + std::string(48, 'a'));
  EXPECT_THAT(Info({folder.path().string()}), testing::Not(HasSubstr("imu")));
  const std::string rows = folder.Write("imu.csv", StillSamples()).string();
  const std::string file = (folder / "camera.yaml").string();
  const std::string out = Info({folder.path().string()});
  EXPECT_THAT(out, HasSubstr("imu           781 samples in 3.995 s, 200 Hz, jitter 0 ms; " + rows));
  EXPECT_THAT(out, HasSubstr("imu file      " + file + ": noise; missing: place\n"));
  EXPECT_THAT(out, HasSubstr("imu fault     1 gap above 1.5 intervals, the longest 0.100 s\n"));
  EXPECT_THAT(out, HasSubstr("imu fault     gyroscope_noise_density is 1.7e-05, but "));
  EXPECT_THAT(out, HasSubstr("imu at rest   3 s: "));
  EXPECT_THAT(Info({folder.path().string(), "--imu", "off"}), testing::Not(HasSubstr("imu  ")));
  const auto turning = folder.Write("turning.csv", "1,1,0,0,0,0,9.81\n5000001,1,0,0,0,0,9.81\n");
  EXPECT_THAT(Info({turning.string()}), HasSubstr("imu at rest   no rest found\n"));
  // Also without any image.
  EXPECT_THAT(Info({rows}), HasSubstr("imu           781 samples"));
}

// Images are of use without samples, unless these were asked for.
TEST(Info, TellsThatSamplesCannotBeUsed) {
  const ScratchFolder folder;
  folder.Write("camera.yaml", "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n");
  folder.Write("0.pgm", "P5\n8 6\n255\n" + std::string(48, 'a'));
  const std::string imu = folder.Write("noise.yaml", "imu:\n  rate_hz: 200\n").string();
  const std::string path = folder.path().string();
  EXPECT_EQ(MessageOf([&] {
              InfoCommand(std::vector<std::string>{path, "--imu", imu});
            }),
            path + ": expected samples of an inertial sensor, found none");
  const std::string rows = folder.Write("imu.csv", "1,2,3\n").string();
  const std::string message =
      rows +
      ":1: expected a time stamp, three rates in rad/s and three forces in m/s^2, found 3 "
      "columns (1 of 1 rows are no samples)";
  EXPECT_THAT(Info({path}), HasSubstr("imu           cannot be used: " + message));
  EXPECT_EQ(MessageOf([&] { InfoCommand(std::vector<std::string>{path, "--imu", imu}); }), message);
}

}  // namespace info_test
}  // namespace plumbline
