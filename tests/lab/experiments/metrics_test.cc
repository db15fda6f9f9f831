// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/metrics.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(Metrics, AreReadInTheirUnits) {
  const ScratchFolder folder;
  folder.Write("summary.json", Summary(0.0042, 9, 10));
  folder.Write("trajectory.txt", "1.0 0 0 0 0 0 0 1\n");
  const auto figures = ReadFigures(folder.path());
  ASSERT_TRUE(figures.has_value());
  EXPECT_DOUBLE_EQ(figures->values.at("ate"), 4.2);
  EXPECT_DOUBLE_EQ(figures->values.at("coverage"), 90);
  EXPECT_DOUBLE_EQ(figures->values.at("lost"), 1);
  EXPECT_DOUBLE_EQ(figures->values.at("cpu_ms"), 100);
  EXPECT_DOUBLE_EQ(figures->values.at("fps"), 5);
  EXPECT_DOUBLE_EQ(figures->values.at("frame_p95_ms"), 30);
  EXPECT_EQ(figures->trajectory, "1.0 0 0 0 0 0 0 1\n");
}

// Poses in another map than that of the trajectory are not covered by its error.
TEST(Metrics, CoverageCountsThePosesOfTheTrajectory) {
  const ScratchFolder folder;
  folder.Write("summary.json",
               R"({"frames": {"in": 100, "tracked": 90, "in_trajectory": 55, "lost": 10},
                   "keyframes": 1, "wall_seconds": 1})");
  const auto figures = ReadFigures(folder.path());
  ASSERT_TRUE(figures.has_value());
  EXPECT_DOUBLE_EQ(figures->values.at("coverage"), 55);
  EXPECT_DOUBLE_EQ(figures->values.at("tracked"), 90);
  // An earlier version of the program does not count them, but wrote them.
  folder.Write("summary.json",
               R"({"frames": {"in": 100, "tracked": 90, "lost": 10}, "keyframes": 1,
                   "wall_seconds": 1})");
  folder.Write("trajectory.txt", "1.0 0 0 0 0 0 0 1\n1.1 0 0 0 0 0 0 1\n");
  EXPECT_DOUBLE_EQ(ReadFigures(folder.path())->values.at("coverage"), 2);
}

TEST(Metrics, OfARunThatWasInterruptedAreNone) {
  const ScratchFolder folder;
  const auto write = [&](const std::string& interrupted) {
    folder.Write("summary.json",
                 R"({"frames": {"in": 1, "tracked": 1, "lost": 0}, "keyframes": 1,
                     "wall_seconds": 1, "interrupted": )" +
                     interrupted + "}");
    return ReadFigures(folder.path()).has_value();
  };
  EXPECT_TRUE(write("null"));
  EXPECT_FALSE(write(R"("SIGTERM")"));
}

TEST(Metrics, TellTheMemoryOfALine) {
  const ScratchFolder folder;
  folder.Write("summary.json",
               R"({"frames": {"in": 1, "tracked": 1, "lost": 0}, "keyframes": 1, "wall_seconds": 1,
                   "line_bytes": {"map": 512.5, "adjustment": null}})");
  const auto figures = ReadFigures(folder.path());
  ASSERT_TRUE(figures.has_value());
  EXPECT_DOUBLE_EQ(figures->values.at("map_line_bytes"), 512.5);
  EXPECT_FALSE(figures->values.contains("adjusted_line_bytes"));
  EXPECT_EQ(figures->reasons.at("adjusted_line_bytes"), "there is no line");
}

TEST(Metrics, OfStartsAreReadFromTheirSummary) {
  const ScratchFolder folder;
  folder.Write("summary.json",
               R"({"starts": {"starts": 40, "success": 97.5, "wrong": 0},
                   "add": {"median_ms": 1.5}, "wall_seconds": 9})");
  folder.Write("starts.csv", "frame\n1\n");
  const auto figures = ReadFigures(folder.path());
  ASSERT_TRUE(figures.has_value());
  EXPECT_DOUBLE_EQ(figures->values.at("success"), 97.5);
  EXPECT_DOUBLE_EQ(figures->values.at("wrong"), 0);
  EXPECT_DOUBLE_EQ(figures->values.at("add_ms"), 1.5);
  EXPECT_EQ(figures->reasons.at("depth_error"), "no such start, or the truth is not known");
  EXPECT_EQ(figures->trajectory, "frame\n1\n");
}

TEST(Metrics, SayWhyThereIsNoValue) {
  const ScratchFolder folder;
  folder.Write("summary.json", Summary(0.01));
  auto figures = ReadFigures(folder.path());
  EXPECT_FALSE(figures->values.contains("rpe_mean"));
  EXPECT_EQ(figures->reasons.at("rpe_mean"), "no two poses are 3 s apart");
  EXPECT_EQ(figures->reasons.at("ate_causal"), "no ground truth of any pose");
  folder.Write("summary.json", Summary(0.01, 0));
  EXPECT_EQ(ReadFigures(folder.path())->reasons.at("rpe_mean"), "no frame has a pose");
}

TEST(Metrics, AFileThatIsNotWholeIsNoResult) {
  const ScratchFolder folder;
  EXPECT_FALSE(ReadFigures(folder.path()).has_value());
  const std::string whole = Summary(0.01);
  folder.Write("summary.json", whole.substr(0, whole.size() / 2));
  EXPECT_FALSE(ReadFigures(folder.path()).has_value());
  folder.Write("summary.json", "[]");
  EXPECT_FALSE(ReadFigures(folder.path()).has_value());
}

// What a run never writes was written by something else, or is damaged.
TEST(Metrics, AMeaninglessSummaryIsNoResult) {
  const ScratchFolder folder;
  const auto result_of = [&](const std::string& summary) {
    folder.Write("summary.json", summary);
    return ReadFigures(folder.path());
  };
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = Summary(0.01);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  EXPECT_TRUE(result_of(Summary(0.01)).has_value());
  for (const std::string& summary :
       {std::string("{}"),
        std::string(R"({"frames": {}})"),
        std::string(R"({"starts": {}})"),
        std::string(R"({"starts": {"starts": -1}, "wall_seconds": 1})"),
        changed("\"in\": 10", "\"in\": 0"),
        changed("\"in\": 10", "\"in\": \"ten\""),
        changed("\"in\": 10", "\"in\": 9.5"),
        changed("\"tracked\": 10", "\"tracked\": 11"),
        changed("\"tracked\": 10", "\"tracked\": null"),
        changed("\"lost\": 0", "\"lost\": -1"),
        changed("\"keyframes\": 3", "\"keyframes\": true"),
        changed("\"wall_seconds\": 2", "\"wall_seconds\": -2"),
        std::string(100'000, '[')}) {
    EXPECT_FALSE(result_of(summary).has_value()) << summary.substr(0, 200);
  }
}

TEST(Metrics, HaveNamesOfTheirOwnAndHelp) {
  std::set<std::string_view> names;
  for (const Metric& metric : Metrics()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.help.empty()) << metric.name;
    EXPECT_EQ(FindMetric(metric.name), &metric);
  }
  EXPECT_EQ(FindMetric("aet"), nullptr);
}

}  // namespace
}  // namespace plumbline
