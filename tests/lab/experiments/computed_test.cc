// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/computed.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

fs::path EmptyFolder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / name;
  fs::remove_all(folder);
  return folder;
}

TEST(ComputedExperiments, AreFoundByName) {
  ASSERT_NE(FindComputedExperiment("cutting-testbed"), nullptr);
  EXPECT_EQ(FindComputedExperiment("cutting"), nullptr);
}

TEST(ComputedExperiments, CuttingTestbedWritesItsFiles) {
  const ComputedExperiment& experiment = *FindComputedExperiment("cutting-testbed");
  const fs::path out = EmptyFolder("cutting_testbed");
  ASSERT_TRUE(experiment.run(experiment, 1, out, [](auto, auto) { return true; }));
  std::ifstream file(out / "results.json");
  const auto figures = nlohmann::json::parse(file);
  EXPECT_GT(figures.size(), 1000U);
  for (const auto& figure : figures) {
    EXPECT_EQ(figure["experiment"], "cutting-testbed");
    EXPECT_TRUE(figure["value"].is_number()) << figure;
  }
  for (const char* name : {"timing.json",
                           "table.md",
                           "table.html",
                           "plots/pose_error.svg",
                           "plots/camera_path.svg",
                           "plots/surface_point.svg",
                           "plots/joint_gain_idp.svg"}) {
    EXPECT_TRUE(fs::is_regular_file(out / name)) << name;
  }
}

TEST(ComputedExperiments, TimesStandInFilesOfTheirOwn) {
  const ComputedExperiment& experiment = *FindComputedExperiment("rippl-timing-initialization");
  const fs::path out = EmptyFolder("initialization_timing");
  ASSERT_TRUE(experiment.run(experiment, 1, out, [](auto, auto) { return true; }));
  std::ifstream results(out / "results.json"), times(out / "timing.json");
  for (const auto& figure : nlohmann::json::parse(results))
    EXPECT_NE(std::string(figure["unit"]), "ms");
  for (const auto& figure : nlohmann::json::parse(times))
    EXPECT_EQ(std::string(figure["unit"]), "ms");
  EXPECT_TRUE(fs::is_regular_file(out / "timing.md"));
}

TEST(ComputedExperiments, WriteNothingWhenStopped) {
  const ComputedExperiment& experiment = *FindComputedExperiment("cutting-testbed");
  const fs::path out = EmptyFolder("cutting_testbed_stopped");
  EXPECT_FALSE(experiment.run(experiment, 1, out, [](auto, auto) { return false; }));
  EXPECT_FALSE(fs::exists(out / "results.json"));
}

}  // namespace
}  // namespace plumbline
