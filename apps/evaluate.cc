// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/trajectory_figure.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/evaluate_outputs.h"
#include "apps/evaluate_report.h"
#include "apps/figure_file.h"
#include "apps/reference_trajectory.h"
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr const char* kLinesInstead =
    "plumbline lines SEQUENCE RUN compares lines, where the laboratory is built";

CommandSyntax EvaluateSyntax() {
  return {
      "evaluate",
      "Compares estimated trajectories, or the folders of runs, with ground truth: a trajectory in "
      "TUM\nform, EuRoC csv or KITTI poses, or the folder of a data set that has it.",
      {"REFERENCE", "ESTIMATE", "[ESTIMATE ...]"},
      {{"--align",
        "none|se3|sim3",
        "what is aligned before positions are compared (se3; sim3 for the run of a single camera)"},
       {"--align-by",
        "OTHER",
        "the alignment is that of OTHER, in the same world as ESTIMATE: a run that made the map in "
        "which ESTIMATE was localized"},
       {"--align-reference", "FILE", "ground truth of OTHER, where it is not in REFERENCE"},
       {"--time-offset",
        "SECONDS",
        "added to the stamps of the estimates: 0.1 where their clock is 0.1 s behind that of "
        "REFERENCE"},
       {"--delta", "3s|1f", "window of RPE and ROE, seconds or frames (3s)"},
       {"--associate", "interpolate|nearest", "how poses of the reference are found (interpolate)"},
       {"--reference-frame",
        "camera|body",
        "what the reference is about (body for EuRoC, else camera)"},
       {"--mirror-y", "", "mirror the reference in y (original ICL-NUIM ground truth)"},
       {"--json", "FILE|-", "write the figures as JSON; -: to standard output, and nothing else"},
       {"--plot",
        "FILE",
        "draw path, errors, and x, y, z, roll, pitch, yaw over time, .svg or .png"},
       {"--save-aligned",
        "FILE|DIR",
        "write the estimates, aligned, in TUM form: one into FILE, several into DIR"}},
      {{"--true-lines", kLinesInstead},
       {"--lines", kLinesInstead},
       {"--surfaces", kLinesInstead},
       {"--align-lines", kLinesInstead},
       {"--plot-lines", kLinesInstead}}};
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
  throw InputError("--delta: expected seconds such as 3s or frames such as 1f, found " +
                   Printable(text));
}

// The data set whose ground truth is written like this.
DatasetFormat DatasetOf(TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::kTum:
      return DatasetFormat::kTum;
    case TrajectoryFormat::kEuroc:
      return DatasetFormat::kEuroc;
    case TrajectoryFormat::kKitti:
      return DatasetFormat::kKitti;
  }
  return DatasetFormat::kTum;
}

// Seconds with a sign, to the nanosecond.
std::int64_t ParseOffset(const std::string& text) {
  const bool negative = text.starts_with('-');
  const bool sign = negative || text.starts_with('+');
  const auto seconds = ParseSeconds(std::string_view(text).substr(sign ? 1 : 0));
  if (seconds) return negative ? -*seconds : *seconds;
  throw InputError("--time-offset: expected seconds such as -0.05, found " + Printable(text));
}

TrajectoryErrorOptions ErrorOptions(const CommandLine& line,
                                    TrajectoryFormat format,
                                    const std::filesystem::path& estimate) {
  const auto alignment = line.Value("--align");
  const bool free_scale = !alignment && IsMonocularRun(estimate);
  TrajectoryErrorOptions options =
      ErrorOptionsFor(free_scale ? SensorKind::kMono : SensorKind::kStereo, DatasetOf(format));
  if (alignment) options.alignment = ParseChoice<TrajectoryAlignment>("--align", *alignment);
  if (const auto text = line.Value("--associate")) {
    options.association = ParseChoice<TrajectoryAssociation>("--associate", *text);
  }
  if (const auto text = line.Value("--delta")) options.window = ParseWindow(*text);
  return options;
}

[[noreturn]] void FailNoOverlap(const std::filesystem::path& file,
                                const Trajectory& reference,
                                const Trajectory& estimate) {
  const auto span = [](const Trajectory& trajectory) {
    return FormatStamp(trajectory.front().stamp_ns) + " to " +
           FormatStamp(trajectory.back().stamp_ns);
  };
  throw InputError(
      file.string() +
      ": no pose of the estimate has a reference pose at its time: the reference covers " +
      span(reference) + ", the estimate " + span(estimate));
}

