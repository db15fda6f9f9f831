// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_record.h"

#include "tests/io/scratch_folder.h"
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

std::vector<StartRecord> Three() {
  StartRecord waiting;
  waiting.frame = 5;
  waiting.reason = "ambiguous";
  waiting.offered = 41;
  waiting.greatest_parallax_deg = 3.25;
  StartRecord wrong = waiting;
  wrong.frame = 10;
  wrong.outcome = StartOutcome::kWrong;
  wrong.reason = "rotation depth";
  wrong.map = StartMap{7, 0.3, 10, 16, 2.5, 2.25, 300, 20, {0.75, 2, 0.125, 0.25, 280}};
  wrong.map->errors.depth = std::numeric_limits<double>::infinity();
  StartRecord unjudged;
  unjudged.outcome = StartOutcome::kUnjudged;
  unjudged.map = StartMap{};
  return {waiting, wrong, unjudged};
}

TEST(StartRecord, IsReadAsItWasWritten) {
  const ScratchFolder folder;
  const auto read = ReadStarts(folder.Write("starts.csv", FormatStarts(Three())));
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(FormatStarts(read), FormatStarts(Three()));
  EXPECT_EQ(read[0].outcome, StartOutcome::kWaiting);
  EXPECT_EQ(read[0].reason, "ambiguous");
  EXPECT_EQ(read[0].greatest_parallax_deg, 3.25);
  EXPECT_FALSE(read[0].map);
  EXPECT_EQ(read[1].map->newest, 16);
  EXPECT_EQ(read[1].map->errors.rotation_deg, 0.75);
  EXPECT_TRUE(std::isinf(*read[1].map->errors.depth));
  EXPECT_EQ(read[1].map->errors.compared, 280);
  EXPECT_EQ(read[1].map->lines, 20);
  EXPECT_FALSE(read[2].greatest_parallax_deg);
  EXPECT_FALSE(read[2].map->errors.rotation_deg);
}

TEST(StartRecord, MessagesNameTheLine) {
  const ScratchFolder folder;
  std::string text = FormatStarts(Three());
  const auto replaced = [&text](const std::string& what, const std::string& with) {
    std::string copy = text;
    return copy.replace(copy.find(what), what.size(), with);
  };
  const auto message = [&folder](const std::string& contents) {
    const auto path = folder.Write("starts.csv", contents);
    return MessageOf([&] { (void)ReadStarts(path); });
  };
  EXPECT_THAT(message(replaced("wrong", "bad")),
              HasSubstr("starts.csv:3: expected right, wrong, waiting or unjudged, found bad"));
  EXPECT_THAT(message(replaced("0.75", "x")), HasSubstr("starts.csv:3: expected a number"));
  EXPECT_THAT(message(replaced("5,waiting", "5.5,waiting")), HasSubstr("expected a whole number"));
  EXPECT_THAT(message(replaced(",41,", ",")), HasSubstr("starts.csv:2: expected 18 fields"));
  EXPECT_THAT(message(replaced("offered", "given")), HasSubstr("starts.csv:1: expected frame,"));
  EXPECT_THAT(message(""), HasSubstr("starts.csv:1: expected frame,"));
}

}  // namespace
}  // namespace plumbline
