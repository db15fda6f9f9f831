// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {

// The poster sequence and what a run made of it, once for all tests; nobody changes it.
struct PosterRun {
  PosterRun() : sequence(WritePosterSequence(folder, 24)), out(folder / "out") {
    map = out / "map.plb";
    const Outcome outcome =
        RunProgram(folder, "run " + Quoted(sequence) + " --quiet --out " + Quoted(out));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }

  ScratchFolder folder;
  std::filesystem::path sequence, out, map;
};

inline const PosterRun& Posters() {
  static const PosterRun run;
  return run;
}

// One line on stderr, nothing on stdout, exit code 2.
inline void ExpectRefusal(const Outcome& outcome, const std::string& message) {
  EXPECT_EQ(outcome.code, 2) << message;
  EXPECT_EQ(outcome.out, "") << message;
  EXPECT_THAT(outcome.err, testing::StartsWith("plumbline: "));
  EXPECT_THAT(outcome.err, testing::HasSubstr(message));
  EXPECT_THAT(outcome.err, testing::EndsWith("\n"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

}  // namespace plumbline
