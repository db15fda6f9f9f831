// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/run_line_map.h"
#include "plumbline/base/error.h"
#include "plumbline/io/export/obj_lines.h"
#include "plumbline/io/geometry_files.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"
#include "worlds/true_world.h"

#include "apps/commands.h"
#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include "tests/support/true_map.h"
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace lines_test {

using testing::HasSubstr;

std::string LinesMessage(const std::vector<std::string>& arguments) {
  return MessageOf([&] { LinesCommand(arguments); });
}

std::vector<Segment3> Moved(const Similarity3& to, std::vector<Segment3> segments) {
  for (Segment3& segment : segments) segment = {to * segment.start, to * segment.end};
  return segments;
}

// A run in a world of its own: the reference world is turned, moved and 1 / scale as large.
struct LineRun {
  ScratchFolder folder;
  std::filesystem::path sequence = folder / "seq", run = folder / "run";

  explicit LineRun(double scale = 1) {
    const Similarity3 run_from_reference{
        scale, ExpSo3({0.3, -0.5, 0.2}), Eigen::Vector3d(4, -1, 2)};
    WriteSequenceFolder(folder, "seq");
    const std::vector<TrueLine> truth = {
        {{{0, 0, 1}, {2, 0, 1}}, TrueLineKind::kGeometry, {{{0, 3}}}},
        {{{0, 1, 1}, {2, 1, 1}}, TrueLineKind::kTexture, {{{0, 3}}}},
        {{{0, 2, 1}, {2, 2, 1}}, TrueLineKind::kTexture, {{{2, 2}}}}};
    WriteTrueLines(sequence / "lines.csv", truth);
    WriteSurfaces(sequence / "surfaces.csv",
                  std::vector<Parallelogram>{{{-9, -9, 1}, {18, 0, 0}, {0, 18, 0}}});
    WriteRun(run_from_reference, TruePoses());
    // The first and the third true line, and one in the air.
    WriteObjLines(
        run / "lines.obj",
        Moved(run_from_reference, {truth[0].segment, truth[2].segment, {{0, 0, 5}, {0, 2, 5}}}));
  }

  static Trajectory TruePoses() {
    Trajectory poses(3);
    poses[1].world_from_camera.translation = {1, 0, 0};
    poses[2].world_from_camera.translation = {1, 1, 0};
    for (int i = 0; i < 3; ++i) {
      poses[static_cast<std::size_t>(i)].stamp_ns = 1'000'000'000 + 50'000'000LL * i;
    }
    return poses;
  }

  // Ground truth of the sequence, and a run with these poses in another world.
  void WriteRun(const Similarity3& run_from_reference, const Trajectory& poses) const {
    std::string csv = "#timestamp,px,py,pz,qw,qx,qy,qz\n";
    for (const StampedPose& pose : TruePoses()) {
      const Eigen::Vector3d& p = pose.world_from_camera.translation;
      csv += fmt::format("{},{},{},{},1,0,0,0\n", pose.stamp_ns, p.x(), p.y(), p.z());
    }
    folder.Write("seq/mav0/state_groundtruth_estimate0/data.csv", csv);
    Trajectory moved = poses;
    for (StampedPose& pose : moved) {
      pose.world_from_camera = TransformPose(run_from_reference, pose.world_from_camera);
    }
    folder.Write("run/summary.json", "{\"sensor\": \"stereo\"}");
    WriteTum(run / "trajectory.txt", moved);
  }

  // The table of a comparison, the JSON after it.
  std::string Lines(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {sequence.string(), run.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"--json", (folder / "out.json").string()});
    testing::internal::CaptureStdout();
    EXPECT_EQ(LinesCommand(arguments), 0);
    return testing::internal::GetCapturedStdout() + Contents(folder / "out.json");
  }
};

TEST(Lines, AreComparedInTheWorldOfTheTruth) {
  const LineRun run;
  const std::string text = run.Lines();
  EXPECT_THAT(text,
              HasSubstr("lines       3 segments, 6.0 m, aligned by poses\n"
                        "true lines  3, 6.0 m; asked for 2, 4.0 m (seen in 3 frames or"));
  EXPECT_THAT(text,
              HasSubstr("within [cm]                  1         2         5        10\n"
                        "recall [%]                50.0      50.0      50.0      50.0\n"
                        "  geometry               100.0     100.0     100.0     100.0\n"
                        "  texture                  0.0       0.0       0.0       0.0\n"
                        "precision [%]             66.7      66.7      66.7      66.7\n"
                        "with counterpart             2         2         2         2\n"
                        "  angle [deg]             0.00      0.00      0.00      0.00\n"));
  EXPECT_THAT(text,
              HasSubstr("uncovered at 10 cm  2.0 m; from the nearest surface "
                        "400.0 cm (median), 100.0 % further than 5.0 cm\n"));
  EXPECT_THAT(text, HasSubstr("\"asked_lines\": 2"));
  EXPECT_THAT(text, HasSubstr("\"shadow\": null"));
  EXPECT_THAT(text, HasSubstr("\"share_beyond_limit\": 1.0"));
}

TEST(Lines, OfASingleCameraTakeTheScaleOfTheAlignment) {
  const LineRun half(0.5);
  EXPECT_THAT(half.Lines(), HasSubstr("recall [%]                 0.0"));
  half.folder.Write("run/summary.json", "{\"sensor\": \"mono\"}");
  EXPECT_THAT(half.Lines(), HasSubstr("recall [%]                50.0"));
}

