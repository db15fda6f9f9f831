// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Runs a gate of experiments and expects its limits to be kept.
void ExpectLimitsKept(const std::string& experiment) {
  const ScratchFolder folder;
  const auto data = FindData(".");
  const std::string sources = data ? " --data " + Quoted(*data) : "";
  const Outcome outcome = RunProgram(
      folder,
      "experiment " + experiment +
          " --quiet --jobs 2 --time-limit 100000 --cache '" PLUMBLINE_RENDERED_FOLDER "' --out " +
          Quoted(folder / "out") + sources);
  EXPECT_EQ(outcome.code, 0) << outcome.err << Contents(folder / "out/gate.md");
}

// The worlds, and the recorded sequences where they are there.
TEST(ExperimentGate, KeepsItsLimits) { ExpectLimitsKept("gate"); }

TEST(ExperimentGate, LinesKeepTheirLimits) { ExpectLimitsKept("gate_lines"); }

}  // namespace
}  // namespace plumbline
