// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/report/run_folder.h"

#include "apps/commands.h"
#include "apps/evaluate_report.h"
#include "apps/figure_file.h"
#include "apps/reference_trajectory.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/data_folder.h"
#include <string>
#include <utility>
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
    ASSERT_EQ(reference.poses.size(), 3U);
    EXPECT_NEAR(reference.poses[1].world_from_camera.translation.x(), 1.1, 1e-12);
    EXPECT_EQ(reference.frames, 4U);
  }
  const ReferenceTrajectory as_is = LoadReference(sequence, ReferenceFrame::kCamera);
  EXPECT_NEAR(as_is.poses[1].world_from_camera.translation.x(), 1.0, 1e-12);
}

TEST(Reference, IsFoundWhereKittiIsDistributed) {
  const ScratchFolder folder;
  folder.Write("sequences/06/times.txt", "0\n0.1\n0.2\n");
  const std::string row = "1 0 0 0 0 1 0 0 0 0 1 ";
  folder.Write("poses/06.txt", row + "0\n" + row + "1\n" + row + "2\n");
  for (const char* sequence : {"sequences/06", "sequences/06/"}) {
    const ReferenceTrajectory reference = LoadReference(folder / sequence, std::nullopt);
    EXPECT_EQ(reference.format, TrajectoryFormat::kKitti);
    ASSERT_EQ(reference.poses.size(), 3U);
    EXPECT_EQ(reference.poses[1].stamp_ns, 100'000'000);
    EXPECT_TRUE(std::filesystem::equivalent(reference.path, folder / "poses/06.txt"));
  }
  // Poses in the folder go before.
  folder.Write("sequences/06/poses.txt", row + "5\n" + row + "6\n" + row + "7\n");
  const ReferenceTrajectory own = LoadReference(folder / "sequences/06", std::nullopt);
  EXPECT_EQ(own.poses[0].world_from_camera.translation.z(), 5);
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
  WriteRunList(folder.path(), {"frames.csv", "trajectory.txt"});
  EXPECT_FALSE(FramesOfRun(trajectory));
  folder.Write("frames.csv", "timestamp,state\n1.0,tracked\n1.05,tracked\n");
  EXPECT_EQ(FramesOfRun(trajectory), 2U);
}

TEST(Evaluate, KnowsTheRunOfASingleCamera) {
  const ScratchFolder folder;
  const auto trajectory = folder.Write("trajectory.txt", kTum);
  WriteRunList(folder.path(), {"summary.json", "trajectory.txt"});
  EXPECT_FALSE(IsMonocularRun(trajectory));
  for (const std::string other : {"{\"sensor\": \"stereo\"}", "{\"sensor\": 1}", "[]", "no json"}) {
    folder.Write("summary.json", other);
    EXPECT_FALSE(IsMonocularRun(trajectory)) << other;
  }
  folder.Write("summary.json", "{\"sensor\": \"mono\"}");
  EXPECT_TRUE(IsMonocularRun(trajectory));
}

TEST(Evaluate, BelievesATableOfFramesOnlyOfItsOwnRun) {
  const ScratchFolder folder;
  folder.Write("frames.csv", "timestamp,state\n1.0,tracked\n1.05,tracked\n1.1,lost\n");
  folder.Write("summary.json", "{\"sensor\": \"mono\"}");
  const auto copy = folder.Write("copy.txt", kTum), own = folder.Write("trajectory.txt", kTum);
  // Results that were copied to a folder without the list of the run's files go by their names.
  EXPECT_EQ(FramesOfRun(own), 3U);
  EXPECT_TRUE(IsMonocularRun(own));
  EXPECT_FALSE(FramesOfRun(copy));
  EXPECT_FALSE(IsMonocularRun(copy));
  WriteRunList(folder.path(), {"frames.csv", "summary.json", "trajectory.txt"});
  EXPECT_EQ(FramesOfRun(own), 3U);
  EXPECT_TRUE(IsMonocularRun(own));
  EXPECT_FALSE(FramesOfRun(copy));
  EXPECT_FALSE(IsMonocularRun(copy));
  folder.Write(".plumbline-run", "{}");  // none of ours
  EXPECT_FALSE(FramesOfRun(own));
  EXPECT_FALSE(IsMonocularRun(own));
  // A run of 0.2.0 that was killed.
  folder.Write(".plumbline-run", R"({"plumbline_run": 1, "complete": false, "files": []})");
  EXPECT_EQ(FramesOfRun(own), 3U);
  EXPECT_FALSE(FramesOfRun(copy));
}

