// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "apps/commands.h"
#include "apps/evaluate_report.h"
#include "apps/figure_file.h"
#include "apps/reference_trajectory.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// The body looks along x; the camera sits 0.1 m ahead of it.
constexpr const char* kSensorYaml = R"(T_BS:
  data: [1, 0, 0, 0.1,
         0, 1, 0, 0,
         0, 0, 1, 0,
         0, 0, 0, 1]
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [450, 450, 376, 240]
distortion_model: radial-tangential
distortion_coefficients: [0, 0, 0, 0]
)";
constexpr const char* kEurocTruth = R"(#timestamp,px,py,pz,qw,qx,qy,qz
1000000000,0,0,0,1,0,0,0
1050000000,1,0,0,1,0,0,0
1100000000,1,1,0,1,0,0,0
)";
constexpr const char* kTum = R"(1.000 0.1 0 0 0 0 0 1
1.050 1.1 0 0 0 0 0 1
1.100 1.1 1 0 0 0 0 1
)";

std::filesystem::path WriteEuroc(const ScratchFolder& folder) {
  folder.Write("seq/mav0/cam0/sensor.yaml", kSensorYaml);
  folder.Write("seq/mav0/cam0/data.csv",
               "#t,name\n1000000000,a.png\n1050000000,b.png\n"
               "1100000000,c.png\n1150000000,d.png\n");
  folder.Write("seq/mav0/state_groundtruth_estimate0/data.csv", kEurocTruth);
  return folder / "seq";
}

std::string EvaluateMessage(const std::vector<std::string>& arguments) {
  return MessageOf([&] { EvaluateCommand(arguments); });
}

TEST(Reference, EurocBodyBecomesTheCamera) {
  const ScratchFolder folder;
  const auto sequence = WriteEuroc(folder);
  const auto csv = sequence / "mav0" / "state_groundtruth_estimate0" / "data.csv";
  for (const auto& path : {sequence, sequence / "mav0", csv}) {
    const ReferenceTrajectory reference = LoadReference(path, std::nullopt);
    EXPECT_TRUE(reference.converted_from_body);
    ASSERT_EQ(reference.poses.size(), 3U);
    EXPECT_NEAR(reference.poses[1].world_from_camera.translation.x(), 1.1, 1e-12);
    EXPECT_EQ(reference.frames, 4U);
  }
  const ReferenceTrajectory as_is = LoadReference(sequence, ReferenceFrame::kCamera);
  EXPECT_FALSE(as_is.converted_from_body);
  EXPECT_NEAR(as_is.poses[1].world_from_camera.translation.x(), 1.0, 1e-12);
}

TEST(Reference, SaysWhatIsMissing) {
  const ScratchFolder folder;
  const auto truth = folder.Write("a/b/data.csv", kEurocTruth);
  EXPECT_THAT(MessageOf([&] { LoadReference(truth, std::nullopt); }), HasSubstr("sensor.yaml"));
  EXPECT_THAT(MessageOf([&] { LoadReference(folder / "a", std::nullopt); }),
              HasSubstr("expected ground truth"));
  EXPECT_THAT(MessageOf([&] { LoadReference(folder / "none", std::nullopt); }),
              HasSubstr("no such file or folder"));
}

TEST(Reference, FramesOfARunAreThoseOfItsTable) {
  const ScratchFolder folder;
  const auto trajectory = folder.Write("trajectory.txt", kTum);
  EXPECT_FALSE(FramesOfRun(trajectory));
  folder.Write("frames.csv", "timestamp,state\n1.0,tracked\n1.05,tracked\n");
  EXPECT_EQ(FramesOfRun(trajectory), 2U);
}

TEST(Evaluate, WritesTableJsonAndFigures) {
  const ScratchFolder folder;
  const auto sequence = WriteEuroc(folder);
  const auto estimate = folder.Write("trajectory.txt", kTum);
  for (const std::string name : {"plot.svg", "plot.png"}) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(EvaluateCommand(std::vector<std::string>{sequence.string(),
                                                       estimate.string(),
                                                       "--align",
                                                       "none",
                                                       "--delta",
                                                       "1f",
                                                       "--json",
                                                       (folder / "out.json").string(),
                                                       "--plot",
                                                       (folder / name).string()}),
              0);
    const std::string table = testing::internal::GetCapturedStdout();
    EXPECT_THAT(table, HasSubstr("3 with a pose of 4 delivered (75.0 %), 3 compared"));
    EXPECT_THAT(table, HasSubstr("ATE [m]         0.000000"));
    EXPECT_THAT(table, HasSubstr("RPE [m/s]       0.000000"));
    EXPECT_THAT(table, HasSubstr("ROE [deg/s]     0.000000"));
  }
  const std::string json = Contents(folder / "out.json");
  EXPECT_THAT(json, HasSubstr("\"coverage\": 0.75"));
  EXPECT_THAT(json, HasSubstr("\"roe_deg_per_s\": {"));
  EXPECT_THAT(Contents(folder / "plot.svg"), StartsWith("<svg "));
  EXPECT_THAT(Contents(folder / "plot.png"), StartsWith("\x89PNG"));
}

