// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/experiments/catalog.h"

#include "plumbline/base/error.h"

#include <array>

namespace plumbline {

std::span<const Experiment> Experiments() {
  static const std::array kExperiments = {
      Experiment{
          .name = "sensors",
          .help = "points, lines and both together on every sequence there is",
          .sequences = {{"worlds/*"}, {"euroc/*"}, {"kitti/*"}, {"tum/*"}, {"icl/*"}},
          .variants = {{"points", {"features.lines=false"}},
                       {"lines", {"features.points=false"}},
                       {"both", {}}},
          .metrics = {"ate",          "rpe_mean",    "rpe_rmse",       "roe_mean",  "roe_rmse",
                      "ate_causal",   "lost",        "skipped",        "keyframes", "points",
                      "lines",        "line_recall", "line_precision", "fps",       "frame_ms",
                      "frame_p95_ms", "cpu_ms",      "first_pose_s",   "memory_mb", "dropped"},
          .plots = {"ate", "rpe_rmse", "roe_rmse", "coverage", "frame_ms"}},
  };
  return kExperiments;
}

const Experiment& FindExperiment(std::string_view name) {
  std::string names;
  for (const Experiment& experiment : Experiments()) {
    if (experiment.name == name) return experiment;
    names += (names.empty() ? "" : ", ") + experiment.name;
  }
  throw InputError("there is no experiment '" + std::string(name) + "'; there are: " + names);
}

}  // namespace plumbline
