// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/trajectory_io.h"

#include "plumbline/io/text_rows.h"

#include "tests/io/scratch_folder.h"
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FormatStamp, IsExact) {
  EXPECT_EQ(FormatStamp(1'403'636'584'763'555'584), "1403636584.763555584");
  EXPECT_EQ(FormatStamp(0), "0.000000000");
  EXPECT_EQ(FormatStamp(5), "0.000000005");
  EXPECT_EQ(FormatStamp(-1'500'000'000), "-1.500000000");
  EXPECT_EQ(FormatStamp(-5), "-0.000000005");
}

TEST(FormatTum, HasNineDecimalsAndPositiveW) {
  const Rigid3 pose{Eigen::Quaterniond(-0.5, 0.5, 0.5, 0.5), {1, -1e-12, 2.0 / 3}};
  EXPECT_EQ(FormatTum({{7, pose}}),
            "0.000000007 1.000000000 0.000000000 0.666666667 -0.500000000 -0.500000000 "
            "-0.500000000 0.500000000\n");
  EXPECT_EQ(FormatTum({}), "");
}

TEST(ReadTrajectory, ReadsBackWhatWriteTumWrote) {
  const ScratchFolder folder;
  Trajectory written;
  written.push_back({-1'500'000'000, Rigid3{}});  // before the start of its clock
  for (int i = 0; i < 20; ++i) {
    const Vector6d tangent = Vector6d::LinSpaced(-1, 1 + i) * 0.3;
    written.push_back({1'403'636'584'763'555'584 + 50'000'001LL * i, ExpSe3(tangent)});
  }
  WriteTum(folder / "t.txt", written);
  const LoadedTrajectory read = ReadTrajectory(folder / "t.txt");
  EXPECT_EQ(read.format, TrajectoryFormat::kTum);
  ASSERT_EQ(read.poses.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(read.poses[i].stamp_ns, written[i].stamp_ns);
    const Rigid3 difference =
        read.poses[i].world_from_camera * Inverse(written[i].world_from_camera);
    EXPECT_LT(LogSe3(difference).norm(), 1e-8);
  }
}

TEST(ReadTrajectory, ReadsEurocWithExtraColumns) {
  const ScratchFolder folder;
  const auto file = folder.Write("data.csv",
                                 "#timestamp,p,p,p,qw,qx,qy,qz,v\r\n"
                                 "1403636580838555648,1,2,3,0.6,0.8,0,0,9,9\r\n");
  const LoadedTrajectory read = ReadTrajectory(file);
  EXPECT_EQ(read.format, TrajectoryFormat::kEuroc);
  ASSERT_EQ(read.poses.size(), 1U);
  EXPECT_EQ(read.poses[0].stamp_ns, 1403636580838555648);
  EXPECT_EQ(read.poses[0].world_from_camera.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(read.poses[0].world_from_camera.rotation.w(), 0.6, 1e-12);
  EXPECT_NEAR(read.poses[0].world_from_camera.rotation.x(), 0.8, 1e-12);
}

TEST(ReadTrajectory, ReadsKittiWithTheTimesBesideIt) {
  const ScratchFolder folder;
  folder.Write("times.txt", "0.000000e+00\n1.037000e-01\n");
  const auto file =
      folder.Write("poses.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n");
  const LoadedTrajectory read = ReadTrajectory(file);
  EXPECT_EQ(read.format, TrajectoryFormat::kKitti);
  ASSERT_EQ(read.poses.size(), 2U);
  EXPECT_EQ(read.poses[1].stamp_ns, 103'700'000);
  EXPECT_EQ(read.poses[1].world_from_camera.translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(AngularDistance(read.poses[1].world_from_camera.rotation,
                              Eigen::Quaterniond(std::sqrt(0.5), 0, 0, std::sqrt(0.5))),
              0,
              1e-7);
}

TEST(ReadTrajectory, FindsTheTimesOfTheDistributedKittiLayout) {
  const ScratchFolder folder;
  folder.Write("sequences/06/times.txt", "0\n");
  const auto file = folder.Write("poses/06.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n");
  EXPECT_EQ(ReadTrajectory(file).poses.size(), 1U);
}

TEST(ReadTrajectory, BadRowsAreNamedByLine) {
  struct Case {
    std::string content;
    std::string message;
  };
  const std::vector<Case> cases = {
      {"", "t.txt: expected poses, found no rows"},
      {"# only\n", "t.txt: expected poses, found no rows"},
      {"1 2 3\n", "t.txt:1: expected 8 columns (TUM), 12 (KITTI)"},
      {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n", "t.txt:2: expected 8 columns"},
      {"0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1 9\n", "t.txt:2: expected 8 columns"},
      {"0 0 0 0 0 0 0 1\n1 0 x 0 0 0 0 1\n", "t.txt:2: expected a number in column 3, found 'x'"},
      {"0 0 nan 0 0 0 0 1\n", "t.txt:1: expected a number in column 3, found 'nan'"},
      {"0 0 1e308 0 0 0 0 1\n",
       "t.txt:1: expected a coordinate within 1e+09 of 0 in column 3, found '1e308'"},
      {"0,0,0,-1e10,1,0,0,0\n", "t.txt:1: expected a coordinate within 1e+09 of 0 in column 4"},
      {"9223372036.0 0 0 0 0 0 0 1\n", "t.txt:1: expected a time stamp in seconds"},
      {"a\x1b[2Jb 0 0 0 0 0 0 1\n",
       "t.txt:1: expected a time stamp in seconds, found 'a\\x1b[2Jb'"},
      {"a 0 0 0 0 0 0 1\n", "t.txt:1: expected a time stamp in seconds, found 'a'"},
      {"1403636580838555648.0 0 0 0 0 0 0 1\n", "t.txt:1: expected a time stamp in seconds"},
      {"# c\n0 0 0 0 0 0 0 2\n", "t.txt:2: expected a unit quaternion, found one of norm 2"},
      {"0 0 0 0 0 0 0 0\n", "t.txt:1: expected a unit quaternion, found one of norm 0"},
      {"1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "t.txt:2: expected time stamps that increase"},
      {"1 0 0 0 0 0 0 1\n0.5 0 0 0 0 0 0 1\n",
       "t.txt:2: expected time stamps that increase, "
       "found one that goes back"},
      {"1,2,3\n", "t.txt:1: expected at least 8 columns"},
      {"1.5,0,0,0,1,0,0,0\n", "t.txt:1: expected a time stamp in whole nanoseconds"},
      {"1,0,0,,1,0,0,0\n", "t.txt:1: expected a number in column 4, found ''"},
      {"1 0 0 0 0 1 0 0 0 0 1 0\n", "times.txt: no such file"},
  };
  const ScratchFolder folder;
  for (const Case& c : cases) {
    const auto file = folder.Write("t.txt", c.content);
    EXPECT_THAT(MessageOf([&] { ReadTrajectory(file); }), HasSubstr(c.message)) << c.content;
  }
}

TEST(ReadTrajectory, RefusesWrongCountsAndMatricesOfKitti) {
  const ScratchFolder folder;
  const std::vector<StampedRow> one = {{1, 1}}, two = {{1, 1}, {2, 2}};
  const auto message = [&](const std::string& rows, const std::vector<StampedRow>& times) {
    const auto file = folder.Write("poses.txt", rows);
    return MessageOf([&] { ReadTrajectory(file, BadRows::kRefuse, &times); });
  };
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_EQ(message(good, one), "no error");
  EXPECT_THAT(message(good + good, one),
              HasSubstr("poses.txt: expected 1 poses, one for each time, found 2"));
  EXPECT_THAT(message(good + "1 0 0 0 0 1 0 0 0 0 2 0\n", two),
              HasSubstr("poses.txt:2: expected a rotation matrix"));
  EXPECT_THAT(message("1 0 0 0 0 1 0 0 0 0 -1 0\n", one),
              HasSubstr("poses.txt:1: expected a rotation matrix"));
  EXPECT_THAT(message(good + "1 0 0 0 0 1 0 0 0 0 1\n", two),
              HasSubstr("poses.txt:2: expected 12 numbers, a 3x4 matrix, found 11 columns"));
}

// Rows of KITTI have their time by their number: a pose goes where its time goes.
TEST(ReadTrajectory, PosesOfKittiFollowTheirTimes) {
  const ScratchFolder folder;
  folder.Write("times.txt", "0.2\n0.1\n0.2\n0.3\n");
  std::string rows;
  for (int i = 0; i < 4; ++i) rows += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
  const auto file = folder.Write("poses.txt", rows);
  for (const BadRows bad_rows : {BadRows::kRefuse, BadRows::kLeaveOut}) {
    const LoadedTrajectory read = ReadTrajectory(file, bad_rows);
    std::vector<double> places;
    for (const StampedPose& pose : read.poses) {
      places.push_back(pose.world_from_camera.translation.z());
    }
    EXPECT_THAT(places, ElementsAre(1, 0, 3));
    EXPECT_EQ(read.poses[0].stamp_ns, 100'000'000);
    EXPECT_THAT(read.notes,
                ElementsAre(HasSubstr("times.txt:3: 1 row repeats a time stamp and is left out"),
                            HasSubstr("times.txt:2: 1 row goes back in time and is sorted in")));
  }
}

// What a strict reader refuses; see ground_truth_test.cc for data sets.
TEST(ReadTrajectory, LeavesBadRowsOutOnRequest) {
  const ScratchFolder folder;
  const auto file = folder.Write("t.txt",
                                 "time x y z qx qy qz qw\n1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"
                                 "0.5 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1 9\n3 0 0 0 0 0 0 1\n4 0\n");
  EXPECT_NE(MessageOf([&] { ReadTrajectory(file); }), "no error");
  const LoadedTrajectory read = ReadTrajectory(file, BadRows::kLeaveOut);
  ASSERT_EQ(read.poses.size(), 2U);
  EXPECT_EQ(read.poses[1].stamp_ns, 3'000'000'000);
  EXPECT_THAT(read.notes,
              ElementsAre(HasSubstr("t.txt:3: 1 row repeats a time stamp and is left out"),
                          HasSubstr("t.txt:4: 1 row goes back in time and is left out"),
                          HasSubstr("t.txt:1: expected a time stamp in seconds, found 'time'; 3 "
                                    "rows that cannot be used are left out")));
  const auto none = folder.Write("none.txt", "a 0 0 0 0 0 0 1\nb 0 0 0 0 0 0 1\n");
  EXPECT_THAT(MessageOf([&] { ReadTrajectory(none, BadRows::kLeaveOut); }),
              HasSubstr("none.txt:1: expected a time stamp in seconds, found 'a'"));
}

TEST(WriteTum, StampsThatAreReadableAreRead) {
  const ScratchFolder folder;
  EXPECT_TRUE(IsReadableStamp(kLatestStampNs));
  EXPECT_TRUE(IsReadableStamp(-kLatestStampNs));
  EXPECT_FALSE(IsReadableStamp(kLatestStampNs + 1));
  EXPECT_FALSE(IsReadableStamp(-kLatestStampNs - 1));
  const Trajectory trajectory = {{-kLatestStampNs, Rigid3()}, {kLatestStampNs, Rigid3()}};
  WriteTum(folder / "t.txt", trajectory);
  const Trajectory read = ReadTrajectory(folder / "t.txt").poses;
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.front().stamp_ns, -kLatestStampNs);
  EXPECT_EQ(read.back().stamp_ns, kLatestStampNs);
}

TEST(FormatTum, WritesRotationsOfNormOne) {
  const Eigen::Quaterniond turn = ExpSo3({0.3, -0.5, 0.2});
  Rigid3 off{turn, {1, 2, 3}};
  off.rotation.coeffs() *= 1.008;
  EXPECT_EQ(FormatTum({{1, off}}), FormatTum({{1, {turn, {1, 2, 3}}}}));
  off.rotation.coeffs() *= 2;
  EXPECT_THROW(FormatTum({{1, off}}), InputError);
}

TEST(WriteTum, RefusesWhatWouldNotBeRead) {
  const ScratchFolder folder;
  const auto message = [&](const Trajectory& trajectory) {
    return MessageOf([&] { WriteTum(folder / "t.txt", trajectory); });
  };
  const std::string start = "cannot write " + (folder / "t.txt").string() + ": pose ";
  EXPECT_EQ(message({{kLatestStampNs + 1, Rigid3()}}),
            start +
                "0 (from 0): expected a time stamp within 4000000000000000000 ns of 0, found "
                "4000000000000000001");
  EXPECT_EQ(message({{1, Rigid3()}, {7, Rigid3()}, {7, Rigid3()}}),
            start + "2 (from 0): expected ascending time stamps, found 7 ns after 7 ns");
  const auto at = [](double y) { return Rigid3{Eigen::Quaterniond::Identity(), {0, y, 0}}; };
  EXPECT_EQ(message({{1, Rigid3()}, {2, at(-2e9)}}),
            start + "1 (from 0): expected coordinates within 1e+09 of 0, found -2e+09");
  EXPECT_EQ(message({{1, at(std::numeric_limits<double>::quiet_NaN())}}),
            start + "0 (from 0): expected coordinates within 1e+09 of 0, found nan");
  Rigid3 scaled;
  scaled.rotation.coeffs() *= 2;
  EXPECT_EQ(message({{1, Rigid3()}, {2, scaled}}),
            start + "1 (from 0): expected a quaternion of norm 1, found one of norm 2");
  EXPECT_FALSE(std::filesystem::exists(folder / "t.txt"));
}

}  // namespace
}  // namespace plumbline
