// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/sim3.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/trajectory_error.h"

#include "apps/commands.h"
#include "apps/evaluate_outputs.h"
#include "tests/io/scratch_folder.h"
#include <cmath>
#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace plumbline {
namespace evaluate_several_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// A path that turns in all directions, a pose each 50 ms.
Trajectory Path(int first, int count) {
  Trajectory path;
  for (int i = first; i < first + count; ++i) {
    const double t = 0.1 * i;
    path.push_back({1'000'000'000 + 50'000'000LL * i,
                    {ExpSo3({0.2 * std::sin(t), 0.3 * t, 0.1 * t}),
                     {3 * std::cos(t), 2 * std::sin(0.7 * t), 0.3 * t}}});
  }
  return path;
}

Trajectory Moved(const Similarity3& target_from_source, Trajectory poses) {
  for (StampedPose& pose : poses) {
    pose.world_from_camera = TransformPose(target_from_source, pose.world_from_camera);
  }
  return poses;
}

// Another world and unit, as that of a map.
const Similarity3 kMapFromTruth{0.5, ExpSo3({0.3, -0.5, 0.9}), Eigen::Vector3d(4, -1, 2)};

struct Sequence {
  ScratchFolder folder;
  std::string truth = Write("truth.txt", Path(0, 80));

  std::string Write(const std::string& name, const Trajectory& poses) const {
    const std::filesystem::path file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    WriteTum(file, poses);
    return file.string();
  }
  std::string At(const std::string& name) const { return (folder / name).string(); }
  bool Has(const std::string& name) const { return std::filesystem::exists(folder / name); }
};

// What is printed; the message of an error behind "error: ".
std::string Printed(std::vector<std::string> arguments) {
  testing::internal::CaptureStdout();
  const std::string message = MessageOf([&] { EvaluateCommand(arguments); });
  const std::string printed = testing::internal::GetCapturedStdout();
  return message == "no error" ? printed : "error: " + message;
}

double AteOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = arguments;
  all.insert(all.end(), {"--json", "-"});
  const std::string printed = Printed(all);
  EXPECT_THAT(printed, StartsWith("{\n  \"alignment\": "));
  return json::parse(printed)["ate_m"]["rmse"];
}

TEST(EvaluateSeveral, StandInOneTable) {
  const Sequence sequence;
  Trajectory bent = Path(0, 80);
  for (std::size_t i = 0; i < bent.size(); ++i) {
    bent[i].world_from_camera.translation.z() += i < 8 ? 0.4 : 0;
  }
  const std::string good = sequence.Write("good/trajectory.txt", Path(0, 80));
  const std::string bad = sequence.Write("bad/trajectory.txt", bent);
  const std::string out = sequence.At("out.json");
  const std::string table =
      Printed({sequence.truth, sequence.At("good"), bad, good, "--align", "none", "--json", out});
  EXPECT_THAT(table, HasSubstr("ATE [m]"));
  EXPECT_THAT(table, HasSubstr("RMSE      mean    median       std       p75       p95       max"));
  EXPECT_THAT(table, testing::ContainsRegex("\nbad_trajectory +80 with a pose of"));
  const json estimates = json::parse(Contents(out))["estimates"];
  ASSERT_EQ(estimates.size(), 3U);
  EXPECT_EQ(estimates[0]["name"], "good");
  EXPECT_EQ(estimates[0]["estimate"], sequence.At("good"));
  EXPECT_EQ(estimates[1]["name"], "bad_trajectory");
  EXPECT_EQ(estimates[2]["ate_m"]["rmse"], 0);
  const json ate = estimates[1]["ate_m"];  // a tenth is off by 0.4 m
  EXPECT_NEAR(ate["rmse"], 0.4 * std::sqrt(0.1), 1e-9);
  EXPECT_NEAR(ate["mean"], 0.04, 1e-9);
  EXPECT_NEAR(ate["std"], 0.4 * std::sqrt(0.1 * 0.9), 1e-9);
  EXPECT_EQ(ate["median"], 0);
  EXPECT_EQ(ate["p75"], 0);
  EXPECT_NEAR(ate["p95"], 0.4, 1e-9);
  EXPECT_EQ(estimates[1]["alignment"], "none");
  // JSON of several takes the place of that of one, and the other way round.
  EXPECT_THAT(Printed({sequence.truth, good, "--json", out}), HasSubstr("ATE [m]"));
  EXPECT_THAT(Printed({sequence.truth, good, bad, "--json", out}), HasSubstr("ATE [m]"));
}

TEST(EvaluateSeveral, OneThatCannotBeComparedIsNamedAndNothingIsWritten) {
  const Sequence sequence;
  const std::string good = sequence.Write("good.txt", Path(0, 80));
  const std::string late = sequence.Write("late.txt", Path(900, 5));
  EXPECT_THAT(Printed({sequence.truth, good, late, "--json", sequence.At("out.json")}),
              StartsWith("error: " + late + ": no pose of the estimate has a reference pose"));
  EXPECT_FALSE(sequence.Has("out.json"));
}

