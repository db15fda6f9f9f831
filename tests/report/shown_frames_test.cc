// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/shown_frames.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;

// Frames that are tracked but for these.
FrameLog Log(std::size_t count, const std::vector<std::size_t>& lost) {
  FrameLog log;
  for (std::size_t i = 0; i < count; ++i) {
    FrameRecord record;
    record.id = FrameId{static_cast<std::int64_t>(i)};
    record.stamp_ns = static_cast<std::int64_t>(i);
    const bool is_lost = std::find(lost.begin(), lost.end(), i) != lost.end();
    record.status = is_lost ? FrameStatus::kLost : FrameStatus::kTracked;
    log.Add(record);
  }
  return log;
}

TEST(ShownFrames, AreAllOfAShortRun) {
  const ShownFrames shown(Log(5, {2}), {3}, 5);
  EXPECT_EQ(shown.step(), 1U);
  EXPECT_THAT(shown.numbers(), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(shown.RowOf(4), 4U);
  EXPECT_EQ(shown.RowOf(5), std::nullopt);
  EXPECT_TRUE(ShownFrames(FrameLog(), {3}, 5).numbers().empty());
}

// Losses are shown from their first to their last frame, whatever lies between.
TEST(ShownFrames, AreEveryNthAndWhatHappensOfALongRun) {
  const ShownFrames shown(Log(40, {13, 14, 15, 16, 17, 18}), {27, 99}, 4);
  EXPECT_EQ(shown.step(), 10U);
  EXPECT_THAT(shown.numbers(), ElementsAre(0, 10, 12, 13, 18, 19, 20, 27, 30, 39));
  EXPECT_EQ(shown.RowOf(13), 3U);
  EXPECT_EQ(shown.RowOf(39), 9U);
  EXPECT_EQ(shown.RowOf(14), std::nullopt);
  EXPECT_EQ(shown.RowOf(99), std::nullopt);
}

// A run that loses every second frame has no more rows than others.
TEST(ShownFrames, ThinChangesToo) {
  std::vector<std::size_t> lost;
  for (std::size_t i = 1; i < 1000; i += 2) lost.push_back(i);
  EXPECT_LE(ShownFrames(Log(1000, lost), {}, 10).numbers().size(), 31U);
}

}  // namespace
}  // namespace plumbline