TEST(Evaluate, NamesWhatIsWrong) {
  const ScratchFolder folder;
  const std::string sequence = WriteEuroc(folder).string();
  const std::string estimate = folder.Write("trajectory.txt", kTum).string();
  const std::string late = folder.Write("late.txt", "9 0 0 0 0 0 0 1\n").string();
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const Case cases[] = {
      {{sequence}, "evaluate: expected ESTIMATE"},
      {{sequence, estimate, "--align", "se2"}, "--align: expected none, se3 or sim3, found se2"},
      {{sequence, estimate, "--delta", "3"}, "--delta: expected seconds such as 3s"},
      {{sequence, estimate, "--delta", "1.5f"}, "found 1.5f"},
      {{sequence, estimate, "--delta", "-1s"}, "found -1s"},
      {{sequence, estimate, "--delta", ""}, "--delta: expected seconds"},
      {{sequence, estimate, "--reference-frame", "imu"}, "expected camera or body, found imu"},
      {{sequence, estimate, "--associate", "far"}, "expected interpolate or nearest, found far"},
      {{sequence, estimate, "--aling", "se3"}, "the nearest is --align"},
      {{sequence, late},
       "the reference covers 1.000000000 to 1.100000000, the estimate 9.000000000"},
      {{estimate, estimate, "--reference-frame", "body"}, "sensor.yaml"}};
  for (const Case& bad : cases) {
    testing::internal::CaptureStdout();
    EXPECT_THAT(EvaluateMessage(bad.arguments), HasSubstr(bad.message));
    testing::internal::GetCapturedStdout();
  }
  testing::internal::CaptureStdout();
  EXPECT_THAT(EvaluateMessage({sequence, estimate, "--plot", (folder / "plot.gif").string()}),
              HasSubstr("ending in .svg or .png"));
  testing::internal::GetCapturedStdout();
}

// EuRoC's vehicle turned by its own ground truth: the camera sits 7 cm from the body.
TEST(Evaluate, RealGroundTruthComparedWithItself) {
  const auto data = FindData("euroc/MH_01_easy_first250");
  if (!data) GTEST_SKIP() << "the EuRoC sequence is not there";
  const ReferenceTrajectory camera = LoadReference(*data, std::nullopt);
  const ReferenceTrajectory body = LoadReference(*data, ReferenceFrame::kCamera);
  EXPECT_EQ(camera.frames, 250U);
  const auto same = CompareTrajectories(camera.poses, camera.poses, {});
  const auto lever = CompareTrajectories(camera.poses, body.poses, {});
  ASSERT_TRUE(same && lever);
  EXPECT_LT(same->ate.rmse, 1e-12);
  EXPECT_GT(lever->ate.rmse, 0.003);
  EXPECT_LT(lever->ate.rmse, 0.02);
}

TEST(Synth, ListsWorldsAndNamesWhatIsWrong) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(SynthCommand(std::vector<std::string>{"--list"}), 0);
  const std::string list = testing::internal::GetCapturedStdout();
  EXPECT_THAT(list, HasSubstr("  room "));
  EXPECT_THAT(list, HasSubstr("frames: 200"));
  const auto message = [](const std::vector<std::string>& arguments) {
    return MessageOf([&] { SynthCommand(arguments); });
  };
  EXPECT_THAT(message({}), HasSubstr("expected the name of a world"));
  EXPECT_THAT(message({"room"}), HasSubstr("expected --out DIR"));
  EXPECT_THAT(message({"moon", "--out", "x"}), HasSubstr("expected one of room, found moon"));
  EXPECT_THAT(message({"room", "--set", "frame=3", "--out", "x"}), HasSubstr("frames"));
}

}  // namespace
}  // namespace plumbline
