// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/raw_pixels.h"
#include "plumbline/io/live/open_live_source.h"

#include "tests/io/scratch_folder.h"
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

// A pipe into which a thread writes, a few bytes at a time.
class SlowPipe {
 public:
  explicit SlowPipe(std::string bytes) {
    int ends[2] = {};
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    read_ = ends[0];
    writer_ = std::thread([bytes = std::move(bytes), write = ends[1]] {
      constexpr std::size_t kPiece = 7;
      for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
        const std::size_t count = std::min(kPiece, bytes.size() - at);
        if (::write(write, bytes.data() + at, count) < 0) break;
      }
      ::close(write);
    });
  }
  SlowPipe(const SlowPipe&) = delete;
  SlowPipe& operator=(const SlowPipe&) = delete;
  ~SlowPipe() {
    writer_.join();
    ::close(read_);
  }
  int read() const { return read_; }

 private:
  int read_ = 0;
  std::thread writer_;
};

const std::string kHeader = "plumbline frames 1\nleft mono8 4 2\nright bgr8 4 2\nend\n";
const std::string kDepthHeader = "plumbline frames 1\ndepth 16UC1 4 2 2000\nleft mono8 4 2\nend\n";

std::string Frame(std::int64_t stamp, char left, char right) {
  return "frame " + std::to_string(stamp) + "\n" + std::string(8, left) + std::string(24, right);
}

class RawStreams : public testing::Test {
 protected:
  LiveOptions Options(const char* extra = "") const {
    const std::string camera = "size: [4, 2]\nintrinsics: [5, 5, 2, 1]\n";
    return {.camera = folder_
                          .Write("camera.yaml",
                                 camera +
                                     "rectified: true\nbaseline: 0.1\nright:\n  size: [4, 2]\n"
                                     "  intrinsics: [5, 5, 2, 1]\n" +
                                     extra)
                          .string()};
  }
  std::string Fault(const std::string& bytes) const {
    const SlowPipe pipe(bytes);
    return MessageOf([&] {
      const auto source = OpenRawStream(pipe.read(), Options());
      while (!std::holds_alternative<SourceEnd>(source->Next())) {
      }
    });
  }

  ScratchFolder folder_;
};

TEST_F(RawStreams, GiveFramesAsTheyCome) {
  const SlowPipe pipe(kHeader + Frame(100, 'a', 'b') + "missing 150\n" + Frame(200, 'c', 'd'));
  const auto source = OpenRawStream(pipe.read(), Options());
  EXPECT_EQ(source->info().sensor, SensorKind::kStereo);
  const LiveEvent first = source->Next();
  const auto* frame = std::get_if<SensorFrame>(&first);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->stamp_ns, 100);
  EXPECT_EQ(frame->left.at(3, 1), 'a');
  EXPECT_EQ(frame->right.value().at(0, 0), 'b');
  const LiveEvent second = source->Next();
  ASSERT_TRUE(std::holds_alternative<MissingFrame>(second));
  EXPECT_EQ(std::get<MissingFrame>(second).stamp_ns, 150);
  EXPECT_EQ(std::get<SensorFrame>(source->Next()).left.at(0, 0), 'c');
  EXPECT_EQ(std::get<SourceEnd>(source->Next()).why, "");
}

TEST_F(RawStreams, BringSamplesOfAnInertialSensorBetweenTheFrames) {
  const std::string header = "plumbline frames 1\nleft mono8 4 2\nright bgr8 4 2\nimu\nend\n";
  const SlowPipe pipe(header + "imu 90 0.1 0.2 0.3 4 5 6\nimu 95 nan 0 0 0 0 9.8\n" +
                      Frame(100, 'a', 'b') + "imu 140 1 2 3 4 5 9.8\nimu 1\n" + "missing 150\n" +
                      "imu 160 1 2 3 4 5 6\n");
  const auto source = OpenRawStream(pipe.read(), Options());
  EXPECT_TRUE(source->HasInertial());
  EXPECT_TRUE(std::holds_alternative<SensorFrame>(source->Next()));
  const auto first = source->TakeInertial();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].stamp_ns, 90);
  EXPECT_EQ(first[0].angular_rate, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(first[0].specific_force, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(source->TakeInertial().empty());
  EXPECT_TRUE(std::holds_alternative<MissingFrame>(source->Next()));
  const auto second = source->TakeInertial();
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].stamp_ns, 140);
  EXPECT_EQ(source->UnusableInertial().count, 2U);
  EXPECT_EQ(source->UnusableInertial().first,
            "standard input: behind 0 frames: expected a number in column 2, found 'nan'");
  EXPECT_EQ(std::get<SourceEnd>(source->Next()).why, "");
}

