// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/run_files.h"
#include "plumbline/report/sample_image.h"
#include "plumbline/report/summary.h"
#include "plumbline/report/timing.h"
#include "plumbline/slam/pipeline.h"

#include "tests/io/scratch_folder.h"
#include "tests/report/poster_run.h"
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

FrameRecord TimedFrame(std::int64_t id, std::vector<StageTime> times) {
  FrameRecord record;
  record.id = FrameId{id};
  record.stamp_ns = 1'305'031'102'175'304'000 + id;
  record.times = std::move(times);
  return record;
}

TEST(FormatFrames, OneRowForEveryFrame) {
  FrameRecord tracked = TimedFrame(0, {});
  tracked.status = FrameStatus::kTracked;
  tracked.map = MapId{2};
  tracked.keyframe = true;
  tracked.counts = {5, 4, 3, 2};
  FrameRecord lost = TimedFrame(1, {});
  lost.status = FrameStatus::kLost;
  lost.reason = "too_few_inliers";
  FrameRecord skipped = TimedFrame(2, {});
  skipped.reason = "image_unreadable";
  FrameRecord hurried = TimedFrame(3, {});
  hurried.status = FrameStatus::kTracked;
  hurried.map = MapId{2};
  hurried.shed = LoadLevel::kLines;
  FrameRecord dropped = TimedFrame(4, {});
  dropped.reason = "dropped";
  dropped.shed = LoadLevel::kFrame;
  Atlas atlas;
  for (int map = 0; map < 3; ++map) atlas.Start();
  atlas.Join(MapId{1}, MapId{2}, {});
  EXPECT_EQ(FormatFrames({tracked, lost, skipped, hurried, dropped}, atlas),
            "frame,timestamp,state,map,reason,keyframe,matched_points,matched_lines,"
            "inlier_points,inlier_lines,shed,final_map\n"
            "0,1305031102.175304000,tracked,2,,1,5,4,3,2,,1\n"
            "1,1305031102.175304001,lost,,too_few_inliers,0,0,0,0,0,,\n"
            "2,1305031102.175304002,skipped,,image_unreadable,0,0,0,0,0,,\n"
            "3,1305031102.175304003,tracked,2,,0,0,0,0,0,lines,1\n"
            "4,1305031102.175304004,skipped,,dropped,0,0,0,0,0,frame,\n");
}

TEST(Timing, StatisticsAreOfTheFramesInWhichAStageRan) {
  FrameLog frames;
  for (int i = 1; i <= 100; ++i) {
    std::vector<StageTime> times = {{"track", static_cast<double>(i)}, {"total", 2.0 * i}};
    // Twice in one frame: 10.
    if (i == 1) times.insert(times.begin(), {{"map", 3}, {"map", 7}});
    frames.Add(TimedFrame(i - 1, std::move(times)));
  }
  const auto statistics = TimingStatistics(frames);
  ASSERT_EQ(statistics.size(), 3U);
  EXPECT_EQ(statistics[0].stage, "map");
  EXPECT_EQ(statistics[0].count, 1U);
  EXPECT_EQ(statistics[0].median, 10);
  EXPECT_EQ(statistics[1].stage, "track");
  EXPECT_EQ(statistics[1].count, 100U);
  EXPECT_EQ(statistics[1].median, 50.5);  // the mean of the two in the middle
  EXPECT_EQ(statistics[1].p95, 95);
  EXPECT_EQ(statistics[1].p99, 99);
  EXPECT_EQ(statistics[1].max, 100);
  EXPECT_EQ(statistics[1].mean, 50.5);
  EXPECT_EQ(statistics[2].stage, "total");
  EXPECT_TRUE(TimingStatistics({}).empty());
}

TEST(Timing, FilesHaveAColumnForEachStage) {
  const FrameLog frames = {
      TimedFrame(0, {{"track", 1.5}, {"total", 2}}),
      TimedFrame(1, {}),
      TimedFrame(2, {{"track", 1}, {"map", 0.25}, {"map", 0.5}, {"total", 3}})};
  EXPECT_EQ(FormatTimingCsv(frames),
            "frame,timestamp,track_ms,map_ms,total_ms\n"
            "0,1305031102.175304000,1.500,,2.000\n"
            "1,1305031102.175304001,,,\n"
            "2,1305031102.175304002,1.000,0.750,3.000\n");
  const auto json = nlohmann::json::parse(FormatTimingJson(frames));
  EXPECT_EQ(json["track"]["frames"], 2);
  EXPECT_EQ(json["total"]["max_ms"], 3);
  for (const char* key : {"frames", "median_ms", "p95_ms", "p99_ms", "max_ms", "mean_ms"}) {
    EXPECT_TRUE(json["map"].contains(key)) << key;
  }
}