TEST(EvaluateSeveral, ShortNamesTellThemApart) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(ShortNames({"out/a/trajectory.txt"}), Names({"trajectory"}));
  EXPECT_EQ(ShortNames({"out/a", "out/b/"}), Names({"a", "b"}));
  EXPECT_EQ(ShortNames({"x/out", "y/out", "z.csv"}), Names({"x_out", "y_out", "z.csv"}));
  EXPECT_EQ(ShortNames({"x/a", "x/b/t.txt", "y/b/t.txt"}), Names({"a", "x_b_t", "y_b_t"}));
  EXPECT_EQ(ShortNames({"same", "./same", "other"}), Names({"same", "same-2", "other"}));
  EXPECT_EQ(ShortNames({"..", "."}), Names({"estimate", "estimate-2"}));
}

TEST(EvaluateJson, OnStandardOutputStandsAlone) {
  const Sequence sequence;
  const std::string good = sequence.Write("good.txt", Path(0, 80));
  const json one = json::parse(Printed({sequence.truth, good, "--json", "-"}));
  EXPECT_EQ(one["ate_m"]["count"], 80);
  EXPECT_EQ(json::parse(Printed({sequence.truth, good, good, "--json=-"}))["estimates"].size(), 2U);
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST(EvaluateTimeOffset, IsAddedToTheStampsOfTheEstimate) {
  const Sequence sequence;
  Trajectory behind = Path(0, 80);
  for (StampedPose& pose : behind) pose.stamp_ns -= 25'000'000;
  const std::string estimate = sequence.Write("behind.txt", behind);
  const std::vector<std::string> compare = {sequence.truth, estimate, "--align", "none"};
  const auto with = [&](const std::string& offset) {
    std::vector<std::string> all = compare;
    all.push_back("--time-offset=" + offset);
    return all;
  };
  EXPECT_GT(AteOf(compare), 1e-3);
  EXPECT_LT(AteOf(with("0.025")), 1e-8);
  EXPECT_GT(AteOf(with("-0.025")), AteOf(compare));
  EXPECT_THAT(Printed(with("+0.025")),
              HasSubstr("time offset 0.025000000 s, added to the stamps of the estimate\n"));
  const std::string saved = sequence.At("saved.txt");
  std::vector<std::string> save = with("0.025");
  save.insert(save.end(), {"--save-aligned", saved});
  Printed(save);
  EXPECT_EQ(ReadTrajectory(saved).poses.front().stamp_ns, 1'000'000'000);
  EXPECT_THAT(Printed(with("4000000000")),
              HasSubstr("error: --time-offset 4000000000: expected stamps before the year 2096"));
  for (const std::string bad : {"x", "1e300", "--1", "nan", "5000000000"}) {
    EXPECT_THAT(Printed(with(bad)),
                StartsWith("error: --time-offset: expected seconds such as -0.05, found " + bad));
  }
}

TEST(EvaluateAligned, IsSavedInTheWorldOfTheReference) {
  const Sequence sequence;
  const std::string one = sequence.Write("one.txt", Moved(kMapFromTruth, Path(0, 80)));
  const std::string two = sequence.Write("two.txt", Path(0, 40));
  const std::string file = sequence.At("aligned.txt");
  for (int k = 0; k < 2; ++k) {  // its own kind is replaced
    Printed({sequence.truth, one, "--align", "sim3", "--save-aligned", file});
  }
  const Trajectory saved = ReadTrajectory(file).poses, truth = Path(0, 80);
  ASSERT_EQ(saved.size(), truth.size());
  for (std::size_t i = 0; i < saved.size(); ++i) {
    EXPECT_EQ(saved[i].stamp_ns, truth[i].stamp_ns);
    const Rigid3 off = Inverse(saved[i].world_from_camera) * truth[i].world_from_camera;
    EXPECT_LT(LogSe3(off).norm(), 1e-7) << i;
  }
  // Several go into a folder, which is made; one does into a folder that is there.
  Printed({sequence.truth, one, two, "--align", "sim3", "--save-aligned", sequence.At("all")});
  EXPECT_EQ(Contents(sequence.folder / "all/one.txt"), Contents(file));
  EXPECT_EQ(ReadTrajectory(sequence.folder / "all/two.txt").poses.size(), 40U);
  Printed({sequence.truth, two, "--save-aligned", sequence.At("new/")});
  EXPECT_TRUE(sequence.Has("new/two.txt"));
}

TEST(EvaluateAligned, TakesThePlaceOfNothingElse) {
  const Sequence sequence;
  const std::string one = sequence.Write("one.txt", Path(0, 80));
  const std::string mine = sequence.Write("mine.txt", Path(0, 3));
  EXPECT_THAT(Printed({sequence.truth, one, "--save-aligned", mine}),
              HasSubstr("mine.txt: expected a trajectory aligned by evaluate to replace"));
  EXPECT_THAT(Printed({sequence.truth, one, "--save-aligned", one}), HasSubstr("which is read"));
  EXPECT_THAT(Printed({sequence.truth, one, one, "--save-aligned", mine}),
              HasSubstr("expected a folder for several estimates, found another file"));
  EXPECT_THAT(Printed({sequence.truth, one, "--save-aligned", "-"}),
              HasSubstr("--save-aligned: expected a file or folder, found -"));
  EXPECT_EQ(ReadTrajectory(mine).poses.size(), 3U);
  EXPECT_EQ(ReadTrajectory(one).poses.size(), 80U);
}

// The map was made on the first half of the path, and is of one camera. The session that was
// localized in it is off by 2 cm along x, which an alignment of its own would hide.
TEST(EvaluateAlignBy, ComparesInTheFrameOfTheMap) {
  const Sequence sequence;
  const std::string map = sequence.Write("map.txt", Moved(kMapFromTruth, Path(0, 40)));
  Trajectory off = Path(40, 40);
  for (StampedPose& pose : off) pose.world_from_camera.translation.x() += 0.02;
  const std::string session = sequence.Write("session.txt", Moved(kMapFromTruth, off));
  EXPECT_LT(AteOf({sequence.truth, session, "--align", "sim3"}), 1e-6);
  const std::vector<std::string> by = {
      sequence.truth, session, "--align", "sim3", "--align-by", map};
  EXPECT_NEAR(AteOf(by), 0.02, 1e-6);
  EXPECT_THAT(Printed(by), HasSubstr("alignment   sim3 by " + map + ", scale 2.000000"));
  // Where the map's ground truth is in another file.
  const std::string first = sequence.Write("first.txt", Path(0, 40));
  const std::string second = sequence.Write("second.txt", Path(40, 40));
  std::vector<std::string> apart = by;
  apart[0] = second;
  EXPECT_THAT(Printed(apart), StartsWith("error: " + map + ": no pose of the estimate has"));
  apart.insert(apart.end(), {"--align-reference", first});
  EXPECT_NEAR(AteOf(apart), 0.02, 1e-6);
  EXPECT_THAT(Printed({sequence.truth, session, "--align-reference", first}),
              StartsWith("error: --align-reference: expected --align-by as well"));
  EXPECT_THAT(Printed({sequence.truth, session, "--align", "none", "--align-by", map}),
              StartsWith("error: --align-by: expected --align se3 or sim3 beside it, found none"));
  EXPECT_THAT(Printed({sequence.truth, session, "--align-by", sequence.At("none.txt")}),
              HasSubstr("none.txt"));
}

// A run of one camera that is not scaled to the reference has no metres.
TEST(EvaluateUnits, OfOneCameraAreNoMetres) {
  const Sequence sequence;
  const std::string run = sequence.At("mono");
  sequence.Write("mono/trajectory.txt", Moved(kMapFromTruth, Path(0, 80)));
  sequence.folder.Write("mono/summary.json", "{\"sensor\": \"mono\"}");
  const auto warning = HasSubstr("units of its own, not metres");
  EXPECT_THAT(Printed({sequence.truth, run}), testing::Not(warning));
  EXPECT_THAT(Printed({sequence.truth, run, "--align", "se3"}), warning);
}

TEST(EvaluatePlot, ShowsPlacesAndAnglesOverTime) {
  const Sequence sequence;
  const std::string one = sequence.Write("one.txt", Path(0, 80));
  const std::string two = sequence.Write("two.txt", Path(0, 40));
  const std::string plot = sequence.At("plot.svg");
  Printed({sequence.truth, one, two, "--plot", plot});
  const std::string svg = Contents(plot);
  for (const char* text : {">x [m]<",
                           ">y [m]<",
                           ">z [m]<",
                           ">roll [deg]<",
                           ">pitch [deg]<",
                           ">yaw [deg]<",
                           ">one<",
                           ">two<",
                           ">reference<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

// What a disk does that is full in the middle.
void WithFilesOfAtMost(rlim_t bytes, const std::function<void()>& work) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit limit{bytes, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  work();
  ::setrlimit(RLIMIT_FSIZE, &before);
  (void)std::signal(SIGXFSZ, handler);
}

TEST(EvaluateOutputs, AreWrittenAllOrNone) {
  const Sequence sequence;
  const std::string one = sequence.Write("one.txt", Path(0, 80));
  const std::string out = sequence.At("out.json"), plot = sequence.At("plot.svg");
  const std::vector<std::string> arguments = {
      sequence.truth, one, "--json", out, "--plot", plot, "--save-aligned", sequence.At("new/")};
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(sequence.folder.path()), {});
  };
  // The JSON fits, the drawing does not.
  WithFilesOfAtMost(4096, [&] {
    EXPECT_THAT(Printed(arguments), StartsWith("error: cannot write " + plot + ": "));
  });
  EXPECT_EQ(files(), 2) << "something was left";
  EXPECT_THAT(Printed(arguments), HasSubstr("ATE [m]"));
  const std::string before = Contents(out);
  const std::string lost = sequence.At("none/plot.svg");
  EXPECT_THAT(Printed({sequence.truth, one, "--align", "none", "--json", out, "--plot", lost}),
              StartsWith("error: cannot write " + lost + ": "));
  EXPECT_EQ(Contents(out), before);
}

}  // namespace evaluate_several_test
}  // namespace plumbline
