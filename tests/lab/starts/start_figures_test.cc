// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_figures.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

StartRecord Start(StartOutcome outcome, std::optional<double> parallax, double rotation = 0) {
  StartRecord record;
  record.outcome = outcome;
  record.greatest_parallax_deg = parallax;
  if (outcome == StartOutcome::kWaiting) return record;
  record.map = StartMap{};
  record.map->seconds = 10 * rotation;
  record.map->errors.rotation_deg = rotation;
  return record;
}

TEST(StartFigures, CountAgainstWhatIsPossible) {
  using enum StartOutcome;
  const std::vector<StartRecord> records = {Start(kRight, 2.0, 0.1),
                                            Start(kRight, 8, 0.3),
                                            Start(kRight, 1.9, 0.2),  // early, but not asked for
                                            Start(kWaiting, 3),
                                            Start(kWaiting, 0.1),
                                            Start(kWrong, 3, 0.9),
                                            Start(kWrong, 0.1, 0.7),
                                            Start(kLate, 2.5, 0.3),
                                            Start(kLate, 1.5, 0.3),  // not asked for
                                            Start(kRight, std::nullopt, 0.4)};
  const auto figures = FiguresOf(records);
  EXPECT_EQ(figures.at("starts"), 10);
  EXPECT_EQ(figures.at("possible"), 5);
  EXPECT_EQ(figures.at("success"), 40);
  EXPECT_EQ(figures.at("success_in_the_end"), 60);
  EXPECT_EQ(figures.at("late"), 1);
  EXPECT_EQ(figures.at("waiting"), 1);
  EXPECT_EQ(figures.at("wrong"), 2);
  EXPECT_EQ(figures.at("wrong_rate"), 20);
  EXPECT_EQ(figures.at("accepted"), 80);
  EXPECT_EQ(figures.at("rotation_error"), 0.3);
  EXPECT_EQ(figures.at("rotation_error_p95"), 0.9);
  EXPECT_EQ(figures.at("map_seconds"), 3);
  EXPECT_FALSE(figures.contains("depth_error")) << "never known";
}

TEST(StartFigures, LeaveOutWhatIsNotKnown) {
  const std::vector<StartRecord> records = {Start(StartOutcome::kRight, std::nullopt)};
  const auto figures = FiguresOf(records);
  EXPECT_FALSE(figures.contains("possible") || figures.contains("success") ||
               figures.contains("waiting"));
  EXPECT_EQ(figures.at("accepted"), 100);
  const auto nothing = FiguresOf({});
  EXPECT_EQ(nothing.at("starts"), 0);
  EXPECT_FALSE(nothing.contains("wrong_rate"));
}

TEST(StartFigures, PercentilesAreValuesThatOccur) {
  std::vector<double> values;
  for (int i = 20; i > 0; --i) values.push_back(i);
  EXPECT_EQ(Percentile(values, 0.5), 10);
  EXPECT_EQ(Percentile(values, 0.95), 19);
  EXPECT_EQ(Percentile(values, 1), 20);
  EXPECT_EQ(Percentile({7}, 0.5), 7);
}

}  // namespace
}  // namespace plumbline