std::size_t Rows(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(CountRun, CountsEveryFrameOnce) {
  const PosterRun run;
  const RunCounts counts = CountRun(run.result());
  EXPECT_EQ(counts.frames, 6);
  EXPECT_EQ(counts.tracked, 4);
  EXPECT_EQ(counts.skipped, 1);
  EXPECT_EQ(counts.lost, 1);
  EXPECT_EQ(counts.initializing, 0);
  EXPECT_EQ(counts.maps, 1);
  EXPECT_GE(counts.keyframes, 1);
  EXPECT_GT(counts.points, 50);
}

TEST(SecondsSinceProcessStart, GoesOnWithTime) {
  const auto before = SecondsSinceProcessStart();
  ASSERT_TRUE(before);
  EXPECT_GT(*before, -0.02);  // the start is known to a tick
  EXPECT_LT(*before, 600);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_GT(*SecondsSinceProcessStart() - *before, 0.04);
}

TEST(CountRun, TellsDroppedFramesFromOthersThatWereSkipped) {
  System system(MovingPoster::MakeCalibration(), SlamOptions{});
  system.Skip(MovingPoster::StampNs(0), "image_unreadable");
  system.Skip(MovingPoster::StampNs(1), Pipeline::kDropped, LoadLevel::kFrame);
  const RunCounts counts = CountRun(system.Finish());
  EXPECT_EQ(counts.skipped, 2);
  EXPECT_EQ(counts.dropped, 1);
}

TEST(Summary, HoldsTheFieldsOfTheInterface) {
  const PosterRun run;
  const PosterDataset dataset(6);
  const std::string text = FormatSummary(
      {"0.1.0", "some/folder", "slam:\n  seed: 3\n", 3},
      run.result(),
      dataset,
      {.wall_seconds = 1.5, .first_pose_seconds = 0.2, .cpu_seconds = 2.5, .peak_memory_mb = 30});
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["version"], "0.1.0");
  EXPECT_EQ(json["data"], "some/folder");
  EXPECT_EQ(json["sensor"], "stereo");
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["options"], "slam:\n  seed: 3\n");
  EXPECT_EQ(json["frames"]["in"], 6);
  EXPECT_EQ(json["frames"]["tracked"], 4);
  EXPECT_EQ(json["frames"]["lost"], 1);
  EXPECT_EQ(json["frames"]["skipped"], 1);
  EXPECT_EQ(json["frames"]["dropped"], 0);
  for (const char* what : {"mapping", "lines", "points", "frames", "keyframes"}) {
    EXPECT_EQ(json["shed"][what], 0) << what;
  }
  EXPECT_EQ(json["mode"], "lockstep");
  EXPECT_EQ(json["first_pose_seconds"], 0.2);
  EXPECT_EQ(json["wall_seconds"], 1.5);
  EXPECT_EQ(json["cpu_seconds"], 2.5);
  EXPECT_EQ(json["peak_memory_mb"], 30);
  for (const char* key : {"maps", "keyframes", "points", "lines"}) {
    EXPECT_TRUE(json[key].is_number_integer()) << key;
  }
  for (const char* key : {"loops", "joins", "relocalizations"}) {
    EXPECT_TRUE(json[key].is_array()) << key;
  }
  const auto& accuracy = json["accuracy"];
  EXPECT_EQ(accuracy["alignment"], "se3");
  EXPECT_EQ(accuracy["associated"], 4);
  EXPECT_NEAR(accuracy["coverage"], 4.0 / 6, 1e-9);
  EXPECT_EQ(accuracy["ate"]["unit"], "m");
  EXPECT_LT(accuracy["ate"]["rmse"], 0.01);
  EXPECT_FALSE(accuracy.contains("rpe"));  // shorter than the window
  const auto& causal = json["accuracy_causal"];
  EXPECT_EQ(causal["associated"], 4);
  EXPECT_LT(causal["ate"]["rmse"], 0.02);
  for (const char* key : {"median_ms", "p95_ms", "p99_ms"}) {
    EXPECT_GT(json["timing"]["total"][key], 0) << key;
  }
}

