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

// One way to run a sequence.
struct Variant {
  std::string name;                         // also the name of a folder: letters, digits, + - _
  std::vector<std::string> settings;        // KEY=VALUE, as of plumbline run --set
  std::vector<std::string> arguments = {};  // further arguments of the command: {"--blur", "5"}
  // Where a plot has a curve over a number that differs between the variants: the curve and the
  // number of this one.
  std::string curve = {};
  double abscissa = 0;
  // Run by an earlier version of the program, which the request names (PlanRequest::earlier).
  bool by_earlier = false;
  // The variant that this one is compared with in place of Experiment::reference.
  std::string reference = {};
  bool reversed = false;  // plays the sequence from its last frame to its first
};

// Sequences to run, by name: FOLDER/NAME for what is found in a folder of the data (euroc, kitti,
// tum, icl or any other), worlds/NAME for rendered ones. * and ? stand for any characters.
struct SequenceChoice {
  std::string pattern;
  std::vector<std::string> world_settings = {};  // KEY=VALUE, as of plumbline synth --set
  std::string label =
      {};  // the sequence is called FOLDER/NAME@label; worlds with settings need one
  std::vector<std::string> arguments = {};  // further arguments of the command on these
  // A sequence of a paper: what the paper calls it, and where users get it. The name may then be
  // followed by _firstN: a part of the sequence.
  std::string paper = {};
  std::string source = {};
};

// How large worlds are rendered. Recorded sequences are taken as they are.
enum class WorldSize {
  kTest,  // half as wide and high, at most 150 frames
  kFull,  // as the options of the world have it
};
constexpr auto EnumNames(std::type_identity<WorldSize>) {
  return std::array{std::pair{WorldSize::kTest, "test"}, std::pair{WorldSize::kFull, "full"}};
}

// The command that makes the figures of a run.
enum class RunCommandKind {
  kRun,       // plumbline run
  kStarts,    // plumbline starts
  kComputed,  // plumbline experiment: computes by itself (computed.h)
};

// Plots that are made of the runs' folders, beside those of metrics.
enum class PaperPlot {
  kNone,
  kRevisits,      // landmarks made at the beginning and at the end, from above (Figure 6)
  kConvergence,   // errors by how long the start takes, and by points (Figure 8)
  kTrajectories,  // paths beside the true one, from above (Figure 9)
  kLineMaps,      // the lines of the maps, from above and from the side (Figure 10)
  kLineArea,      // the lines that one image shows, from its camera and from above (Figure 11)
  kCutLines,      // images with the measured lines and the pieces that are left (Figure 5)
};

// Sequences whose starts are also taken together.
struct SequencePool {
  std::string name;
  std::vector<std::string> patterns;  // as SequenceChoice::pattern
};

// What makes a table or a figure: every variant on every sequence, several times.
struct Experiment {
  std::string name;
  std::string help;  // what it shows, one sentence
  std::vector<SequenceChoice> sequences;
  std::vector<Variant> variants;
  std::vector<std::string> metrics;  // of metrics.h: columns of the table, in this order
  std::vector<std::string> plots;    // metrics that get a plot
  int runs = 5;
  RunCommandKind command = RunCommandKind::kRun;
  WorldSize size = WorldSize::kTest;     // unless asked for otherwise
  std::vector<SequencePool> pools = {};  // kStarts: additional rows
  std::string abscissa = {};             // what Variant::abscissa is; empty: no plots over it
  // The variant whose errors the others' are divided by, run by run (paired_ratios.h); empty: none.
  std::string reference = {};
  std::vector<std::string> ratios = {"ate"};  // metrics that are divided so
  // Set: tables have means instead of medians, runs that lost the camera (a pose for less than 99 %
  // of the frames) count as failed, and a variant with more failed runs than this on a sequence has
  // no figures there but "-", as the second paper's tables have it.
  std::optional<int> tolerated_failures = {};
  // Runs with --full, where these are more than `runs`.
  std::optional<int> full_runs = {};
  std::vector<std::string> test_arguments = {};  // of the command, without --full
  // Measures times: its runs have the machine for themselves, and those of the variants take turns,
  // so that a machine that slows down does so for all of them.
  bool exclusive = false;
  PaperPlot paper_plot = PaperPlot::kNone;
};

// Experiments under one name: all that reproduces a figure or a paper.
struct ExperimentGroup {
  std::string name;
  std::string help;
  std::vector<std::string> experiments;  // names of Experiments() and ComputedExperiments()
};

}  // namespace plumbline