TEST_F(RawStreams, HaveDepth) {
  const std::string depth("\x10\x27\0\0\x10\x27\0\0\x10\x27\0\0\x10\x27\0\0", 16);
  const SlowPipe pipe(kDepthHeader + "frame 5\n" + depth + "abcdefgh");
  const auto source = OpenRawStream(pipe.read(), Options());
  ASSERT_EQ(source->info().sensor, SensorKind::kRgbd);
  EXPECT_EQ(source->info().calibration.depth_factor, 2000);
  const auto frame = std::get<SensorFrame>(source->Next());
  EXPECT_EQ(frame.depth.value().at(0, 0), 5.0F);
  EXPECT_EQ(frame.depth.value().at(1, 0), 0.0F);
  EXPECT_EQ(frame.left.at(3, 1), 'h');
}

TEST_F(RawStreams, LeaveOutImagesThatAreNotWanted) {
  const SlowPipe pipe(kHeader + Frame(100, 'a', 'b') + Frame(200, 'c', 'd'));
  LiveOptions options = Options();
  options.sensor = SensorKind::kMono;
  const auto source = OpenRawStream(pipe.read(), options);
  EXPECT_FALSE(std::get<SensorFrame>(source->Next()).right);
  EXPECT_EQ(std::get<SensorFrame>(source->Next()).left.at(0, 0), 'c');
}

TEST_F(RawStreams, EndInTheMiddleOfAFrame) {
  const std::string bytes = kHeader + Frame(100, 'a', 'b') + Frame(200, 'c', 'd');
  for (std::size_t cut = 1; cut < 32; ++cut) {
    const SlowPipe pipe(bytes.substr(0, bytes.size() - cut));
    const auto source = OpenRawStream(pipe.read(), Options());
    EXPECT_TRUE(std::holds_alternative<SensorFrame>(source->Next()));
    EXPECT_THAT(std::get<SourceEnd>(source->Next()).why,
                HasSubstr("ends in the middle of a frame, behind 1 whole ones"));
  }
}

TEST_F(RawStreams, NameWhatIsWrong) {
  EXPECT_THAT(Fault(""), HasSubstr("standard input:1: expected a whole header, found ''"));
  EXPECT_THAT(Fault("hello\n"),
              HasSubstr("standard input:1: expected 'plumbline frames 1', found 'hello'"));
  const std::string first = "plumbline frames 1\n";
  EXPECT_THAT(Fault(first + "end\n"), HasSubstr("expected a left image in the header"));
  EXPECT_THAT(Fault(first + "left mono8 4 2\nleft mono8 4 2\n"),
              HasSubstr("standard input:3: expected 'left', 'right', 'depth' or 'imu', each once"));
  EXPECT_THAT(Fault(first + "left jpeg 4 2\n"),
              HasSubstr(":2: expected images as " + EncodingsOf(ImageContents::kGray) +
                        ", found 'left jpeg 4 2'"));
  EXPECT_THAT(Fault(first + "depth mono8 4 2\n"),
              HasSubstr(":2: expected depth as mono16, 16UC1 or 32FC1, found 'depth mono8 4 2'"));
  EXPECT_THAT(Fault(first + "left mono8 4\n"),
              HasSubstr("expected an encoding, a width and a height"));
  EXPECT_THAT(Fault(first + "left mono8 4 -2\n"), HasSubstr("expected an encoding, a width"));
  EXPECT_THAT(Fault(first + "left mono8 99999 99999\n"), HasSubstr("at most 100 million pixels"));
  EXPECT_THAT(Fault(first + "depth 16UC1 4 2 0\n"), HasSubstr("a depth factor"));
  EXPECT_THAT(Fault(first + "left mono8 8 6\nend\n"),
              HasSubstr("expected images of 4x2 pixels as in the calibration, found 8x6"));
  EXPECT_THAT(Fault(kHeader + Frame(100, 'a', 'b') + "fram 200\n"),
              HasSubstr("standard input: behind 1 frames: expected 'frame' or 'missing'"));
  EXPECT_THAT(Fault(kHeader + "frame -5\n"), HasSubstr("behind 0 frames"));
  // Samples must be announced.
  EXPECT_THAT(
      Fault(kHeader + "imu 90 0.1 0.2 0.3 4 5 6\n"),
      HasSubstr("behind 0 frames: expected 'imu' in the header, as samples come, found none"));
  EXPECT_THAT(Fault(kHeader + std::string(1000, 'x')), HasSubstr("behind 0 frames: expected"));
  const SlowPipe pipe(kHeader);
  EXPECT_THAT(MessageOf([&] { OpenRawStream(pipe.read(), {}); }),
              HasSubstr("standard input: expected --camera FILE"));
}

}  // namespace
}  // namespace plumbline
