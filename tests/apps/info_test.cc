// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/commands.h"
#include "tests/io/scratch_folder.h"
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

}  // namespace info_test
}  // namespace plumbline