TEST(Lines, AreAskedForWhereKeyFramesSeeThem) {
  const LineRun run;
  std::filesystem::copy_file(run.run / "trajectory.txt", run.run / "keyframes.txt");
  EXPECT_THAT(run.Lines(), HasSubstr("(seen from within 6 m in 5 or more of 3 keyframes)"));
}

// A turn about the line of the path, which only orientations tell.
TEST(Lines, AreAlignedByPoses) {
  const LineRun run;
  Trajectory poses = LineRun::TruePoses();
  for (StampedPose& pose : poses) pose.world_from_camera.translation *= 0.01;
  poses[2].world_from_camera.translation.z() += 0.002;
  std::string csv;
  for (const StampedPose& pose : LineRun::TruePoses()) {
    const Eigen::Vector3d p = 0.01 * pose.world_from_camera.translation;
    csv += fmt::format("{},{},{},{},1,0,0,0\n", pose.stamp_ns, p.x(), p.y(), p.z());
  }
  run.WriteRun({}, poses);
  run.folder.Write("seq/mav0/state_groundtruth_estimate0/data.csv", csv);
  WriteObjLines(run.run / "lines.obj", std::vector<Segment3>{{{0, 0, 1}, {2, 0, 1}}});
  EXPECT_THAT(run.Lines(), HasSubstr("precision [%]            100.0"));
}

TEST(Lines, ComeFromAFileThatIsNamed) {
  const LineRun run;
  const std::string other = (run.folder / "other.obj").string();
  WriteObjLines(other, std::vector<Segment3>{{{0, 0, 1}, {1, 0, 1}}});
  EXPECT_THAT(run.Lines({"--lines", other}), HasSubstr("1 segments, 1.0 m"));
  std::filesystem::remove(run.sequence / "surfaces.csv");
  EXPECT_THAT(run.Lines(), HasSubstr("uncovered at 10 cm  2.0 m\n"));
}

TEST(Lines, ComeFromAMapFile) {
  const LineRun run;
  run.WriteRun({}, LineRun::TruePoses());  // in the world of the truth
  const SyntheticWorld world = MakeSyntheticWorld(0, 20);
  const Map map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(20)}, {}).map;
  ASSERT_GT(map.lines().size(), 5U);
  SaveMap(run.folder / "map.plb", world.camera, Eigen::Quaterniond::Identity(), map);
  std::vector<TrueLine> truth;
  for (const SyntheticWorld::Line& line : world.lines) truth.push_back({line.segment});
  WriteTrueLines(run.sequence / "lines.csv", truth);
  const std::string text = run.Lines({"--lines", (run.folder / "map.plb").string()});
  EXPECT_THAT(text, HasSubstr("lines       " + std::to_string(map.lines().size()) + " segments"));
  EXPECT_THAT(text, HasSubstr("precision [%]            100.0     100.0     100.0     100.0"));
}

TEST(Lines, AreDrawnAndPrintedAsJson) {
  const LineRun run;
  const std::string file = (run.folder / "lines.svg").string();
  run.Lines({"--plot", file});
  run.Lines({"--plot", file});  // takes the place of its own kind
  EXPECT_THAT(Contents(file), HasSubstr("with counterpart"));
  EXPECT_THAT(Contents(file), HasSubstr("from the side"));
  testing::internal::CaptureStdout();
  EXPECT_EQ(LinesMessage({run.sequence.string(), run.run.string(), "--json", "-"}), "no error");
  const auto json = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(json["segments"], 3);
  EXPECT_EQ(json["tolerances"][2]["tolerance_m"], 0.05);
}

TEST(Lines, NameWhatIsMissingAndWriteOverNothing) {
  const LineRun run;
  const std::string sequence = run.sequence.string(), folder = run.run.string(),
                    lines = (run.run / "lines.obj").string(),
                    image = (run.sequence / "mav0/cam0/data/0.png").string();
  std::filesystem::create_directories(run.folder / "empty");
  const std::string empty = (run.folder / "empty").string();
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{sequence}, "lines: expected RUN"},
      {{empty, folder}, "empty: expected lines.csv with the true lines of the world, found none"},
      {{sequence, empty}, "empty: expected trajectory.txt of the run whose lines are compared"},
      {{sequence, folder, "--lines", (run.sequence / "lines.csv").string()},
       "lines.csv: expected a file name ending in .obj or .plb"},
      {{sequence, folder, "--lines", (run.folder / "no.obj").string()}, "no.obj: no such file"},
      {{sequence, folder, "--plot", "x.gif"}, "ending in .svg or .png"},
      {{sequence, folder, "--plot", image}, "expected a file outside of " + sequence},
      {{sequence, folder, "--json", sequence + "/new.json"},
       "expected a file outside of " + sequence},
      {{sequence, folder, "--json", lines}, "--json " + lines + ": expected"}};
  for (const auto& [arguments, message] : cases) {
    EXPECT_THAT(LinesMessage(arguments), HasSubstr(message));
  }
  EXPECT_THAT(Contents(image), testing::StartsWith("\x89PNG"));
  EXPECT_THAT(Contents(lines), HasSubstr("v "));
  run.folder.Write("run/trajectory.txt", "900 0 0 0 0 0 0 1\n");
  EXPECT_THAT(LinesMessage({sequence, folder}), HasSubstr("expected ground truth of poses in "));
}

}  // namespace lines_test
}  // namespace plumbline
