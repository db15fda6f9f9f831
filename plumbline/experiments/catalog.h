// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// One way to run a sequence.
struct Variant {
  std::string name;                         // also the name of a folder: letters, digits, + - _
  std::vector<std::string> settings;        // KEY=VALUE, as of plumbline run --set
  std::vector<std::string> arguments = {};  // further arguments of plumbline run: {"--blur", "5"}
};

// Sequences to run, by name: FOLDER/NAME for what is found in a folder of the data (euroc, kitti,
// tum, icl or any other), worlds/NAME for rendered ones. * and ? stand for any characters.
struct SequenceChoice {
  std::string pattern;
  std::vector<std::string> world_settings = {};  // KEY=VALUE, as of plumbline synth --set
  std::string label = {};  // for worlds with settings: the sequence is called worlds/NAME@label
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
};

// The experiments there are. A new one is an entry here and nothing else.
std::span<const Experiment> Experiments();

// Throws InputError for an unknown name, with the names there are.
const Experiment& FindExperiment(std::string_view name);

}  // namespace plumbline
