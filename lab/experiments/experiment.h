// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Settings of the runs of a sequence.
struct Variant {
  std::string name;                         // also the name of a folder: letters, digits, + - _
  std::vector<std::string> settings;        // KEY=VALUE, as of plumbline run --set
  std::vector<std::string> arguments = {};  // further arguments of the command: {"--blur", "5"}
  // For plots with a curve over a number that differs between the variants: the curve and the
  // number of this variant.
  std::string curve = {};
  double abscissa = 0;
  // Run by an earlier version of the program, given by the request (PlanRequest::earlier).
  bool by_earlier = false;
  // The variant of comparison, replacing Experiment::reference.
  std::string reference = {};
  bool reversed = false;  // plays the sequence from its last frame to its first
};

// Sequences to run, by name: FOLDER/NAME for those in a folder of the data (euroc, kitti, tum, icl
// or any other), worlds/NAME for rendered ones. * and ? stand for any characters.
struct SequenceChoice {
  std::string pattern;
  std::vector<std::string> world_settings = {};  // KEY=VALUE, as of plumbline synth --set
  std::string label =
      {};  // the sequence is called FOLDER/NAME@label; worlds with settings need one
  std::vector<std::string> arguments = {};  // further arguments of the command for these
  // A sequence of a paper: its name in the paper, and its source. The name may then be followed by
  // _firstN: a part of the sequence.
  std::string paper = {};
  std::string source = {};
};

// Size of rendered worlds. Recorded sequences are not changed.
enum class WorldSize {
  kTest,  // half as wide and high, at most 150 frames
  kFull,  // the size in the options of the world
};
constexpr auto EnumNames(std::type_identity<WorldSize>) {
  return std::array{std::pair{WorldSize::kTest, "test"}, std::pair{WorldSize::kFull, "full"}};
}

// Command that produces the figures of a run.
enum class RunCommandKind {
  kRun,       // plumbline run
  kStarts,    // plumbline starts
  kComputed,  // plumbline experiment: computes by itself (computed.h)
};

// Plots made from the runs' folders, beside those of metrics.
enum class PaperPlot {
  kNone,
  kRevisits,      // landmarks made at the beginning and at the end, from above (Figure 6)
  kConvergence,   // errors by duration of initialization, and by points (Figure 8)
  kTrajectories,  // paths beside the true one, from above (Figure 9)
  kLineMaps,      // the lines of the maps, from above and from the side (Figure 10)
  kLineArea,      // the lines visible in one image, from its camera and from above (Figure 11)
  kCutLines,      // images with the measured lines and the cut pieces (Figure 5)
};

// Sequences whose starts are also pooled.
struct SequencePool {
  std::string name;
  std::vector<std::string> patterns;  // as SequenceChoice::pattern
};

// Runs behind a table or a figure: every variant on every sequence, several times.
struct Experiment {
  std::string name;
  std::string help;  // its purpose, one sentence
  std::vector<SequenceChoice> sequences;
  std::vector<Variant> variants;
  std::vector<std::string> metrics;  // of metrics.h: columns of the table, in this order
  std::vector<std::string> plots;    // metrics that get a plot
  int runs = 5;
  RunCommandKind command = RunCommandKind::kRun;
  WorldSize size = WorldSize::kTest;     // default
  std::vector<SequencePool> pools = {};  // kStarts: additional rows
  std::string abscissa = {};             // meaning of Variant::abscissa; empty: no plots over it
  // The variant that divides the errors of the others, run by run (paired_ratios.h); empty: none.
  std::string reference = {};
  std::vector<std::string> ratios = {"ate"};  // metrics of these ratios
  // If set, tables have means instead of medians, runs that lost the camera (a pose for less than
  // 99 % of the frames) count as failed, and a variant with more failed runs than this on a
  // sequence has only "-" there, as in the second paper's tables.
  std::optional<int> tolerated_failures = {};
  // Runs with --full, if more than `runs`.
  std::optional<int> full_runs = {};
  std::vector<std::string> test_arguments = {};  // of the command, without --full
  // True if it measures times: its runs have the machine to themselves, and those of the variants
  // alternate, so that a slowdown of the machine affects all of them.
  bool exclusive = false;
  PaperPlot paper_plot = PaperPlot::kNone;
};

// Experiments under one name: all those of a figure or a paper.
struct ExperimentGroup {
  std::string name;
  std::string help;
  std::vector<std::string> experiments;  // names of Experiments() and ComputedExperiments()
};

}  // namespace plumbline
