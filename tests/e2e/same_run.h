// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/e2e/program.h"
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {

// Runs of the same frames from two sources have the same trajectories, tables and lines. Maps name
// the data that they were made from, and are left out.
inline void ExpectSameResults(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::set<std::string> compared;
  for (const std::string& name : FilesOf(a)) {
    if (!IsRepeatable(name) || name == "map.plb") continue;
    compared.insert(name);
    EXPECT_EQ(Contents(a / name) == Contents(b / name), true) << name;
  }
  EXPECT_GE(compared.size(), 6U);
  EXPECT_GT(Contents(a / "trajectory.txt").size(), 1000U);
}

}  // namespace plumbline
