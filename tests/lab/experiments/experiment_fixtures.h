// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"
#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"
#include "plumbline/io/export/png.h"

#include "tests/io/scratch_folder.h"
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace plumbline {

// A plain grey image of 64x48 pixels.
inline void WriteImage(const ScratchFolder& folder, const std::string& name) {
  GrayImage image(64, 48);
  WriteGrayPng(folder.Write(name, ""), image);
}

// A recorded sequence of three frames that can be opened.
inline void WriteSequenceFolder(const ScratchFolder& folder, const std::string& name) {
  std::string list = "#timestamp [ns],filename\n";
  for (int i = 0; i < 3; ++i) {
    list += fmt::format("{},{}.png\n", 1'000'000'000 + 50'000'000LL * i, i);
    for (const int camera : {0, 1}) {
      WriteImage(folder, fmt::format("{}/mav0/cam{}/data/{}.png", name, camera, i));
    }
  }
  for (const int camera : {0, 1}) {
    const std::string root = fmt::format("{}/mav0/cam{}/", name, camera);
    folder.Write(root + "data.csv", list);
    folder.Write(root + "sensor.yaml",
                 fmt::format("T_BS:\n  cols: 4\n  rows: 4\n  data: [1,0,0,{}, 0,1,0,0, 0,0,1,0, "
                             "0,0,0,1]\nrate_hz: 20\nresolution: [64, 48]\ncamera_model: pinhole\n"
                             "intrinsics: [50, 50, 32, 24]\ndistortion_model: none\n",
                             0.1 * camera));
  }
}

// Two variants on what is in euroc/.
inline Experiment TwoVariants() {
  Experiment experiment;
  experiment.name = "pair";
  experiment.help = "one thing and the other";
  experiment.sequences = {{"euroc/*"}};
  experiment.variants = {{"one", {"features.lines=false"}}, {"two", {}}};
  experiment.metrics = {"ate", "lost", "fps"};
  experiment.plots = {"ate"};
  experiment.runs = 2;
  return experiment;
}

inline PlanRequest RequestIn(const ScratchFolder& folder) {
  PlanRequest request;
  request.sources.data = folder / "data";
  request.sources.cache = folder / "cache";
  request.out = folder / "out";
  request.program = "the program";
  return request;
}

// A plan over two sequences, a and b, as TwoVariants.
inline Plan PlanOfTwo(const ScratchFolder& folder) {
  WriteSequenceFolder(folder, "data/euroc/a");
  WriteSequenceFolder(folder, "data/euroc/b");
  return MakePlan(TwoVariants(), RequestIn(folder));
}

// summary.json of a run, as far as it is read.
inline std::string Summary(double ate_m, int tracked = 10, int frames = 10) {
  return fmt::format(
      R"({{"frames": {{"in": {}, "tracked": {}, "in_trajectory": {}, "lost": {}, "skipped": 0, "dropped": 0,
         "initializing": 0}}, "maps": 1, "keyframes": 3, "points": 100, "lines": 20,
         "accuracy": {{"ate": {{"rmse": {}}}}}, "accuracy_causal": null,
         "timing": {{"total": {{"median_ms": 20, "p95_ms": 30}}}}, "first_pose_seconds": 0.2,
         "wall_seconds": 2, "cpu_seconds": 1, "peak_memory_mb": 100}})",
      frames,
      tracked,
      tracked,
      frames - tracked,
      ate_m);
}

// The figures of a run; equal `trajectory`: the same run.
inline JobResult Success(double ate_mm, const std::string& trajectory, double coverage = 100) {
  RunFigures figures;
  figures.values = {{"ate", ate_mm}, {"coverage", coverage}, {"lost", 0}, {"fps", 30}};
  figures.trajectory = trajectory;
  return {figures, ""};
}
inline JobResult NoResult(const std::string& reason) { return {std::nullopt, reason}; }

// Of the runs of PlanOfTwo: one of them crashed.
inline std::vector<JobResult> SomeResults() {
  return {Success(4, "a"),
          Success(5, "b"),
          NoResult("ended by signal 11"),
          Success(6, "c"),
          Success(7, "d"),
          Success(8, "e"),
          Success(9, "f"),
          Success(10, "g")};
}

// Figures of two groups of sequences; one of them has no value.
inline std::vector<FigureRow> SomeFigures() {
  return {{"one/a", "cut", {}, "gain", 1.234, ""},
          {"one/a", "cut", {}, "time", 56.7, "us"},
          {"one/b", "whole", 3, "gain", {}, "", "no lines"},
          {"two/a", "cut", {}, "time", 8, "us"}};
}

}  // namespace plumbline
