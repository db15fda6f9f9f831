// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/stereo_pair_check.h"

#include "tests/features/stereo_pair_scene.h"
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace stereo_pair_check_test {

using Fault = StereoPairFault;
// The frame at a position, as it is delivered.
using Frames = std::function<SensorFrame(std::size_t position)>;

constexpr std::size_t kFrames = 24;

std::optional<Fault> FaultOf(const Frames& frames,
                             const Calibration& calibration = StereoPairScene::Cameras()) {
  const Rectifier rectifier(calibration);
  StereoPairCheck check(rectifier);
  for (std::size_t i = 0; i < kFrames; ++i) {
    if (!StereoPairCheck::LooksAt(i)) continue;
    if (const auto fault = check.Add(i, frames(i))) return fault;
  }
  return std::nullopt;
}

GrayImage Turned(GrayImage image) {
  std::reverse(image.data(), image.data() + image.width() * image.height());
  return image;
}

GrayImage Mirrored(GrayImage image) {
  for (int y = 0; y < image.height(); ++y) {
    std::reverse(image.row(y), image.row(y) + image.width());
  }
  return image;
}

// Each image lower by some rows; the first rows are repeated.
GrayImage Lowered(const GrayImage& image, int rows) {
  GrayImage result = image;
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(image.row(std::max(0, y - rows)), image.width(), result.row(y));
  }
  return result;
}

TEST(StereoPairCheck, TellsWhatFitsBetter) {
  const StereoPairScene scene;
  const auto changed = [&](const std::function<void(SensorFrame&, std::size_t)>& change) {
    return FaultOf([&](std::size_t i) {
      SensorFrame frame = scene.Frame(i);
      change(frame, i);
      return frame;
    });
  };
  EXPECT_EQ(changed([](auto& frame, auto) { frame.right = frame.left; }), Fault::kLeftTwice);
  EXPECT_EQ(changed([](auto& frame, auto) { std::swap(frame.left, *frame.right); }),
            Fault::kSidesSwapped);
  EXPECT_EQ(changed([&](auto& frame, auto i) { frame.right = scene.Right(i == 0 ? 0 : i - 1); }),
            Fault::kRightLate);
  EXPECT_EQ(changed([&](auto& frame, auto i) { frame.right = scene.Right(i + 1); }),
            Fault::kRightEarly);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.right = Turned(*frame.right); }),
            Fault::kRightUpsideDown);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.left = Turned(frame.left); }),
            Fault::kLeftUpsideDown);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.right = Mirrored(*frame.right); }),
            Fault::kOneMirrored);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.right = Turned(Mirrored(*frame.right)); }),
            Fault::kOneMirrored);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.left = Mirrored(frame.left); }),
            Fault::kOneMirrored);
  EXPECT_EQ(changed([](auto& frame, auto) { frame.right = Lowered(*frame.right, 12); }),
            Fault::kOtherCameras);
}

// A copy that was compressed again is not equal to the last bit.
TEST(StereoPairCheck, KnowsACopyThatWasChangedALittle) {
  const StereoPairScene scene;
  EXPECT_EQ(FaultOf([&](std::size_t i) {
              SensorFrame frame = scene.Frame(i);
              frame.right = frame.left;
              for (int k = 0; k < frame.right->width() * frame.right->height(); ++k) {
                frame.right->data()[k] |= 1;
              }
              return frame;
            }),
            Fault::kLeftTwice);
}

TEST(StereoPairCheck, KnowsImagesThatAreRectifiedAlready) {
  const StereoPairScene scene;
  const auto frames = [&](std::size_t i) { return scene.Frame(i); };
  Calibration calibration = StereoPairScene::Cameras();
  calibration.right_from_left.rotation = Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitX());
  EXPECT_EQ(FaultOf(frames, calibration), Fault::kRectifiedAlready);
  // With it the left images twice are in equal rows as well.
  EXPECT_EQ(FaultOf(
                [&](std::size_t i) {
                  SensorFrame frame = scene.Frame(i);
                  frame.right = frame.left;
                  return frame;
                },
                calibration),
            Fault::kLeftTwice);
}

