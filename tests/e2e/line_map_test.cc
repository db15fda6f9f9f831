// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.h"
#include "tests/io/scratch_folder.h"
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

// Rendered images, a run, and the figures of its lines: in a wrong frame none would be right. The
// line map needs some keyframes, hence the long steps between the frames.
TEST(LineMap, LinesOfARunLieOnThoseOfTheRenderedRoom) {
  const ScratchFolder folder;
  const std::string room = Quoted(folder / "room"), run = Quoted(folder / "run");
  for (const std::string& command :
       {"synth room --set frames=30 --set rate_hz=10 --set texel=4 --set scale=0.5 --out " + room,
        "run " + room + " --quiet --out " + run,
        "lines " + room + " " + run + " --json " + Quoted(folder / "errors.json")}) {
    const Outcome outcome = RunProgram(folder, command);
    ASSERT_EQ(outcome.code, 0) << command << "\n" << outcome.err;
  }
  const auto json = nlohmann::json::parse(Contents(folder / "errors.json"));
  const auto& at_5_cm = json["tolerances"][2];
  EXPECT_GT(json["segments"], 30);
  EXPECT_GT(at_5_cm["precision"], 0.45);
  EXPECT_GT(at_5_cm["recall"], 0.25);
  EXPECT_GT(at_5_cm["with_counterpart"], 20);
  EXPECT_LT(at_5_cm["median_distance_m"], 0.03);
}

}  // namespace
}  // namespace plumbline
