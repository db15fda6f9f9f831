// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/text_rows.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/evaluate_report.h"
#include "apps/figure_file.h"
#include <cmath>
#include <cstdint>
#include <iostream>
#include <optional>
#include <span>
#include <string>

namespace plumbline {
namespace {

CommandSyntax Syntax() {
  return {
      "evaluate",
      "Compares an estimated trajectory with ground truth: a trajectory in TUM form, EuRoC csv or "
      "KITTI\nposes, or the folder of a data set that has it.",
      {"REFERENCE", "ESTIMATE"},
      {{"--align", "none|se3|sim3", "what is aligned before positions are compared (se3)"},
       {"--delta", "3s|1f", "window of RPE and ROE, seconds or frames (3s)"},
       {"--associate", "interpolate|nearest", "how poses of the reference are found (interpolate)"},
       {"--reference-frame",
        "camera|body",
        "what the reference is about (body for EuRoC, else camera)"},
       {"--mirror-y", "", "mirror the reference in y (original ICL-NUIM ground truth)"},
       {"--json", "FILE", "write the figures as JSON"},
       {"--plot", "FILE", "draw path and errors, .svg or .png"}}};
}

// "3s" or "1f".
RelativeWindow ParseWindow(const std::string& text) {
  constexpr double kNanoseconds = 1e9, kLongestS = 1e6, kMostFrames = 1e6;
  const char unit = text.empty() ? ' ' : text.back();
  const std::optional<double> number =
      ParseNumber(text.substr(0, text.empty() ? 0 : text.size() - 1));
  RelativeWindow window;
  if (number && unit == 's' && *number >= 1e-6 && *number <= kLongestS) {
    window.duration_ns = std::llround(*number * kNanoseconds);
    return window;
  }
  if (number && unit == 'f' && *number >= 1 && *number <= kMostFrames &&
      *number == std::floor(*number)) {
    window.frames = static_cast<int>(*number);
    return window;
  }
  throw InputError("--delta: expected seconds such as 3s or frames such as 1f, found " + text);
}

TrajectoryErrorOptions ErrorOptions(const CommandLine& line, TrajectoryFormat format) {
  constexpr std::int64_t kKittiGapNs = 250'000'000;  // its frames are 0.1 s apart
  TrajectoryErrorOptions options;
  if (const auto text = line.Value("--align")) {
    options.alignment = ParseChoice<TrajectoryAlignment>("--align", *text);
  }
  if (const auto text = line.Value("--associate")) {
    options.association = ParseChoice<TrajectoryAssociation>("--associate", *text);
  }
  if (const auto text = line.Value("--delta")) options.window = ParseWindow(*text);
  if (format == TrajectoryFormat::kKitti) options.max_gap_ns = kKittiGapNs;
  return options;
}

[[noreturn]] void FailNoOverlap(const Trajectory& reference, const Trajectory& estimate) {
  const auto span = [](const Trajectory& trajectory) {
    return FormatStamp(trajectory.front().stamp_ns) + " to " +
           FormatStamp(trajectory.back().stamp_ns);
  };
  throw InputError(
      "no pose of the estimate has a reference pose at its time: the reference covers " +
      span(reference) + ", the estimate " + span(estimate));
}

}  // namespace

int EvaluateCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(Syntax());
    return 0;
  }
  std::optional<ReferenceFrame> frame;
  if (const auto text = line.Value("--reference-frame")) {
    frame = ParseChoice<ReferenceFrame>("--reference-frame", *text);
  }
  Evaluation evaluation;
  evaluation.reference = LoadReference(line.Positional(0), frame);
  if (line.Has("--mirror-y")) evaluation.reference.poses = MirroredY(evaluation.reference.poses);
  const Trajectory estimate = ReadTrajectory(line.Positional(1)).poses;
  evaluation.options = ErrorOptions(line, evaluation.reference.format);
  const auto error = CompareTrajectories(evaluation.reference.poses, estimate, evaluation.options);
  if (!error) FailNoOverlap(evaluation.reference.poses, estimate);
  evaluation.error = *error;
  evaluation.frames_delivered = FramesOfRun(line.Positional(1));
  if (!evaluation.frames_delivered) evaluation.frames_delivered = evaluation.reference.frames;

  if (const auto path = line.Value("--json"))
    WriteFileAtomically(*path, EvaluationJson(evaluation));
  if (const auto path = line.Value("--plot")) WriteFigure(*path, TrajectoryFigure(*error));
  std::cout << EvaluationTable(evaluation);
  return 0;
}

}  // namespace plumbline
