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

}  // namespace frame_input_test
}  // namespace plumbline
