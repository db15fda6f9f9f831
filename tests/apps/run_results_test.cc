// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/run_results.h"

#include "plumbline/initialization/initializer.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/slam/pipeline.h"
#include "plumbline/tracking/tracker.h"

#include <set>
#include <string>
#include <type_traits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

// All codes of FrameRecord::reason.
std::set<std::string> AllReasons() {
  std::set<std::string> reasons = {Pipeline::kDropped,
                                   Pipeline::kBlackMask,
                                   System::kNotMapped,
                                   ImageFailure{}.reason(),
                                   ImageFailure{{}, {}, ImageSize{}}.reason(),
                                   "source_lost"};
  for (const auto& [value, name] : EnumNames(std::type_identity<TrackingFailure>())) {
    if (value != TrackingFailure::kNone) reasons.insert(name);
  }
  for (const auto& [value, name] : EnumNames(std::type_identity<InitializationStatus>())) {
    if (value != InitializationStatus::kNone) reasons.insert(name);
  }
  return reasons;
}

std::string WhyOf(const std::string& reason) {
  FrameLog frames;
  FrameRecord record;
  record.id = FrameId{0};
  record.status = FrameStatus::kSkipped;
  record.reason = reason;
  frames.Add(record);
  return WhyNoPose(frames, false).value_or("");
}

TEST(WhyNoPose, EveryReasonIsToldInWords) {
  for (const std::string& reason : AllReasons()) {
    EXPECT_THAT(WhyOf(reason),
                testing::MatchesRegex("no frame has a pose: [a-z].* \\(" + reason +
                                      "\\) in 1 of 1 frames"));
  }
}

TEST(WhyNoPose, KeyFramesAreNotMappedWhereMappingFailed) {
  EXPECT_EQ(WhyOf(System::kNotMapped),
            "no frame has a pose: mapping failed (not_mapped) in 1 of 1 frames");
}

}  // namespace
}  // namespace plumbline
