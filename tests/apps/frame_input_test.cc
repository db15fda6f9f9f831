// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_input.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace frame_input_test {

using testing::ElementsAre;

// A source whose frames are given; `why` of each, empty for one that is there.
class ListedSource : public LiveSource {
 public:
  explicit ListedSource(std::vector<std::pair<std::string, std::string>> frames)
      : LiveSource(Named()), frames_(std::move(frames)) {}

  LiveEvent Next() override {
    if (next_ == frames_.size()) return SourceEnd{};
    const auto& [reason, why] = frames_[next_];
    const auto stamp_ns = static_cast<std::int64_t>(1'000'000 * ++next_);
    if (!reason.empty()) return MissingFrame{stamp_ns, reason, why};
    return SensorFrame{stamp_ns, GrayImage(4, 3), {}, {}};
  }

 private:
  static DatasetInfo Named() {
    DatasetInfo info;
    info.name = "source";
    return info;
  }

  std::vector<std::pair<std::string, std::string>> frames_;
  std::size_t next_ = 0;
};

// What is said of these frames.
std::vector<std::string> SaidOf(std::vector<std::pair<std::string, std::string>> frames,
                                const FrameSelection& range = {0, 100, 1}) {
  std::vector<std::string> said;
  LiveInput input(std::make_shared<ListedSource>(std::move(frames)),
                  range,
                  [&](const std::string& text) { said.push_back(text); });
  while (input.Next([] { return true; })) continue;
  return said;
}

// A camera that is wrong for an hour is told of twice, not with every frame.
TEST(LiveInput, SaysOnceWhyFramesInSuccessionAreMissing) {
  const std::pair<std::string, std::string> there, size{"image_size", "an image of 4x3 pixels"},
      other_size{"image_size", "an image of 8x6 pixels"}, bits{"image_unreadable", "16 bits"};
  const std::string again =
      " skipped: source: for the same reason; more such frames in succession are not told";
  EXPECT_THAT(SaidOf({there, bits, bits, bits, size, size, size, size, other_size, there, bits}),
              ElementsAre("frame 1 skipped: source: 16 bits",
                          "frame 2" + again,
                          "frame 4 skipped: source: an image of 4x3 pixels",
                          "frame 5" + again,
                          "frame 8 skipped: source: an image of 8x6 pixels",
                          "frame 10 skipped: source: 16 bits"));
}

// Frames that nobody chose neither say anything nor end a succession.
TEST(LiveInput, SaysNothingOfFramesThatAreNotChosen) {
  const std::pair<std::string, std::string> there, bits{"image_unreadable", "16 bits"};
  EXPECT_EQ(SaidOf({bits, there, bits, there, bits, there, bits}, {0, 100, 2}).size(), 2U);
  EXPECT_TRUE(SaidOf({there, bits, there, bits}, {0, 100, 2}).empty());
}

// A source with a sample 1 ms before and one at each frame, whose clock is set back by an hour.
class SourceWithSamples : public LiveSource {
 public:
  SourceWithSamples() : LiveSource({}) {}

  LiveEvent Next() override {
    if (next_ == 8) return SourceEnd{};
    const std::int64_t stamp_ns = kHour + 10'000'000 * next_ - (next_ >= 4 ? kHour : 0);
    if (next_ == 4) {  // one more sample of the clock before
      samples_.push_back({kHour + 39'000'000, {}, {}});
    }
    samples_.push_back({stamp_ns - 1'000'000, {}, {}});
    samples_.push_back({stamp_ns, {}, {}});
    ++next_;
    return SensorFrame{stamp_ns, GrayImage(4, 3), {}, {}};
  }
  std::vector<InertialSample> TakeInertial() override { return std::exchange(samples_, {}); }

 private:
  static constexpr std::int64_t kHour = 3'600'000'000'000;
  std::int64_t next_ = 0;
  std::vector<InertialSample> samples_;
};

TEST(LiveInput, SamplesOfFramesThatAreNotChosenGoToTheNextOneAndFollowItsStamps) {
  LiveInput input(std::make_shared<SourceWithSamples>(), {1, 100, 3}, [](const std::string&) {});
  std::vector<std::size_t> counts;
  std::vector<std::int64_t> lead;
  while (const auto frame = input.Next([] { return true; })) {
    counts.push_back(frame->inertial.size());
    for (std::size_t i = 1; i < frame->inertial.size(); ++i) {
      EXPECT_GT(frame->inertial[i].stamp_ns, frame->inertial[i - 1].stamp_ns);
    }
    lead.push_back(frame->stamp_ns - frame->inertial.back().stamp_ns);
  }
  EXPECT_THAT(counts, ElementsAre(4U, 6U, 6U));  // of frames 1, 4 and 7
  EXPECT_THAT(lead, ElementsAre(0, 0, 0));
}

}  // namespace frame_input_test
}  // namespace plumbline