// The trajectory of a run's folder; any other path as it is.
std::filesystem::path EstimateFile(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return path;
  if (std::filesystem::is_regular_file(path / "trajectory.txt", error)) {
    return path / "trajectory.txt";
  }
  throw InputError(path.string() + ": expected a trajectory or the folder of a run, found no " +
                   "trajectory.txt in it");
}

// Returns the number of frames of the estimate; nullopt: unknown, also with more poses than frames,
// which then belong to another run.
std::optional<std::size_t> FramesDelivered(const std::filesystem::path& estimate_file,
                                           const ReferenceTrajectory& reference,
                                           const Trajectory& estimate) {
  std::optional<std::size_t> frames = FramesOfRun(estimate_file);
  if (!frames) frames = reference.frames;
  return frames && *frames >= estimate.size() ? frames : std::nullopt;
}

// Existing input files of the command.
std::vector<std::filesystem::path> FilesRead(const CommandLine& line,
                                             const ReferenceTrajectory& reference,
                                             const std::vector<std::filesystem::path>& estimates) {
  std::vector<std::filesystem::path> files = {reference.path};
  std::vector<std::filesystem::path> folders = {line.Positional(0)};
  for (const std::filesystem::path& estimate : estimates) {
    files.push_back(estimate);
    folders.push_back(estimate.parent_path());
  }
  for (const std::filesystem::path& folder : folders) {
    for (const char* name : {"frames.csv", "summary.json", "rgb.txt", "times.txt"}) {
      files.push_back(folder / name);
    }
  }
  return files;
}

ReferenceTrajectory LoadReferenceFor(const CommandLine& line, const std::string& path) {
  std::optional<ReferenceFrame> frame;
  if (const auto text = line.Value("--reference-frame")) {
    frame = ParseChoice<ReferenceFrame>("--reference-frame", *text);
  }
  ReferenceTrajectory reference = LoadReference(path, frame);
  if (line.Has("--mirror-y")) reference.poses = MirroredY(reference.poses);
  return reference;
}

Trajectory ReadEstimate(const CommandLine& line, const std::filesystem::path& file) {
  Trajectory poses = ReadTrajectory(file).poses;
  const auto text = line.Value("--time-offset");
  const std::int64_t offset_ns = text ? ParseOffset(*text) : 0;
  for (StampedPose& pose : poses) {
    pose.stamp_ns += offset_ns;
    if (IsReadableStamp(pose.stamp_ns)) continue;
    throw InputError("--time-offset " + *text + ": expected stamps before the year 2096, found " +
                     FormatStamp(pose.stamp_ns) + " in " + file.string());
  }
  return poses;
}

// The trajectory whose alignment is taken, aligned to its own ground truth; nullopt: each estimate
// has its own.
std::optional<Evaluation> EvaluateOther(const CommandLine& line,
                                        const ReferenceTrajectory& reference) {
  const auto other = line.Value("--align-by");
  const auto truth = line.Value("--align-reference");
  if (!other) {
    if (truth) throw InputError("--align-reference: expected --align-by as well");
    return std::nullopt;
  }
  Evaluation evaluation;
  evaluation.estimate = *other;
  evaluation.reference = truth ? LoadReferenceFor(line, *truth) : reference;
  const std::filesystem::path file = EstimateFile(*other);
  evaluation.options = ErrorOptions(line, evaluation.reference.format, file);
  if (evaluation.options.alignment == TrajectoryAlignment::kNone) {
    throw InputError("--align-by: expected --align se3 or sim3 beside it, found none");
  }
  const Trajectory poses = ReadEstimate(line, file);
  const auto error = CompareTrajectories(evaluation.reference.poses, poses, evaluation.options);
  if (!error) FailNoOverlap(file, evaluation.reference.poses, poses);
  evaluation.error = *error;
  return evaluation;
}

// An estimate that was compared with the reference.
struct EvaluatedEstimate {
  Evaluation evaluation;
  Trajectory poses;  // as compared, not aligned
};

