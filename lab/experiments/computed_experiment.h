// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace plumbline {

// An experiment that computes by itself, without sequences and runs of the program (unlike
// Experiment in experiment.h).
struct ComputedExperiment {
  std::string name;
  std::string help;        // its purpose, one sentence
  int repeats = 1;         // default
  int full_repeats = 1;    // default with --full
  double repeat_s = 1;     // approximate duration of a repeat
  bool exclusive = false;  // true if it measures times
  std::span<const FigureMetric> metrics;
  // Computes and writes results.json, timing.json, table.md, table.html and plots/*.svg into `out`,
  // and timing.md if it measures times. `progress(done, total)` returns false to stop; no file is
  // then written and false returned. Throws InputError if a file cannot be written.
  using Progress = std::function<bool(std::size_t, std::size_t)>;
  bool (*run)(const ComputedExperiment& self,
              int repeats,
              const std::filesystem::path& out,
              const Progress& progress) = nullptr;
};

}  // namespace plumbline
