// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/experiments/metrics.h"

#include "tests/experiments/experiment_fixtures.h"
#include "tests/io/scratch_folder.h"
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

TEST(Metrics, TellTheMemoryOfALine) {
  const ScratchFolder folder;
  folder.Write("summary.json",
               R"({"frames": {"tracked": 1}, "line_bytes": {"map": 512.5, "adjustment": null}})");
  const auto figures = ReadFigures(folder.path());
  ASSERT_TRUE(figures.has_value());
  EXPECT_DOUBLE_EQ(figures->values.at("map_line_bytes"), 512.5);
  EXPECT_FALSE(figures->values.contains("adjusted_line_bytes"));
  EXPECT_EQ(figures->reasons.at("adjusted_line_bytes"), "there is no line");
}

TEST(Metrics, OfStartsAreReadFromTheirSummary) {
  const ScratchFolder folder;
  folder.Write("summary.json",
               R"({"starts": {"success": 97.5, "wrong": 0}, "add": {"median_ms": 1.5}})");
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