TEST(Summary, TellsWhetherAllFramesWereTaken) {
  const PosterRun run;
  RunDescription description;
  description.frames_chosen = 6;
  auto json = nlohmann::json::parse(FormatSummary(description, run.result(), PosterDataset(6), {}));
  EXPECT_TRUE(json["interrupted"].is_null());
  EXPECT_EQ(json["frames"]["of"], 6);
  description.frames_chosen = 200;
  description.interrupted = "SIGTERM";
  json = nlohmann::json::parse(FormatSummary(description, run.result(), PosterDataset(6), {}));
  EXPECT_EQ(json["interrupted"], "SIGTERM");
  EXPECT_EQ(json["frames"]["of"], 200);
  EXPECT_EQ(json["frames"]["in"], 6);
}

TEST(Summary, NamesThePreset) {
  const PosterRun run;
  RunDescription description;
  auto json = nlohmann::json::parse(FormatSummary(description, run.result(), PosterDataset(6), {}));
  EXPECT_TRUE(json.at("preset").is_null());
  description.preset = "rippl";
  json = nlohmann::json::parse(FormatSummary(description, run.result(), PosterDataset(6), {}));
  EXPECT_EQ(json["preset"], "rippl");
}

TEST(Summary, TellsTheMemoryOfALine) {
  const PosterRun run;
  const auto line_bytes = [](const PosterRun& of) {
    return nlohmann::json::parse(
        FormatSummary({}, of.result(), PosterDataset(6), {}))["line_bytes"];
  };
  const auto bytes = line_bytes(run);
  EXPECT_GT(bytes["map"], sizeof(MapLine));
  EXPECT_LT(bytes["map"], 2 * sizeof(MapLine));
  EXPECT_GT(bytes["adjustment"], 0);
  SlamOptions no_lines;
  no_lines.features.lines = false;
  const PosterRun points(no_lines);
  const LineMemory memory = MeasureLineMemory(points.result());
  EXPECT_FALSE(memory.map.has_value());
  EXPECT_FALSE(memory.adjustment.has_value());
  EXPECT_TRUE(line_bytes(points)["map"].is_null());
  EXPECT_TRUE(line_bytes(points)["adjustment"].is_null());
}

TEST(Summary, SaysNullWithoutGroundTruth) {
  const PosterRun run;
  const auto json =
      nlohmann::json::parse(FormatSummary({}, run.result(), PosterDataset(6, false), {}));
  EXPECT_TRUE(json["accuracy"].is_null());
  EXPECT_TRUE(json["accuracy_causal"].is_null());
}

// Sees the left end of the poster, is lost for long, sees the right end in a map of its own, and is
// found again at the left end.
class AwayAndBack {
 public:
  static constexpr int kStretch = 12, kFrames = 3 * kStretch + 14 + 4;

  AwayAndBack() {
    Show(0, kStretch);
    Show(std::nullopt, 14);
    Show(118, kStretch);
    Show(std::nullopt, 4);
    Show(0, kStretch);
    result_ = system_.Finish();
  }
  const RunResult& result() const { return result_; }

 private:
  static SlamOptions Options() {
    SlamOptions options;
    options.slam.mode = RunMode::kInline;
    options.loop.enabled = false;  // or the two ends, which share some corners, would be joined
    return options;
  }
  // The poster from this frame of it on, or another place.
  void Show(std::optional<int> first, int frames) {
    for (int i = 0; i < frames; ++i) {
      SensorFrame frame = first ? poster_.Frame(*first + i) : MovingPoster::StrangeFrame(0);
      frame.stamp_ns = MovingPoster::StampNs(shown_++);
      system_.Process(std::move(frame));
    }
  }

  MovingPoster poster_;
  System system_{MovingPoster::MakeCalibration(), Options()};
  RunResult result_;
  int shown_ = 0;
};