TEST(StereoPairCheck, SaysNothingOfPairsThatFit) {
  for (const double motion : {0.0, 0.3, 1.0}) {
    const StereoPairScene scene({4, 8, 12, 16, 24}, motion);
    EXPECT_EQ(FaultOf([&](std::size_t i) { return scene.Frame(i); }), std::nullopt) << motion;
  }
}

TEST(StereoPairCheck, SaysNothingWhereAllIsFarAway) {
  const StereoPairScene scene({0}, 1);
  EXPECT_EQ(FaultOf([&](std::size_t i) { return scene.Frame(i); }), std::nullopt);
  // Nor can swapped sides be told from the right ones there.
  EXPECT_EQ(FaultOf([&](std::size_t i) {
              SensorFrame frame = scene.Frame(i);
              std::swap(frame.left, *frame.right);
              return frame;
            }),
            std::nullopt);
}

TEST(StereoPairCheck, SaysNothingOfALateImageWhileTheCameraStandsStill) {
  const StereoPairScene scene({4, 8, 12, 16, 24}, 0);
  EXPECT_EQ(FaultOf([&](std::size_t i) {
              SensorFrame frame = scene.Frame(i);
              frame.right = scene.Right(i == 0 ? 0 : i - 1);
              return frame;
            }),
            std::nullopt);
}

TEST(StereoPairCheck, SaysNothingWithoutMatches) {
  const StereoPairScene scene;
  EXPECT_EQ(FaultOf([&](std::size_t i) {  // something else on the right
              SensorFrame frame = scene.Frame(i);
              frame.right = scene.Right(i + 60);
              return frame;
            }),
            std::nullopt);
  EXPECT_EQ(FaultOf([&](std::size_t i) {  // a blank wall: nothing but noise
              SensorFrame frame = scene.Frame(i);
              for (GrayImage* image : {&frame.left, &*frame.right}) {
                for (int k = 0; k < image->width() * image->height(); ++k) {
                  image->data()[k] = static_cast<std::uint8_t>(120 + image->data()[k] % 5);
                }
              }
              return frame;
            }),
            std::nullopt);
  EXPECT_EQ(FaultOf([&](std::size_t i) {  // black
              SensorFrame frame = scene.Frame(i);
              frame.left = GrayImage(StereoPairScene::kWidth, StereoPairScene::kHeight);
              frame.right = frame.left;
              return frame;
            }),
            std::nullopt);
}

// Rows that are off by 4 of 480 pixels, by a constant or a turn: where the camera moves up or down
// the right image of the next frame may fit better in a few frames.
TEST(StereoPairCheck, ForgivesACalibrationThatIsNotExact) {
  const StereoPairScene scene;
  EXPECT_EQ(FaultOf([&](std::size_t i) {
              SensorFrame frame = scene.Frame(i);
              frame.right = Lowered(*frame.right, 4);
              return frame;
            }),
            std::nullopt);
}

TEST(StereoPairCheck, TakesFramesThatItCannotUse) {
  const StereoPairScene scene;
  const Rectifier rectifier(StereoPairScene::Cameras());
  StereoPairCheck check(rectifier);
  SensorFrame frame = scene.Frame(0);
  frame.right.reset();
  EXPECT_EQ(check.Add(0, frame), std::nullopt);
  frame.right = GrayImage(10, 10);
  EXPECT_EQ(check.Add(1, frame), std::nullopt);
  // Frames before and after a sample may be missing.
  for (const std::size_t i : {6U, 11U, 16U}) {
    frame = scene.Frame(i);
    std::swap(frame.left, *frame.right);
    EXPECT_EQ(check.Add(i, frame), std::nullopt);
  }
  EXPECT_EQ(check.Add(60, frame), Fault::kSidesSwapped);
  EXPECT_EQ(check.Add(61, frame), std::nullopt) << "it is told once";
}

TEST(StereoPairCheck, LooksAtFewFrames) {
  std::size_t looks = 0;
  for (std::size_t i = 0; i < 10000; ++i) looks += StereoPairCheck::LooksAt(i) ? 1 : 0;
  EXPECT_EQ(looks, 21U);
}

}  // namespace stereo_pair_check_test
}  // namespace plumbline
