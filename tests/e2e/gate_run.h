// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/e2e/gates.h"
#include "tests/e2e/misfit_gate.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {

// summary.json of a run over a gate's sequence; null (and a failure) when the run failed. What does
// not fit in its map is a failure, too.
inline nlohmann::json Summary(const Gate& gate,
                              const std::filesystem::path& data,
                              const std::string& mode) {
  const ScratchFolder folder;
  const Outcome outcome =
      RunProgram(folder,
                 "run " + Quoted(data) + " " + gate.settings + " --mode " + mode +
                     " --imu off --quiet --out " + Quoted(folder / "run"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  if (outcome.code != 0) return nullptr;
  ExpectLandmarksFit(folder / "run/map.plb");
  return nlohmann::json::parse(Contents(folder / "run/summary.json"));
}

// A run over the data reaches what the gate asks for. Inline and lockstep give the same bytes
// (run_command_test), so one of them will do.
inline void CheckGate(const Gate& gate, const std::filesystem::path& data) {
  const nlohmann::json summary = Summary(gate, data, "lockstep");
  ASSERT_FALSE(summary.is_null());
  const auto& frames = summary["frames"];
  EXPECT_EQ(frames["tracked"], gate.tracked);
  EXPECT_EQ(frames["skipped"], gate.skipped);
  EXPECT_EQ(frames["in"], gate.tracked + gate.skipped);
  EXPECT_EQ(summary["maps"], 1);
  ASSERT_FALSE(summary["accuracy"].is_null());
  EXPECT_GE(summary["accuracy"]["associated"], gate.tracked - 2);
  EXPECT_LE(summary["accuracy"]["ate"]["rmse"], gate.max_ate_m);
}

}  // namespace plumbline