EvaluatedEstimate EvaluateOne(const CommandLine& line,
                              const ReferenceTrajectory& reference,
                              const std::string& estimate,
                              const std::optional<Evaluation>& other) {
  EvaluatedEstimate one;
  Evaluation& evaluation = one.evaluation;
  evaluation.estimate = estimate;
  evaluation.reference = reference;
  const std::filesystem::path file = EstimateFile(estimate);
  evaluation.options = ErrorOptions(line, reference.format, file);
  if (const auto text = line.Value("--time-offset")) evaluation.offset_ns = ParseOffset(*text);
  if (other) {
    evaluation.aligned_by = other->estimate;
    evaluation.options.alignment = other->options.alignment;
    evaluation.options.known_alignment = other->error.reference_from_estimate;
  }
  one.poses = ReadEstimate(line, file);
  const auto error = CompareTrajectories(reference.poses, one.poses, evaluation.options);
  if (!error) FailNoOverlap(file, reference.poses, one.poses);
  evaluation.error = *error;
  if (other) evaluation.error.degenerate = other->error.degenerate;
  evaluation.unit_is_free =
      IsMonocularRun(file) && !other && evaluation.options.alignment != TrajectoryAlignment::kSim3;
  evaluation.frames_delivered = FramesDelivered(file, reference, one.poses);
  return one;
}

// Figures and trajectories, all made before the first is written.
std::vector<FileContents> FilesToWrite(const EvaluateOutputs& outputs,
                                       const std::string& json,
                                       const std::vector<EvaluatedEstimate>& estimates) {
  std::vector<FileContents> files;
  if (outputs.json) files.push_back({*outputs.json, json});
  std::vector<NamedError> errors;
  for (const EvaluatedEstimate& each : estimates) {
    errors.push_back({each.evaluation.name, &each.evaluation.error});
  }
  if (outputs.plot) {
    const Figure figure =
        errors.size() == 1 ? TrajectoryFigure(*errors.front().error) : TrajectoryFigure(errors);
    files.push_back({*outputs.plot, FigureBytes(*outputs.plot, figure)});
  }
  for (std::size_t i = 0; i < outputs.aligned.size(); ++i) {
    Trajectory aligned = estimates[i].poses;
    for (StampedPose& pose : aligned) {
      pose.world_from_camera = TransformPose(estimates[i].evaluation.error.reference_from_estimate,
                                             pose.world_from_camera);
    }
    files.push_back(AlignedFile(outputs.aligned[i], aligned));
  }
  return files;
}

}  // namespace

int EvaluateCommand(std::span<const std::string> arguments) {
  const CommandLine line(EvaluateSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(EvaluateSyntax());
    return 0;
  }
  const std::vector<std::string> paths = line.PositionalsFrom(1);
  const std::vector<std::string> names = ShortNames(paths);
  const EvaluateOutputs outputs = ReadOutputs(line, names);
  const ReferenceTrajectory reference = LoadReferenceFor(line, line.Positional(0));
  for (const std::string& note : reference.notes) {
    std::clog << "plumbline: " << Printable(note, kLongestMessage) << '\n';
  }
  std::vector<std::filesystem::path> read;
  for (const std::string& path : paths) read.push_back(EstimateFile(path));
  if (const auto other = line.Value("--align-by")) read.push_back(EstimateFile(*other));
  CheckOutputs(outputs, line.Positional(0), FilesRead(line, reference, read));
  const std::optional<Evaluation> other = EvaluateOther(line, reference);
  std::vector<EvaluatedEstimate> estimates;
  std::vector<Evaluation> evaluations;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    estimates.push_back(EvaluateOne(line, reference, paths[i], other));
    estimates.back().evaluation.name = Printable(names[i]);
    evaluations.push_back(estimates.back().evaluation);
  }
  const bool one = paths.size() == 1;
  const std::string json = one ? EvaluationJson(evaluations[0]) : EvaluationsJson(evaluations);
  WriteOutputs(outputs, FilesToWrite(outputs, json, estimates));
  if (outputs.json_to_stdout) {
    std::cout << json;
  } else {
    std::cout << (one ? EvaluationTable(evaluations[0]) : EvaluationsTable(evaluations));
  }
  return 0;
}

}  // namespace plumbline
