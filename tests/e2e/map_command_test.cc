// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"

#include "tests/e2e/poster_run.h"
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(MapInfo, TellsWhatIsInTheFile) {
  const ScratchFolder folder;
  const SavedMap saved = LoadMap(Posters().map);
  ASSERT_GT(saved.map.keyframes().size(), 2U);
  const Outcome outcome = RunProgram(
      folder, "map info " + Quoted(Posters().map) + " --json " + Quoted(folder / "i.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(fmt::format("version {}, ", saved.version)));
  EXPECT_THAT(outcome.out, HasSubstr("400x300, fx 300 fy 300 cx 200 cy 150"));
  EXPECT_THAT(outcome.out, HasSubstr("baseline      0.1200 m"));
  EXPECT_THAT(outcome.out, HasSubstr("time          1.000000000 to "));
  const auto json = nlohmann::json::parse(Contents(folder / "i.json"));
  EXPECT_EQ(json["bytes"], fs::file_size(Posters().map));
  EXPECT_EQ(json["camera"]["fx"], 300.0);
  ASSERT_EQ(json["maps"].size(), 1U);
  const auto& map = json["maps"][0];
  EXPECT_EQ(map["keyframes"], saved.map.keyframes().size());
  EXPECT_EQ(map["points"], saved.map.points().size());
  EXPECT_EQ(map["lines"], saved.map.lines().size());
  EXPECT_EQ(map["first_keyframe_s"], "1.000000000");
  EXPECT_GT(map["mean_reprojection_px"], 0.0);
  EXPECT_LT(map["mean_reprojection_px"], 2.0);
  // The camera goes sideways, 3 cm a frame, before a poster at 3 m.
  EXPECT_NEAR(map["path_length"].get<double>(),
              PathLength(ReadTrajectory(Posters().out / "keyframes.txt").poses),
              1e-6);
  EXPECT_NEAR(map["bounds_of_middle_90_percent"]["min"][2].get<double>(), 3, 0.3);
  EXPECT_NEAR(map["bounds_of_middle_90_percent"]["max"][2].get<double>(), 3, 0.3);
  EXPECT_LE(map["bounds"]["min"][0], map["bounds_of_middle_90_percent"]["min"][0]);
}

TEST(MapMerge, PutsTheSecondBehindTheFirst) {
  const ScratchFolder folder;
  const std::string files = Quoted(Posters().map) + " " + Quoted(Posters().map);
  const Outcome outcome =
      RunProgram(folder,
                 "map merge " + files + " --transform '0 -2 0  0 0 0.6 0.8' --out " +
                     Quoted(folder / "both.plb"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const SavedMap one = LoadMap(Posters().map), both = LoadMap(folder / "both.plb");
  both.map.CheckInvariants();
  EXPECT_EQ(both.map.keyframes().size(), 2 * one.map.keyframes().size());
  EXPECT_EQ(both.map.points().size(), 2 * one.map.points().size());
  const auto& [id, point] = *one.map.points().begin();
  const MapPoint* moved = both.map.Find(PointId{id.value + one.map.NextPointId().value});
  ASSERT_NE(moved, nullptr);
  const Eigen::Vector3d& p = point.position;
  const double c = 0.8 * 0.8 - 0.6 * 0.6, s = 2 * 0.6 * 0.8;  // half angles in the quaternion
  const Eigen::Vector3d expected(c * p.x() - s * p.y(), s * p.x() + c * p.y() - 2, p.z());
  EXPECT_LT((moved->position - expected).norm(), 1e-9);

  // The merged map is one like any other.
  const Outcome info = RunProgram(folder, "map info " + Quoted(folder / "both.plb"));
  EXPECT_EQ(info.code, 0);
  EXPECT_THAT(info.out, HasSubstr(fmt::format("keyframes     {}\n", both.map.keyframes().size())));
  const std::string rest = Quoted(folder / "both.plb") + " --out ";
  const Outcome tum =
      RunProgram(folder, "map export --to tum " + rest + Quoted(folder / "both.txt"));
  EXPECT_THAT(tum.out, HasSubstr("of the same times left out"));
  EXPECT_EQ(Contents(folder / "both.txt"), Contents(Posters().out / "keyframes.txt"));
  const Outcome colmap =
      RunProgram(folder,
                 "map export --to colmap --images " + Quoted(Posters().sequence) + " " + rest +
                     Quoted(folder / "both"));
  EXPECT_EQ(colmap.code, 0) << colmap.err;
  EXPECT_EQ(FilesOf(folder / "both/images").size(), both.map.keyframes().size());
}

// Where the camera is at a time of the poster sequence, in the world of its first frame.
Eigen::Vector3d PosterPlace(std::int64_t stamp_ns) {
  const auto turn = static_cast<int>((stamp_ns - 1'000'000'000) / 50'000'000 % 22);
  return {MovingPoster::kStep * std::min(turn, 22 - turn), 0, 0};
}

// Runs over parts of the poster sequence that overlap.
TEST(MapMerge, FindsWhatBothMapsShow) {
  const ScratchFolder folder;
  const auto run = [&](const std::string& part, const std::string& out) {
    const Outcome outcome = RunProgram(folder,
                                       "run " + Quoted(Posters().sequence) + " --quiet " + part +
                                           " --out " + Quoted(folder / out));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  };
  run("--to 15", "a");
  run("--from 6", "b");
  const fs::path both = folder / "both.plb";
  const Outcome outcome = RunProgram(folder,
                                     "map merge " + Quoted(folder / "a/map.plb") + " " +
                                         Quoted(folder / "b/map.plb") + " --out " + Quoted(both));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("show the same places; first_from_second"));
  const SavedAtlas a = LoadAtlas(folder / "a/map.plb"), b = LoadAtlas(folder / "b/map.plb");
  const SavedAtlas merged = LoadAtlas(both);
  EXPECT_EQ(merged.context.sessions.size(), 2U);
  EXPECT_EQ(merged.context.feature_format, a.context.feature_format);
  const Map& map = merged.atlas.active();
  map.CheckInvariants();
  EXPECT_EQ(map.keyframes().size(),
            a.atlas.active().keyframes().size() + b.atlas.active().keyframes().size());
  EXPECT_LT(map.points().size(),
            a.atlas.active().points().size() + b.atlas.active().points().size());
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Eigen::Vector3d place = Inverse(keyframe.frame.cam_from_world).translation;
    EXPECT_LT((place - PosterPlace(keyframe.frame.stamp_ns)).norm(), 0.01) << id.value;
  }
  // The same maps, the same bytes.
  RunProgram(folder,
             "map merge " + Quoted(folder / "a/map.plb") + " " + Quoted(folder / "b/map.plb") +
                 " --out " + Quoted(folder / "again.plb"));
  EXPECT_TRUE(Contents(both) == Contents(folder / "again.plb"));
}

// It takes a while, and says what came of it.
TEST(MapMerge, ItsPlaceIsCheckedBeforeTheWork) {
  const ScratchFolder folder;
  const std::string map = Quoted(Posters().map);
  ExpectRefusal(RunProgram(folder, "map merge " + map + " " + map + " --out /proc/plumbline.plb"),
                "cannot write /proc/plumbline.plb: ");
}

TEST(MapMerge, WritesNothingWhereNoPlaceIsShownByBoth) {
  const ScratchFolder folder;
  SavedAtlas other = LoadAtlas(Posters().map);
  Map& map = other.atlas.active();
  while (!map.points().empty()) map.Apply({edit::RemovePoint{map.points().begin()->first}});
  while (!map.lines().empty()) map.Apply({edit::RemoveLine{map.lines().begin()->first}});
  SaveAtlas(folder / "empty.plb", other.atlas, other.context);
  const fs::path out = folder / "out.plb";
  ExpectRefusal(RunProgram(folder,
                           "map merge " + Quoted(Posters().map) + " " +
                               Quoted(folder / "empty.plb") + " --out " + Quoted(out)),
                "expected maps that show the same place, found no place that both show");
  EXPECT_FALSE(fs::exists(out));
}

TEST(MapCommands, RefuseFilesThatAreNoWholeMaps) {
  const ScratchFolder folder;
  const std::string whole = Contents(Posters().map);
  std::string changed = whole, version = whole;
  changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 4);
  version[8] = 77;
  folder.Write("cut.plb", whole.substr(0, whole.size() / 3));
  folder.Write("changed.plb", changed);
  folder.Write("version.plb", version);
  folder.Write("other.plb", "ply\nformat ascii 1.0\n");
  fs::create_directories(folder / "folder.plb");
  const std::pair<const char*, const char*> files[] = {
      {"cut.plb", "cut.plb: "},
      {"changed.plb", "changed.plb: damaged"},
      {"version.plb", "found version 77"},
      {"other.plb", "other.plb: expected a Plumbline map, found another file"},
      {"none.plb", "none.plb: no such file"},
      {"folder.plb", "folder.plb: "}};
  const auto before = FilesOf(folder.path());
  for (const auto& [name, message] : files) {
    const std::string file = Quoted(folder / name);
    const std::string out = " --out " + Quoted(folder / "out");
    ExpectRefusal(RunProgram(folder, "map info " + file), message);
    ExpectRefusal(RunProgram(folder, "map export " + file + " --to colmap" + out), message);
    ExpectRefusal(RunProgram(folder,
                             "map merge " + Quoted(Posters().map) + " " + file +
                                 " --transform '0 0 0 0 0 0 1'" + out),
                  message);
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  EXPECT_EQ(FilesOf(folder.path()).size(), before.size() + 2);  // stdout and stderr
}

TEST(MapMerge, AsToldRefusesMapsOfAnotherLens) {
  const ScratchFolder folder;
  SavedAtlas saved = LoadAtlas(Posters().map);
  const FeatureCorrection corrected{saved.atlas.active().correction().stereo,
                                    {saved.context.camera, 3}};
  saved.atlas.active().Apply({edit::CorrectFeatures{corrected}});
  SaveAtlas(folder / "lens.plb", saved.atlas, saved.context);
  ExpectRefusal(
      RunProgram(folder,
                 "map merge " + Quoted(Posters().map) + " " + Quoted(folder / "lens.plb") +
                     " --transform '0 0 0 0 0 0 1' --out " + Quoted(folder / "out")),
      "expected maps with the same lens correction, found 0.00 and 3.00 px");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

struct Refusal {
  std::string arguments;  // MAP, SEQUENCE and FOLDER stand for paths
  std::string message;
};

void ExpectRefusals(const ScratchFolder& folder, const std::vector<Refusal>& refusals) {
  const auto put = [](std::string text, const std::string& name, const fs::path& path) {
    for (auto at = text.find(name); at != std::string::npos; at = text.find(name)) {
      text.replace(at, name.size(), path.string());
    }
    return text;
  };
  for (const Refusal& refusal : refusals) {
    std::string arguments = put(refusal.arguments, "MAP", Posters().map);
    arguments = put(arguments, "SEQUENCE", Posters().sequence);
    arguments = put(arguments, "FOLDER", folder.path());
    ExpectRefusal(RunProgram(folder, "map " + arguments), refusal.message);
  }
}

TEST(MapCommands, NameWhatIsMissingOrUnknown) {
  const ScratchFolder folder;
  ExpectRefusals(
      folder,
      {{"", "map: expected a command; see plumbline map --help"},
       {"inof MAP", "map: unknown command 'inof'; did you mean 'info'?"},
       {"info", "map info: expected FILE; see plumbline map info --help"},
       {"info MAP MAP", "map info: unexpected argument"},
       {"export MAP --out FOLDER/x", "map export: expected --to ply|obj|dxf|tum|colmap|nerfstudio"},
       {"export MAP --to ply", "map export: expected --out PATH"},
       {"export MAP --to stl --out FOLDER/x",
        "--to: expected ply, obj, dxf, tum, colmap or nerfstudio, found stl"},
       {"export MAP --to nerfstudio --out FOLDER/x", "--to nerfstudio: expected --images PATH"},
       {"export MAP --to obj --images SEQUENCE --out FOLDER/x",
        "--images: goes with --to ply, colmap and nerfstudio only"},
       {"export MAP --to ply --images SEQUENCE --frames all --out FOLDER/x",
        "--frames: goes with --to colmap and nerfstudio only"},
       {"export MAP --to colmap --frames all --out FOLDER/x", "--frames: expected --images PATH"},
       {"export MAP --to colmap --images SEQUENCE --frames some --out FOLDER/x",
        "--frames: expected keyframes, all or every:N, found some"},
       {"export MAP --to colmap --images SEQUENCE --frames every:0 --out FOLDER/x",
        "--frames every: expected a whole number from 1 to 1000000000, found 0"},
       {"export MAP --to colmap --images SEQUENCE --trajectory FOLDER/none --out FOLDER/x",
        "--trajectory: goes with --frames all and --frames every:N only"},
       {"export MAP --to colmap --images SEQUENCE --frames all --trajectory FOLDER/none --out "
        "FOLDER/x",
        "none: no such file"},
       {"export MAP --to colmap --camera euroc --out FOLDER/x",
        "--camera: goes with --images only"},
       {"export MAP --to tum --model text --out FOLDER/x", "--model: goes with --to colmap only"},
       {"export MAP --to colmap --undistort --out FOLDER/x",
        "--undistort: goes with --images and --to colmap or nerfstudio only"},
       {"export MAP --to ply --images SEQUENCE --undistort --out FOLDER/x",
        "--undistort: goes with --images and --to colmap or nerfstudio only"},
       {"export MAP --to colmap --model xml --out FOLDER/x",
        "--model: expected text, binary or both, found xml"},
       {"export MAP --to colmap --images FOLDER/none --out FOLDER/x",
        "none: no such file or folder"},
       {"export MAP --to colmap --images SEQUENCE --camera tum_vi_512 --out FOLDER/x",
        "expected an image of 512x512 pixels as in the calibration, found 400x300"},
       {"merge MAP MAP", "map merge: expected --out FILE"},
       {"merge MAP MAP --transform '0 0 0 0 0 1' --out FOLDER/x",
        "--transform: expected \"tx ty tz qx qy qz qw [scale]\", found 6 numbers"},
       {"merge MAP MAP --transform '0 0 0 0 0 0 one' --out FOLDER/x", "found 'one'"},
       {"merge MAP MAP --transform '0 0 0 0 0 1 1' --out FOLDER/x", "a quaternion of norm 1.41421"},
       {"merge MAP MAP --transform '0 0 0 0 0 0 1 -1' --out FOLDER/x", "found the scale -1"},
       {"merge MAP MAP --transform '0 -1e300 0 0 0 0 1' --out FOLDER/x",
        "transform: expected coordinates within 1e+09 of 0, found 1e+300"},
       {"merge MAP MAP --transform '0 0 0 0 0 0 1 1e-300' --out FOLDER/x",
        "transform: expected a scale from 1e-09 to 1e+09, found 1e-300"},
       {"merge MAP MAP --transform '0 0 0 0 0 0 1 2' --out FOLDER/x",
        "found the scale 2 for maps of measured depth, whose scale is 1"}});
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(MapCommands, RefuseMapsAndDataOfOtherCameras) {
  const ScratchFolder folder;
  SavedMap other = LoadMap(Posters().map);
  other.camera.fx = 310;
  SaveMap(folder / "other.plb", other.camera, other.rectified_from_left, other.map);
  ExpectRefusals(folder,
                 {{"merge MAP FOLDER/other.plb --transform '0 0 0 0 0 0 1' --out FOLDER/x",
                   "found another one: fx 300 and 310"},
                  {"export FOLDER/other.plb --to colmap --images SEQUENCE --out FOLDER/x",
                   "expected the camera that the map was made with, found another one: fx 310"}});
  EXPECT_EQ(FilesOf(folder.path()), (std::set<std::string>{"other.plb", "stderr", "stdout"}));
}

TEST(MapCommands, RefuseOutputThatCannotBeWrittenOrIsRead) {
  const ScratchFolder folder;
  fs::copy_file(Posters().map, folder / "map.plb");
  fs::create_symlink("map.plb", folder / "link.plb");
  folder.Write("full/file", "text");
  const std::string transform = " --transform '0 0 0 0 0 0 1'";
  ExpectRefusals(
      folder,
      {{"export FOLDER/map.plb --to ply --out FOLDER/link.plb", "which is read"},
       {"export FOLDER/map.plb --to colmap --out FOLDER/map.plb", "which is read"},
       {"info FOLDER/map.plb --json FOLDER/map.plb",
        "--json " + (folder / "map.plb").string() + ": expected another file than"},
       {"merge MAP FOLDER/link.plb --out FOLDER/map.plb" + transform, "which is read"},
       {"merge FOLDER/map.plb MAP --out FOLDER/./map.plb" + transform, "which is read"},
       {"export MAP --to ply --out FOLDER/none/x.ply", "none/x.ply: No such file or directory"},
       {"export MAP --to tum --out FOLDER/full", "full: Is a directory"},
       {"export MAP --to colmap --out FOLDER/full",
        "full: expected a new or empty folder, found files in it"},
       {"export MAP --to colmap --out FOLDER/full/file",
        "file: expected a new or empty folder, found a file of this name"},
       {"export MAP --to colmap --out /proc/plumbline/x", "cannot make the folder /proc/plumbline"},
       {"merge MAP MAP --out FOLDER/full/file/x" + transform, "file/x: Not a directory"},
       {"info MAP --json FOLDER/none/i.json", "none/i.json: No such file or directory"}});
  EXPECT_EQ(Contents(folder / "map.plb"), Contents(Posters().map));
  EXPECT_EQ(FilesOf(folder.path()),
            (std::set<std::string>{"full", "link.plb", "map.plb", "stderr", "stdout"}));
  EXPECT_EQ(FilesOf(folder / "full"), (std::set<std::string>{"file"}));
}

// What a run has written, and what is of another kind, such as an image, is somebody's.
TEST(MapCommands, ReplaceNoResultsAndNoFilesOfOtherKinds) {
  const ScratchFolder folder;
  fs::copy(Posters().out, folder / "out");
  fs::copy_file(Posters().sequence / "mav0/cam0/data/0.png", folder / "0.png");
  folder.Write("truth.txt", "# timestamp tx ty tz qx qy qz qw\n");
  folder.Write("poses.txt", "1.0e+00 0 0 0 0 1 0 0 0 0 1 0\n");
  folder.Write("package.json", "{\"name\": \"mine\"}\n");
  const std::string transform = " --transform '0 0 0 0 0 0 1'";
  ExpectRefusals(
      folder,
      {{"info FOLDER/out/map.plb --json FOLDER/out/trajectory.txt", "expected another name"},
       {"info FOLDER/out/map.plb --json FOLDER/0.png", "expected JSON of map info to replace"},
       {"info MAP --json FOLDER/package.json", "expected JSON of map info to replace"},
       {"export MAP --to tum --out FOLDER/poses.txt", "expected a trajectory by plumbline"},
       {"export FOLDER/out/map.plb --to obj --out FOLDER/out/frames.csv", "expected another name"},
       {"export MAP --to ply --out FOLDER/0.png", "expected a PLY file by plumbline to replace"},
       {"export MAP --to obj --out FOLDER/0.png", "expected lines that were exported to replace"},
       {"export MAP --to dxf --out FOLDER/0.png", "expected a DXF file by plumbline to replace"},
       {"export MAP --to tum --out FOLDER/0.png", "expected a trajectory by plumbline to replace"},
       {"export MAP --to tum --out FOLDER/truth.txt",
        "expected a trajectory by plumbline to replace"},
       {"merge MAP MAP --out FOLDER/out/summary.json" + transform, "expected another name"},
       {"merge MAP MAP --out FOLDER/truth.txt" + transform, "expected a map to replace"}});
  for (const std::string& name : FilesOf(Posters().out)) {
    EXPECT_TRUE(Contents(folder / "out" / name) == Contents(Posters().out / name)) << name;
  }
  // Their own they replace.
  for (int time = 0; time < 2; ++time) {
    for (const std::string form : {"ply", "obj", "dxf", "tum"}) {
      const Outcome outcome = RunProgram(folder,
                                         "map export " + Quoted(Posters().map) + " --to " + form +
                                             " --out " + Quoted(folder / ("x." + form)));
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    const std::string maps = Quoted(Posters().map) + " " + Quoted(Posters().map);
    for (const std::string& arguments :
         {"info " + Quoted(Posters().map) + " --json " + Quoted(folder / "x.json"),
          "merge " + maps + " --out " + Quoted(folder / "x.plb") + transform}) {
      const Outcome outcome = RunProgram(folder, "map " + arguments);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
  }
}

}  // namespace
}  // namespace plumbline
