// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/run_consistency.h"

#include "plumbline/base/error.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/consistency/consistent_run.h"
#include "tests/lab/consistency/shares.h"
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Kind = ConsistencyKind;

TEST(RunConsistency, HoldsFeaturesLandmarksAndMotionsAgainstTheTruth) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  const auto samples = ReadRunConsistency(folder / "s", folder / "run", ConsistencyPoses::kTruth);
  ASSERT_TRUE(samples);
  for (const Kind kind : {Kind::kPoint,
                          Kind::kDisparity,
                          Kind::kLine,
                          Kind::kRightLine,
                          Kind::kSegment,
                          Kind::kRightSegment}) {
    EXPECT_NEAR(ShareInside(*samples, kind), 0.9, 0.04) << NameOf(kind);
  }
  EXPECT_GT(OfKind(*samples, Kind::kLineLandmark).size(), 12U);
  EXPECT_TRUE(OfKind(*samples, Kind::kPointLandmark).empty());  // surfaces are not known
  EXPECT_EQ(OfKind(*samples, Kind::kCausal1s).size(), 11U);
  EXPECT_TRUE(OfKind(*samples, Kind::kCausal5s).empty());
  EXPECT_EQ(ShareInside(*samples, Kind::kFinal1s), 1);  // they are exact
}

TEST(RunConsistency, TakesThePosesOfTheRunWhereAsked) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  // The truth of a recording: known to 5 cm.
  std::string truth;
  for (int k = 0; k < kFrames; ++k) {
    truth += std::to_string(std::int64_t{50'000'000} * k) + (k % 2 == 0 ? ",0.05" : ",-0.05") +
             ",0,0,1,0,0,0\n";
  }
  folder.Write("s/mav0/state_groundtruth_estimate0/data.csv", truth);
  const auto of_truth = ReadRunConsistency(folder / "s", folder / "run", ConsistencyPoses::kTruth);
  const auto of_run = ReadRunConsistency(folder / "s", folder / "run", ConsistencyPoses::kRun);
  ASSERT_TRUE(of_truth && of_run);
  EXPECT_LT(ShareInside(*of_truth, Kind::kPoint), 0.5);
  EXPECT_NEAR(ShareInside(*of_run, Kind::kPoint), 0.9, 0.03);
}

TEST(RunConsistency, NamesTheLineThatIsNoCovariance) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  folder.Write("run/trajectory_covariance.txt", CovarianceRow(0, 1) + "0.05 1 2 3\n");
  try {
    ReadRunConsistency(folder / "s", folder / "run", ConsistencyPoses::kTruth);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(
        std::string(error.what()).find("trajectory_covariance.txt:2: expected 37 numbers, found 4"),
        std::string::npos)
        << error.what();
  }
}

TEST(RunConsistency, NeedsAPose) {
  const ScratchFolder folder;
  WriteConsistentRun(folder);
  folder.Write("run/trajectory.txt", "");
  EXPECT_FALSE(ReadRunConsistency(folder / "s", folder / "run", ConsistencyPoses::kTruth));
}

}  // namespace
}  // namespace plumbline
