// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs over small rendered worlds: the path of the camera, and how well the lines of the map lie on
// the true ones. To see the figures of one:
//
//   plumbline synth WORLD --set scale=0.5 --set frames=100 --out W
//   plumbline run W --out R && plumbline lines W R
#include "worlds/sequence_cache.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include "tests/e2e/misfit_gate.h"
#include "tests/e2e/program.h"
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace worlds_accuracy_test {

struct WorldGate {
  const char* world;
  const char* settings;  // of the run
  double max_ate_m;
  // Of lines, at 5 cm. Metres of true lines, not a share of those asked for, which are fewer the
  // fewer keyframes there are.
  double min_found_m, min_precision;
  int frames = 100;
  double max_causal_m = 1;  // of poses as they were first reported
};

void Check(const WorldGate& gate) {
  constexpr int kThreads = 2;
  SynthOptions options;
  if (const auto adjust = FindWorld(gate.world).adjust) adjust(options);
  options.scale = 0.5;
  options.frames = gate.frames;
  const ScratchFolder folder;
  const std::filesystem::path world =
      CachedSequence(PLUMBLINE_RENDERED_FOLDER, gate.world, options, kThreads);
  const std::string run = Quoted(folder / "run");
  const auto expect_done = [&](const std::string& command) {
    const Outcome outcome = RunProgram(folder, command);
    ASSERT_EQ(outcome.code, 0) << command << "\n" << outcome.err;
  };
  expect_done("run " + Quoted(world) + " " + gate.settings + " --imu off --quiet --out " + run);
  const auto summary = nlohmann::json::parse(Contents(folder / "run/summary.json"));
  EXPECT_EQ(summary["frames"]["tracked"], gate.frames);
  EXPECT_EQ(summary["maps"], 1);
  EXPECT_LE(summary["accuracy"]["ate"]["rmse"], gate.max_ate_m);
  EXPECT_LE(summary["accuracy_causal"]["ate"]["rmse"], gate.max_causal_m);
  ExpectLandmarksFit(folder / "run/map.plb");
  if (gate.min_found_m == 0) return;
  expect_done("lines " + Quoted(world) + " " + run + " --json " + Quoted(folder / "errors.json"));
  const auto lines = nlohmann::json::parse(Contents(folder / "errors.json"));
  const auto& at_5_cm = lines["tolerances"][2];
  EXPECT_GE(at_5_cm["recall"].get<double>() * lines["asked_length_m"].get<double>(),
            gate.min_found_m);
  EXPECT_GE(at_5_cm["precision"], gate.min_precision);
}

TEST(WorldsAccuracy, Room) { Check({"room", "", 0.006, 120, 0.7}); }
TEST(WorldsAccuracy, LowTexture) { Check({"lowtexture", "", 0.006, 72, 0.48}); }
TEST(WorldsAccuracy, RoomWithLinesOnly) {
  Check({"room", "--set features.points=false", 0.008, 0, 0});
}
TEST(WorldsAccuracy, LowTextureWithLinesOnly) {
  Check({"lowtexture", "--set features.points=false", 0.006, 0, 0});
}
TEST(WorldsAccuracy, Lateral) { Check({"lateral", "", 0.006, 30, 0.85}); }
TEST(WorldsAccuracy, Planar) { Check({"planar", "", 0.004, 0, 0}); }
// Two walk past the camera, near, from frame 85 on.
TEST(WorldsAccuracy, Dynamic) { Check({"dynamic", "", 0.015, 0, 0, 150}); }
// One camera: poses as they were first reported have the unit of length of all later ones.
TEST(WorldsAccuracy, LowTextureWithOneCamera) {
  Check({"lowtexture", "--sensor mono", 0.005, 0, 0, 100, 0.007});
}
TEST(WorldsAccuracy, PlanarWithPointsOnly) {
  Check({"planar", "--set features.lines=false", 0.004, 0, 0});
}

}  // namespace worlds_accuracy_test
}  // namespace plumbline
