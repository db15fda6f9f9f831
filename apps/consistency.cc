// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/consistency_report.h"
#include "lab/consistency/run_consistency.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/evaluate_outputs.h"
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {
namespace {

constexpr int kLeastSamples = 200;

CommandSyntax ConsistencySyntax() {
  return {
      "consistency",
      "Holds the covariances that a run promises against the ground truth of its sequence: of "
      "features,\nlandmarks and motions. Counts the errors within their 90 % intervals, by "
      "class.",
      {"SEQUENCE", "RUN"},
      {{"--poses",
        "truth|run",
        "keyframe poses for features: the true ones, or RUN's final ones (truth)"},
       {"--least", "N", "least number of errors of a class that is shown (200)"},
       {"--json", "FILE|-", "write all classes as JSON; -: to standard output, and nothing else"}}};
}

}  // namespace

int ConsistencyCommand(std::span<const std::string> arguments) {
  const CommandLine line(ConsistencySyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(ConsistencySyntax());
    return 0;
  }
  const std::filesystem::path sequence = line.Positional(0), run = line.Positional(1);
  const auto poses =
      ParseChoice<ConsistencyPoses>("--poses", line.Value("--poses").value_or("truth"));
  const int least = line.Count("--least", kLeastSamples, {1, 1'000'000'000});
  const EvaluateOutputs outputs = ReadOutputs(line, {});
  CheckOutputs(outputs, sequence, {run / "map.plb"});
  const auto samples = ReadRunConsistency(sequence, run, poses);
  if (!samples) {
    throw InputError(sequence.string() + ": expected ground truth of poses in " +
                     (run / "trajectory.txt").string() + ", found none");
  }
  const std::vector<ConsistencyShare> shares = ConsistencyShares(*samples);
  const std::string json = ConsistencyJson(shares);
  std::vector<FileContents> files;
  if (outputs.json) files.push_back({*outputs.json, json});
  WriteOutputs(outputs, files);
  std::cout << (outputs.json_to_stdout ? json
                                       : ConsistencyTable(shares, static_cast<std::size_t>(least)));
  return 0;
}

}  // namespace plumbline