// More poses than frames: the frames are those of something else.
TEST(Evaluate, CoverageIsNeverMoreThanAll) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  folder.Write("rgb.txt", "1.000 a.png\n1.050 b.png\n");
  const std::string json = (folder / "out.json").string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(EvaluateMessage({reference, reference, "--json", json}), "no error");
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("3 with a pose of an unknown number, 3 compared"));
  EXPECT_THAT(Contents(json), HasSubstr("\"coverage\": null"));
}

TEST(Evaluate, PointsAtAShorterWindowWhereNoneIsSpanned) {
  const ScratchFolder folder;
  const auto sequence = WriteEuroc(folder).string();
  const auto estimate = folder.Write("trajectory.txt", kTum).string();
  const auto table = [&](const std::string& window) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(EvaluateMessage({sequence, estimate, "--align", "none", "--delta", window}),
              "no error");
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_THAT(table("3s"),
              HasSubstr("RPE [m/s]       no pair of poses spans the window; --delta 1f compares "
                        "neighbouring poses\n"));
  EXPECT_THAT(table("9f"), HasSubstr("RPE [m/s]       no pair of poses spans the window\n"));
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

TEST(Evaluate, WritesOverNothingThatItReads) {
  const ScratchFolder folder;
  const auto reference = folder.Write("a/truth.txt", kTum).string();
  const auto estimate = folder.Write("b/trajectory.txt", kTum).string();
  folder.Write("b/summary.json", "{}");
  std::filesystem::create_symlink(estimate, folder / "link.json");
  for (const std::string& output : {reference,
                                    estimate,
                                    (folder / "b/../b/trajectory.txt").string(),
                                    (folder / "link.json").string(),
                                    (folder / "b/summary.json").string()}) {
    EXPECT_THAT(EvaluateMessage({reference, estimate, "--json", output}),
                testing::AllOf(HasSubstr("--json " + output + ": expected another file than "),
                               testing::EndsWith(", which is read")));
  }
  EXPECT_EQ(Contents(estimate), kTum);
  EXPECT_EQ(Contents(reference), kTum);
  // The name of a figure is looked at before the other results are written.
  EXPECT_THAT(EvaluateMessage({reference,
                               estimate,
                               "--json",
                               (folder / "out.json").string(),
                               "--plot",
                               (folder / "out.gif").string()}),
              HasSubstr("out.gif: expected a file name ending in .svg or .png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.json"));
}

TEST(Evaluate, WritesOverNothingOfTheRun) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const auto estimate = folder.Write("run/trajectory.txt", kTum).string();
  const std::string run = (folder / "run").string();
  const std::string map = folder.Write("run/map.plb", "the map").string();
  EXPECT_THAT(EvaluateMessage({reference, run, "--json", map}),
              HasSubstr(map + ": expected JSON of evaluate to replace, or a new file"));
  folder.Write("run/.plumbline-run", "{}");
  EXPECT_THAT(EvaluateMessage({reference, estimate, "--json", map}),
              HasSubstr(map + ": expected another name, found one that the results in"));
  EXPECT_EQ(Contents(map), "the map");
  testing::internal::CaptureStdout();
  EXPECT_EQ(EvaluateMessage({reference, run, "--json", run + "/error.json"}), "no error");
  EXPECT_EQ(EvaluateMessage({reference, run, "--json", run + "/error.json"}), "no error");
  testing::internal::GetCapturedStdout();
}

TEST(Evaluate, ReplacesNoDrawingOfOthers) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const std::string icon =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"24\" height=\"24\"/>\n";
  const std::string file = folder.Write("icon.svg", icon).string();
  EXPECT_THAT(EvaluateMessage({reference, reference, "--plot", file}),
              StartsWith("--plot " + file + ": expected "));
  EXPECT_EQ(Contents(file), icon);
}

TEST(Evaluate, ReplacesFilesOfTheirKindOnly) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const std::vector<std::pair<std::string, std::string>> outputs = {
      {"--json", "a.json"}, {"--json", "b.txt"}, {"--plot", "c.svg"}, {"--plot", "d.png"}};
  for (const auto& [option, name] : outputs) {
    const std::string file = folder.Write(name, "{\"mine\": \"<svg PNG\"}").string();
    EXPECT_THAT(EvaluateMessage({reference, reference, option, file}),
                StartsWith(option + " " + file + ": expected "));
    EXPECT_EQ(Contents(file), "{\"mine\": \"<svg PNG\"}") << file;
    std::filesystem::remove(file);
    testing::internal::CaptureStdout();
    EXPECT_EQ(EvaluateMessage({reference, reference, option, file}), "no error");
    EXPECT_EQ(EvaluateMessage({reference, reference, option, file}), "no error");
    testing::internal::GetCapturedStdout();
  }
}

