// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/eval/line_map_figure.h"
#include "plumbline/eval/trajectory_figure.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/path_overlap.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/run_folder.h"
#include "plumbline/report/run_manifest.h"

#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/commands.h"
#include "apps/evaluate_report.h"
#include "apps/figure_file.h"
#include "apps/line_map_input.h"
#include "apps/reference_trajectory.h"
#include <array>
#include <cmath>
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

CommandSyntax EvaluateSyntax() {
  return {
      "evaluate",
      "Compares an estimated trajectory, or the folder of a run, with ground truth: a trajectory "
      "in "
      "TUM\nform, EuRoC csv or KITTI poses, or the folder of a data set that has it. Where that "
      "folder has\nlines.csv and the run lines.obj, the maps of lines are compared, too.",
      {"REFERENCE", "ESTIMATE"},
      {{"--align",
        "none|se3|sim3",
        "what is aligned before positions are compared (se3; sim3 for the run of a single camera)"},
       {"--delta", "3s|1f", "window of RPE and ROE, seconds or frames (3s)"},
       {"--associate", "interpolate|nearest", "how poses of the reference are found (interpolate)"},
       {"--reference-frame",
        "camera|body",
        "what the reference is about (body for EuRoC, else camera)"},
       {"--mirror-y", "", "mirror the reference in y (original ICL-NUIM ground truth)"},
       {"--json", "FILE", "write the figures as JSON"},
       {"--plot", "FILE", "draw path and errors, .svg or .png"},
       {"--true-lines", "FILE", "lines of the true world (lines.csv of REFERENCE)"},
       {"--lines", "FILE", "estimated lines, .obj or .plb (lines.obj of ESTIMATE)"},
       {"--surfaces", "FILE", "surfaces of the true world (surfaces.csv of REFERENCE)"},
       {"--align-lines",
        "trajectory|poses",
        "lines move as the trajectory, or are then turned to fit poses (poses; with --align none: "
        "trajectory)"},
       {"--plot-lines", "FILE", "draw true and estimated lines, .svg or .png"}}};
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

[[noreturn]] void FailNoOverlap(const Trajectory& reference, const Trajectory& estimate) {
  const auto span = [](const Trajectory& trajectory) {
    return FormatStamp(trajectory.front().stamp_ns) + " to " +
           FormatStamp(trajectory.back().stamp_ns);
  };
  throw InputError(
      "no pose of the estimate has a reference pose at its time: the reference covers " +
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

// How many frames the estimate had; nullopt: unknown, as where there are more poses than frames,
// which are of something else then.
std::optional<std::size_t> FramesDelivered(const std::filesystem::path& estimate_file,
                                           const ReferenceTrajectory& reference,
                                           const Trajectory& estimate) {
  std::optional<std::size_t> frames = FramesOfRun(estimate_file);
  if (!frames) frames = reference.frames;
  return frames && *frames >= estimate.size() ? frames : std::nullopt;
}

LineMapFiles FilesOfLines(const CommandLine& line) {
  LineMapFiles files;
  files.reference = line.Positional(0);
  files.estimate = line.Positional(1);
  if (const auto path = line.Value("--true-lines")) files.true_lines = *path;
  if (const auto path = line.Value("--lines")) files.lines = *path;
  if (const auto path = line.Value("--surfaces")) files.surfaces = *path;
  return files;
}

// Compares the lines, where there are some, in the world of the reference; draws them.
void EvaluateLines(const CommandLine& line, Evaluation& evaluation) {
  std::optional<LineMapInput> input = LoadLineMaps(FilesOfLines(line));
  const auto plot = line.Value("--plot-lines");
  if (const auto text = line.Value("--align-lines")) {
    evaluation.line_alignment = ParseChoice<LineAlignment>("--align-lines", *text);
  } else if (evaluation.options.alignment == TrajectoryAlignment::kNone) {
    evaluation.line_alignment = LineAlignment::kTrajectory;  // nothing is to be moved
  }
  if (!input) {
    if (!plot) return;
    throw InputError(
        "--plot-lines: expected lines.csv in REFERENCE and lines.obj in ESTIMATE, or "
        "--true-lines and --lines");
  }
  if (line.Has("--mirror-y")) MirrorWorldY(*input);
  Similarity3 reference_from_estimate = evaluation.error.reference_from_estimate;
  if (evaluation.line_alignment == LineAlignment::kPoses) {
    reference_from_estimate = AlignPoses(evaluation.error.poses) * reference_from_estimate;
  }
  evaluation.line_options.viewers = LoadLineViewers(FilesOfLines(line), evaluation.error.poses);
  input->estimate = Transformed(reference_from_estimate, std::move(input->estimate));
  evaluation.lines =
      CompareLineMaps(input->truth, input->estimate, input->surfaces, evaluation.line_options);
  if (plot) {
    WriteFigure(
        *plot,
        LineMapFigure(input->truth, input->estimate, *evaluation.lines, evaluation.error.poses));
  }
}

// The folder of the run that an estimate is of; nullopt: it is of none.
std::optional<std::filesystem::path> FolderOfRun(const std::filesystem::path& estimate) {
  std::error_code error;
  if (std::filesystem::is_directory(estimate, error)) return estimate;
  const std::filesystem::path folder = std::filesystem::absolute(estimate, error).parent_path();
  if (!std::filesystem::exists(folder / RunManifest::kFile, error)) return std::nullopt;
  return folder;
}

// What an output may take the place of.
FileKind KindOfOutput(std::string_view option, const std::filesystem::path& file) {
  if (option == "--json") return {"JSON of evaluate", "{\n  \"alignment\": "};
  if (file.extension() == ".png") return {"a PNG file", "\x89PNG\r\n\x1a\n"};
  return {"a drawing by plumbline", "<svg "};
}

// Figures and pictures must not take the place of what they are about, nor of a data set's files or
// of those of the run, nor of files of another kind.
void CheckOutputs(const CommandLine& line, const std::vector<std::filesystem::path>& read) {
  constexpr std::array kOptions = {"--json", "--plot", "--plot-lines"};
  std::error_code error;
  const auto run = FolderOfRun(line.Positional(1));
  const std::filesystem::path reference = line.Positional(0);
  const bool of_data_set = std::filesystem::is_directory(reference, error);
  std::vector<std::pair<std::string_view, std::filesystem::path>> outputs;
  for (const char* option : kOptions) {
    const auto path = line.Value(option);
    if (!path) continue;
    if (std::string_view(option) != "--json") CheckFigureName(*path);
    if (of_data_set && std::filesystem::exists(*path, error) && IsWithin(*path, reference)) {
      throw InputError(std::string(option) + " " + *path + ": expected a file outside of " +
                       reference.string() + ", or a new one");
    }
    for (const std::filesystem::path& input : read) {
      if (!std::filesystem::equivalent(*path, input, error)) continue;
      throw InputError(std::string(option) + " " + *path +
                       ": expected a file to write, found one that is compared");
    }
    if (run) CheckNoResult(option, *path, *run);
    CheckReplacesItsKind(option, *path, KindOfOutput(option, *path));
    outputs.emplace_back(option, *path);
  }
  CheckApartFromEachOther(outputs);
}

// What the command reads, as far as it is there.
std::vector<std::filesystem::path> FilesRead(const CommandLine& line,
                                             const ReferenceTrajectory& reference,
                                             const std::filesystem::path& estimate) {
  std::vector<std::filesystem::path> files = {reference.path, estimate};
  for (const std::filesystem::path& folder :
       {std::filesystem::path(line.Positional(0)), estimate.parent_path()}) {
    for (const char* name : {"lines.csv",
                             "surfaces.csv",
                             "lines.obj",
                             "keyframes.txt",
                             "frames.csv",
                             "summary.json",
                             "rgb.txt",
                             "times.txt"}) {
      files.push_back(folder / name);
    }
  }
  for (const char* option : {"--true-lines", "--lines", "--surfaces"}) {
    if (const auto path = line.Value(option)) files.emplace_back(*path);
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
  std::optional<ReferenceFrame> frame;
  if (const auto text = line.Value("--reference-frame")) {
    frame = ParseChoice<ReferenceFrame>("--reference-frame", *text);
  }
  Evaluation evaluation;
  evaluation.reference = LoadReference(line.Positional(0), frame);
  if (line.Has("--mirror-y")) evaluation.reference.poses = MirroredY(evaluation.reference.poses);
  const std::filesystem::path estimate_file = EstimateFile(line.Positional(1));
  CheckOutputs(line, FilesRead(line, evaluation.reference, estimate_file));
  const Trajectory estimate = ReadTrajectory(estimate_file).poses;
  evaluation.options = ErrorOptions(line, evaluation.reference.format, estimate_file);
  const auto error = CompareTrajectories(evaluation.reference.poses, estimate, evaluation.options);
  if (!error) FailNoOverlap(evaluation.reference.poses, estimate);
  evaluation.error = *error;
  evaluation.frames_delivered = FramesDelivered(estimate_file, evaluation.reference, estimate);
  EvaluateLines(line, evaluation);

  if (const auto path = line.Value("--json"))
    WriteFileAtomically(*path, EvaluationJson(evaluation));
  if (const auto path = line.Value("--plot")) WriteFigure(*path, TrajectoryFigure(*error));
  std::cout << EvaluationTable(evaluation);
  return 0;
}

}  // namespace plumbline