TEST(Summary, CoverageIsThatOfTheTrajectoryWhoseErrorsItTells) {
  const AwayAndBack run;
  const RunResult& result = run.result();
  const RunCounts counts = CountRun(result);
  ASSERT_EQ(counts.frames, AwayAndBack::kFrames);
  ASSERT_EQ(counts.maps, 2);
  const MapId main = result.MainMap().value();
  const auto poses = static_cast<double>(result.FinalTrajectory(main).size());
  EXPECT_EQ(counts.in_trajectory, poses);
  EXPECT_LT(counts.in_trajectory, counts.tracked);  // the others are in the other map
  const auto json =
      nlohmann::json::parse(FormatSummary({}, result, PosterDataset(AwayAndBack::kFrames), {}));
  EXPECT_EQ(json["frames"]["in_trajectory"], poses);
  EXPECT_NEAR(json["accuracy"]["coverage"], poses / AwayAndBack::kFrames, 1e-9);
  EXPECT_NEAR(json["accuracy_causal"]["coverage"],
              static_cast<double>(result.CausalTrajectory(main).size()) / AwayAndBack::kFrames,
              1e-9);
}

TEST(Summary, CountsTheFramesAtWhichTheCameraWasFoundAgain) {
  const AwayAndBack run;
  const auto json = nlohmann::json::parse(
      FormatSummary({}, run.result(), PosterDataset(AwayAndBack::kFrames), {}));
  EXPECT_GE(json["frames"]["relocalized"], 1);
  EXPECT_EQ(json["frames"]["relocalized"], json["relocalizations"].size());
}

TEST(Summary, SaysWhetherThePositionsDetermineTheAlignment) {
  const PosterRun run;
  DatasetInfo info = PosterDataset(6).info();
  const auto degenerate = [&] {
    const PosterDataset dataset(info);
    return nlohmann::json::parse(
        FormatSummary({}, run.result(), dataset, {}))["accuracy"]["degenerate"];
  };
  EXPECT_EQ(degenerate(), "all positions on a line");  // the truth is straight
  for (std::size_t i = 0; i < 6; ++i) {
    info.ground_truth->poses[i].world_from_camera.translation.y() = i % 2 == 0 ? 0.01 : 0;
  }
  EXPECT_TRUE(degenerate().is_null());
}

std::vector<RunFile> AllFiles(const RunResult& result) {
  std::vector<RunFile> files = PoseFiles(result);
  files.push_back(MapFile(result));
  const std::vector<RunFile> derived = DerivedFiles(result);
  files.insert(files.end(), derived.begin(), derived.end());
  return files;
}