TEST(Evaluate, WritesEachResultIntoAFileOfItsOwn) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const std::string plot = (folder / "a.svg").string(), same = (folder / "b/../a.svg").string();
  std::filesystem::create_directory(folder / "b");
  EXPECT_THAT(EvaluateMessage({reference, reference, "--plot", plot, "--json", same}),
              HasSubstr("--plot " + plot + ": expected another file than that of --json"));
  EXPECT_FALSE(std::filesystem::exists(plot));
}

TEST(Evaluate, FiguresOfAnySizeStandApart) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const auto far = folder
                       .Write("far.txt",
                              "1.000 1234567 0 0 0 0 0 1\n1.050 1234567 1 0 0 0 0 1\n"
                              "1.100 1234567 3 0 0 0 0 1\n")
                       .string();
  testing::internal::CaptureStdout();
  EXPECT_EQ(EvaluateMessage({reference, far, "--align", "none"}), "no error");
  const std::string table = testing::internal::GetCapturedStdout();
  EXPECT_THAT(table, HasSubstr("ATE [m]        1234566."));
  // Six decimals, then a space.
  EXPECT_THAT(table,
              testing::Not(testing::ContainsRegex("[.][0-9][0-9][0-9][0-9][0-9][0-9][0-9]")));
}

TEST(Evaluate, PlacesTooFarToCompareAreRefused) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  const auto far =
      folder.Write("far.txt", "1 1e308 0 0 0 0 0 1\n1.05 -1e308 0 0 0 0 0 1\n").string();
  EXPECT_THAT(EvaluateMessage({reference, far}),
              HasSubstr("far.txt:1: expected a coordinate within 1e+09 of 0 in column 2, found "
                        "'1e308'"));
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
      {{sequence, estimate, "--delta", ""}, "--delta: expected 3s|1f, found an empty argument"},
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

// Twenty poses on a curve; the last four of the estimate are of another scale than the others.
TEST(Evaluate, TellsTheDriftOfTheScaleOfASingleCamera) {
  const ScratchFolder folder;
  Trajectory reference, estimate;
  for (int i = 0; i < 20; ++i) {
    StampedPose pose;
    pose.stamp_ns = 1'000'000'000 + 50'000'000LL * i;
    pose.world_from_camera.translation = {1.0 * i, 0.1 * i * i, 0};
    reference.push_back(pose);
    pose.world_from_camera.translation *= i < 16 ? 0.5 : 0.55;
    estimate.push_back(pose);
  }
  WriteTum(folder / "reference.txt", reference);
  WriteTum(folder / "estimate.txt", estimate);
  const auto evaluate = [&](const std::string& align) {
    const std::vector<std::string> arguments = {(folder / "reference.txt").string(),
                                                (folder / "estimate.txt").string(),
                                                "--align",
                                                align,
                                                "--json",
                                                (folder / "out.json").string()};
    testing::internal::CaptureStdout();
    EXPECT_EQ(EvaluateCommand(arguments), 0);
    return testing::internal::GetCapturedStdout();
  };
  const std::string text = evaluate("sim3");
  EXPECT_THAT(text, HasSubstr(", drift of the scale 10.00 %\n"));
  EXPECT_THAT(text, testing::ContainsRegex("ATE .m. +[0-9]+[.][0-9][0-9][0-9][0-9][0-9][0-9] "));
  EXPECT_THAT(Contents(folder / "out.json"), HasSubstr("\"scale_drift\": 0.1"));
  EXPECT_THAT(evaluate("se3"), testing::Not(HasSubstr("drift of the scale")));
  EXPECT_THAT(Contents(folder / "out.json"), HasSubstr("\"scale_drift\": null"));
}

TEST(Evaluate, SaysWhereLinesAreCompared) {
  const ScratchFolder folder;
  const auto reference = folder.Write("truth.txt", kTum).string();
  for (const std::string option : {"--true-lines", "--lines", "--surfaces", "--plot-lines"}) {
    EXPECT_EQ(EvaluateMessage({reference, reference, option, "a.svg"}),
              "evaluate: " + option +
                  " is no option any more: plumbline lines SEQUENCE RUN compares lines, where the "
                  "laboratory is built");
  }
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

}  // namespace
}  // namespace plumbline
