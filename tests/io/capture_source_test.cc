// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/live/open_live_source.h"

#include "tests/io/scratch_folder.h"
#include <string>
#include <utility>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// The pictures of a test signal of GStreamer in place of a camera.
class Pipelines : public testing::Test {
 protected:
  LiveOptions Options(const std::string& size) const {
    return {.camera = folder_
                          .Write("camera.yaml",
                                 "size: [" + size +
                                     "]\nintrinsics: [50, 50, 20, 16]\nrectified: true\n"
                                     "baseline: 0.1\nright:\n  size: [" +
                                     size + "]\n  intrinsics: [50, 50, 20, 16]\n")
                          .string()};
  }
  static std::string Signal(const std::string& caps) {
    return "gst:videotestsrc num-buffers=4 pattern=white ! video/x-raw,framerate=100/1," + caps;
  }

  ScratchFolder folder_;
};

TEST_F(Pipelines, GiveFramesUntilTheyEnd) {
  const auto source = OpenLiveSource(Signal("width=64,height=48"), Options("64, 48"));
  EXPECT_EQ(source->info().sensor, SensorKind::kMono);
  std::int64_t last_ns = 0;
  int frames = 0;
  LiveEvent event = source->Next();
  for (; std::holds_alternative<SensorFrame>(event); event = source->Next(), ++frames) {
    const auto& frame = std::get<SensorFrame>(event);
    EXPECT_GT(frame.stamp_ns, last_ns);
    EXPECT_EQ(frame.left.at(63, 47), 255);
    last_ns = frame.stamp_ns;
  }
  EXPECT_EQ(frames, 4);
  EXPECT_THAT(std::get<SourceEnd>(event).why, HasSubstr("the stream has ended"));
}

TEST_F(Pipelines, AreTakenApartSideBySide) {
  const std::string two =
      "gst:videotestsrc num-buffers=2 pattern=black ! "
      "video/x-raw,width=64,height=48,framerate=100/1 ! "
      "videobox right=-64 fill=white ! videoconvert ! appsink";
  LiveOptions options = Options("64, 48");
  options.side_by_side = true;
  const auto source = OpenLiveSource(two, options);
  ASSERT_EQ(source->info().sensor, SensorKind::kStereo);
  const auto frame = std::get<SensorFrame>(source->Next());
  EXPECT_EQ(frame.left.width(), 64);
  EXPECT_EQ(frame.left.at(63, 10), 0);
  EXPECT_EQ(frame.right.value().at(0, 10), 255);
}

TEST_F(Pipelines, AreTurnedAndReduced) {
  const std::string two =
      "gst:videotestsrc num-buffers=2 pattern=black ! "
      "video/x-raw,width=32,height=48,framerate=100/1 ! "
      "videobox right=-32 fill=white ! videoconvert ! appsink";
  LiveOptions options = Options("64, 48");
  options.sensor = SensorKind::kMono;
  options.rotate = Rotation::k90;
  options.max_width = 24;
  const auto source = OpenLiveSource(two, options);
  EXPECT_EQ(source->info().calibration.left.width(), 24);
  EXPECT_EQ(source->info().calibration.left.height(), 32);
  EXPECT_EQ(source->info().notes.size(), 2U);
  const auto frame = std::get<SensorFrame>(source->Next());
  ASSERT_EQ(frame.left.width(), 24);
  EXPECT_EQ(frame.left.at(12, 2), 0);  // the left side comes to the top
  EXPECT_EQ(frame.left.at(12, 30), 255);
  LiveOptions pair = Options("32, 48");
  pair.side_by_side = true;
  pair.rotate = Rotation::k90;
  EXPECT_THAT(MessageOf([&] { OpenLiveSource(two, pair); }), HasSubstr("found a stereo pair"));
}

// The signal becomes smaller and is as large as before in the end.
TEST_F(Pipelines, LeaveOutFramesOfAnotherSize) {
  std::string pipeline = "gst:concat name=all ! videoconvert ! appsink";
  for (const int width : {64, 32, 64}) {
    pipeline +=
        " videotestsrc num-buffers=3 pattern=white ! "
        "video/x-raw,height=48,framerate=100/1,width=" +
        std::to_string(width) + " ! all.";
  }
  const auto source = OpenLiveSource(pipeline, Options("64, 48"));
  std::string events;
  LiveEvent event = source->Next();
  for (; !std::holds_alternative<SourceEnd>(event); event = source->Next()) {
    if (const auto* missing = std::get_if<MissingFrame>(&event)) {
      EXPECT_EQ(missing->reason, "image_size");
      EXPECT_EQ(missing->why, "an image of 32x48 pixels");
      events += '-';
    } else {
      events += '+';
    }
  }
  EXPECT_EQ(events, "+++---+++");
}

TEST_F(Pipelines, SayWhichPixelsTheyCannotUse) {
  for (const auto& [format, found] :
       {std::pair{"GRAY16_LE", "found 1 of 16 bits"}, std::pair{"BGRA", "found 4 of 8 bits"}}) {
    const auto source =
        OpenLiveSource(Signal(std::string("width=64,height=48,format=") + format + " ! appsink"),
                       Options("64, 48"));
    const LiveEvent event = source->Next();
    ASSERT_TRUE(std::holds_alternative<MissingFrame>(event)) << format;
    EXPECT_EQ(std::get<MissingFrame>(event).reason, "image_unreadable");
    EXPECT_EQ(std::get<MissingFrame>(event).why,
              std::string("expected 1 or 3 channels of 8 bits, ") + found);
  }
}

// A test signal that is played nowhere: GStreamer would wait for its first picture for ever.
TEST_F(Pipelines, AreNotWaitedForWithoutEnd) {
  LiveOptions options = Options("64, 48");
  options.patience = std::chrono::milliseconds(300);
  const std::string stuck = "gst:appsrc ! video/x-raw,width=64,height=48,format=GRAY8 ! appsink";
  EXPECT_THAT(MessageOf([&] { OpenLiveSource(stuck, options); }),
              HasSubstr("expected a first frame within 0.3 s, found none"));
}

TEST_F(Pipelines, MustHaveTheSizeOfTheCalibration) {
  EXPECT_THAT(MessageOf([&] { OpenLiveSource(Signal("width=32,height=48"), Options("64, 48")); }),
              HasSubstr("expected images of 64x48 pixels as in the calibration, found 32x48"));
  EXPECT_THAT(MessageOf([&] { OpenLiveSource(Signal("width=32,height=48"), {}); }),
              HasSubstr("expected --camera FILE"));
}

}  // namespace
}  // namespace plumbline