TEST(RunFiles, AreAllThereAndComplete) {
  const PosterRun run;
  const ScratchFolder folder;
  for (const RunFile& file : AllFiles(run.result())) {
    EXPECT_TRUE(IsRunFile(file.name)) << file.name;
    file.write(folder / file.name);
  }
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.insert(entry.path().filename().string());
  }
  for (const char* name : {"trajectory.txt",
                           "trajectory_causal.txt",
                           "keyframes.txt",
                           "trajectory_covariance.txt",
                           "frames.csv",
                           "timing.csv",
                           "timing.json",
                           "map.plb",
                           "map.ply",
                           "lines.obj",
                           "lines.dxf"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  EXPECT_EQ(Rows(Contents(folder / "trajectory.txt")), 4U);
  EXPECT_EQ(Rows(Contents(folder / "trajectory_causal.txt")), 4U);
  EXPECT_EQ(Rows(Contents(folder / "frames.csv")), 7U);
  EXPECT_EQ(Rows(Contents(folder / "timing.csv")), 7U);
  EXPECT_EQ(Contents(folder / "trajectory.txt").substr(0, 12), "1.000000000 ");
  for (const std::string& name : names) EXPECT_EQ(name.find("tmp"), std::string::npos) << name;
}

// One row for each causal pose but the first, which starts the map.
TEST(RunFiles, CovariancesHaveTheStampsOfTheCausalPoses) {
  const PosterRun run;
  {
    const ScratchFolder folder;
    for (const RunFile& file : PoseFiles(run.result())) file.write(folder / file.name);
    std::vector<std::string> stamps;
    for (const StampedPose& pose : ReadTrajectory(folder / "trajectory_causal.txt").poses) {
      stamps.push_back(FormatStamp(pose.stamp_ns));
    }
    stamps.erase(stamps.begin());
    std::vector<std::string> found;
    std::istringstream text(Contents(folder / "trajectory_covariance.txt"));
    for (std::string row; std::getline(text, row);) {
      std::istringstream fields(row);
      fields >> found.emplace_back();
      Matrix6d covariance;
      for (int k = 0; k < 36; ++k) fields >> covariance(k / 6, k % 6);
      EXPECT_TRUE(fields) << row;
      EXPECT_EQ(covariance, Matrix6d(covariance.transpose()));
      EXPECT_EQ(Eigen::LLT<Matrix6d>(covariance).info(), Eigen::Success);
    }
    EXPECT_EQ(found, stamps);
  }
}

TEST(RunFiles, AreThereWithoutAnyPose) {
  const RunResult result = System(MovingPoster::MakeCalibration(), {}).Finish();
  const ScratchFolder folder;
  for (const RunFile& file : AllFiles(result)) file.write(folder / file.name);
  EXPECT_EQ(Contents(folder / "trajectory.txt"), "");
  EXPECT_EQ(Contents(folder / "keyframes.txt"), "");
  EXPECT_EQ(Rows(Contents(folder / "frames.csv")), 1U);
}

TEST(RunFiles, MapsThatAreOnlyReadHaveTheBytesThatWereLoaded) {
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  const MovingPoster poster;
  System mapped(MovingPoster::MakeCalibration(), options);
  for (int i = 0; i < 40; ++i) mapped.Process(poster.Frame(i));
  RunResult made = mapped.Finish();
  SavedAtlas saved{std::move(made.atlas), std::move(made.context)};
  saved.atlas.Start();  // the one to go on with; the camera is in the other one
  const ScratchFolder folder;
  SaveAtlas(folder / "loaded.plb", saved.atlas, saved.context);
  System system(MovingPoster::MakeCalibration(), options);
  system.Continue(std::move(saved), true);
  for (int i = 8; i < 40; ++i) system.Process(poster.Frame(i));
  const RunResult result = system.Finish();
  ASSERT_EQ(result.MainMap(), MapId{0});
  MapFile(result).write(folder / "map.plb");
  EXPECT_TRUE(Contents(folder / "map.plb") == Contents(folder / "loaded.plb"));
}

TEST(RunFiles, SayWhichFileCannotBeWritten) {
  const PosterRun run;
  const ScratchFolder folder;
  const auto file = folder.Write("file", "not a folder");
  for (const RunFile& written : AllFiles(run.result())) {
    const std::string message = MessageOf([&] { written.write(file / written.name); });
    EXPECT_NE(message.find(written.name), std::string::npos) << message;
  }
}

TEST(RunFiles, ThoseWorthMostForTheirSizeComeFirst) {
  const PosterRun run;
  const std::vector<RunFile> files = PoseFiles(run.result());
  ASSERT_EQ(files.size(), 5U);
  EXPECT_EQ(files[0].name, "trajectory.txt");
  EXPECT_EQ(files[1].name, "trajectory_causal.txt");
  EXPECT_EQ(files[2].name, "keyframes.txt");
  EXPECT_EQ(files[3].name, "frames.csv");
  EXPECT_EQ(files[4].name, "trajectory_covariance.txt");
}

TEST(Overlay, IsWrittenForTheLastFrame) {
  const PosterRun run;
  const ScratchFolder folder;
  WriteFeatureOverlay(run.view(), folder / "overlay.png");
  EXPECT_EQ(Contents(folder / "overlay.png").substr(1, 3), "PNG");
  const auto mean = [](const std::filesystem::path& file) {
    const auto image = ReadGrayImage(file);
    const auto pixels = static_cast<std::ptrdiff_t>(image->width()) * image->height();
    return std::accumulate(image->data(), image->data() + pixels, 0.0) /
           static_cast<double>(pixels);
  };
  // What the mask of a frame leaves out is dark.
  FrameView masked = run.view();
  GrayImage mask(masked.images.left.width(), masked.images.left.height(), 255);
  masked.images.left_mask = mask;
  WriteFeatureOverlay(masked, folder / "white.png");
  EXPECT_EQ(Contents(folder / "white.png"), Contents(folder / "overlay.png"));
  masked.images.left_mask = GrayImage(mask.width(), mask.height());
  WriteFeatureOverlay(masked, folder / "black.png");
  EXPECT_LT(mean(folder / "black.png"), 0.7 * mean(folder / "overlay.png"));
}

}  // namespace
}  // namespace plumbline
