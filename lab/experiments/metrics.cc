// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/metrics.h"

#include "plumbline/base/input_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Json = nlohmann::json;

// Source of a metric in summary.json: value = factor * number [/ divisor]. Without a number the
// source is elsewhere (line_map_figures.h, consistency_figures.h).
struct Source {
  const char* number = nullptr;
  double factor = 1;
  const char* divisor = nullptr;
};

struct Entry {
  Metric metric;
  Source source;
};

constexpr Better kLower = Better::kLower, kHigher = Better::kHigher, kNeither = Better::kNeither;
constexpr bool kTiming = true;

constexpr std::array kEntries = {
    Entry{{"ate",
           "mm",
           "position error, RMSE after alignment, of the final trajectory",
           kLower,
           false,
           2},
          {"/accuracy/ate/rmse", 1000}},
    Entry{{"ate_causal", "mm", "the same of the poses as first reported", kLower, false, 2},
          {"/accuracy_causal/ate/rmse", 1000}},
    Entry{{"coverage", "%", "poses of the final trajectory of frames delivered", kHigher, false, 1},
          {"/frames/in_trajectory", 100, "/frames/in"}},
    Entry{{"rpe_mean", "m/s", "error of relative positions over 3 s, mean", kLower, false, 5},
          {"/accuracy/rpe/mean"}},
    Entry{{"rpe_rmse", "m/s", "error of relative positions over 3 s, RMSE", kLower, false, 5},
          {"/accuracy/rpe/rmse"}},
    Entry{{"roe_mean", "deg/s", "error of relative orientations over 3 s, mean", kLower, false, 4},
          {"/accuracy/roe/mean"}},
    Entry{{"roe_rmse", "deg/s", "error of relative orientations over 3 s, RMSE", kLower, false, 4},
          {"/accuracy/roe/rmse"}},
    Entry{{"rpe_pairs",
           "mm",
           "error of relative positions over all pairs of frames (of at most 1000), RMSE",
           kLower,
           false,
           2},
          {}},
    Entry{{"start_rpe", "mm", "rpe_pairs, or 1000 where no map was begun", kLower, false, 2}, {}},
    Entry{{"rpe_causal_mean", "m/s", "rpe_mean of the poses as first reported", kLower, false, 5},
          {"/accuracy_causal/rpe/mean"}},
    Entry{{"rpe_causal_rmse", "m/s", "rpe_rmse of the poses as first reported", kLower, false, 5},
          {"/accuracy_causal/rpe/rmse"}},
    Entry{{"roe_causal_mean", "deg/s", "roe_mean of the poses as first reported", kLower, false, 4},
          {"/accuracy_causal/roe/mean"}},
    Entry{{"roe_causal_rmse", "deg/s", "roe_rmse of the poses as first reported", kLower, false, 4},
          {"/accuracy_causal/roe/rmse"}},
    Entry{{"scale_drift",
           "%",
           "scale of the last fifth of the final trajectory against the first, less 1; one camera",
           kNeither,
           false,
           2},
          {"/accuracy/scale_drift", 100}},
    Entry{{"tracked", "frames", "frames with a pose", kHigher}, {"/frames/tracked"}},
    Entry{{"lost", "frames", "frames without a pose after the first map", kLower},
          {"/frames/lost"}},
    Entry{{"skipped", "frames", "frames whose images could not be used"}, {"/frames/skipped"}},
    Entry{{"initializing", "frames", "frames before the first map"}, {"/frames/initializing"}},
    Entry{{"start_frames", "frames", "until a first pose was reported", kLower}, {}},
    Entry{{"maps", "", "maps begun", kLower}, {"/maps"}},
    Entry{{"keyframes", "", "keyframes of the largest map"}, {"/keyframes"}},
    Entry{{"points", "", "points of the largest map"}, {"/points"}},
    Entry{{"lines", "", "lines of the largest map"}, {"/lines"}},
    Entry{{"line_recall",
           "%",
           "length of the true lines that the map has within 5 cm",
           kHigher,
           false,
           1},
          {}},
    Entry{{"line_precision",
           "%",
           "length of the mapped lines within 5 cm of a true one",
           kHigher,
           false,
           1},
          {}},
    Entry{{"line_angle",
           "deg",
           "from the true line, median of the mapped lines within 5 cm of one",
           kLower,
           false,
           2},
          {}},
    Entry{{"line_distance",
           "mm",
           "from the true line, median of the mapped lines within 5 cm of one",
           kLower,
           false,
           1},
          {}},
    Entry{{"line_multiplicity",
           "",
           "how often the mapped stretches of true lines are mapped",
           kLower,
           false,
           2},
          {}},
    Entry{{"map_line_recall",
           "%",
           "length of the true lines that landmarks of the map have within 5 cm",
           kHigher,
           false,
           1},
          {}},
    Entry{{"map_line_precision",
           "%",
           "length of the line landmarks, to their own ends, within 5 cm of a true one",
           kHigher,
           false,
           1},
          {}},
    Entry{{"map_line_angle",
           "deg",
           "from the true line, median of the line landmarks within 5 cm of one",
           kLower,
           false,
           2},
          {}},
    Entry{{"map_line_error",
           "mm",
           "further end of a line landmark from the true line nearest to both ends, median of all",
           kLower,
           false,
           1},
          {}},
    Entry{{"inside_point", "%", "corners within 90 % of their landmark so far", kNeither, false, 1},
          {}},
    Entry{{"inside_disparity", "%", "the same of disparities", kNeither, false, 1}, {}},
    Entry{{"inside_line", "%", "the same of segments of left images", kNeither, false, 1}, {}},
    Entry{{"inside_right_line", "%", "the same of segments of right images", kNeither, false, 1},
          {}},
    Entry{{"inside_segment",
           "%",
           "segments of left images within 90 % of the true line",
           kNeither,
           false,
           1},
          {}},
    Entry{{"inside_right_segment", "%", "the same of right images", kNeither, false, 1}, {}},
    Entry{{"inside_point_landmark",
           "%",
           "triangulated points within 90 % of the nearest surface",
           kNeither,
           false,
           1},
          {}},
    Entry{{"inside_line_landmark",
           "%",
           "triangulated lines within 90 % of the nearest true line",
           kNeither,
           false,
           1},
          {}},
    Entry{{"inside_causal_1s",
           "%",
           "motions over 1 s within 90 % of the true one, as first reported",
           kNeither,
           false,
           1},
          {}},
    Entry{{"inside_causal_5s", "%", "the same over 5 s", kNeither, false, 1}, {}},
    Entry{{"inside_final_1s", "%", "motions over 1 s within 90 %, final", kNeither, false, 1}, {}},
    Entry{{"inside_final_5s", "%", "the same over 5 s", kNeither, false, 1}, {}},
    Entry{{"inside_least",
           "%",
           "least share within 90 % of a class of at least 200 errors",
           kNeither,
           false,
           1},
          {}},
    Entry{{"inside_most",
           "%",
           "largest share within 90 % of a class of at least 200 errors",
           kNeither,
           false,
           1},
          {}},
    Entry{{"map_line_bytes",
           "B",
           "memory of a line of the map: position, information, descriptor, list of observations; "
           "mean",
           kLower},
          {"/line_bytes/map"}},
    Entry{{"adjusted_line_bytes",
           "B",
           "memory of a line in local bundle adjustment: parameters, observations, equations; mean",
           kLower},
          {"/line_bytes/adjustment"}},
    Entry{{"starts", "", "monocular starts that were tried"}, {"/starts/starts"}},
    Entry{{"possible", "", "starts whose true median parallax reaches 2 degrees in time"},
          {"/starts/possible"}},
    Entry{{"success", "%", "of the possible starts: with a right map in time", kHigher, false, 1},
          {"/starts/success"}},
    Entry{{"success_in_the_end",
           "%",
           "of the possible starts: with a right map in time or late",
           kHigher,
           false,
           1},
          {"/starts/success_in_the_end"}},
    Entry{{"late", "", "possible starts with a right map after the time", kLower},
          {"/starts/late"}},
    Entry{{"waiting", "", "possible starts without a map", kLower}, {"/starts/waiting"}},
    Entry{{"wrong", "", "starts with a wrong map", kLower}, {"/starts/wrong"}},
    Entry{{"wrong_rate", "%", "starts with a wrong map, of all", kLower, false, 2},
          {"/starts/wrong_rate"}},
    Entry{{"accepted", "%", "starts with a map, right or wrong, of all", kNeither, false, 1},
          {"/starts/accepted"}},
    Entry{{"map_frames", "", "frames until there is a map, median", kLower},
          {"/starts/map_frames"}},
    Entry{{"map_frames_p95", "", "the same, 95th percentile", kLower}, {"/starts/map_frames_p95"}},
    Entry{{"map_seconds", "s", "of video until there is a map, median", kLower, false, 2},
          {"/starts/map_seconds"}},
    Entry{{"map_seconds_p95", "s", "the same, 95th percentile", kLower, false, 2},
          {"/starts/map_seconds_p95"}},
    Entry{{"map_parallax", "deg", "true median parallax of a map, median", kNeither, false, 2},
          {"/starts/map_parallax"}},
    Entry{{"rotation_error", "deg", "of a map's newest view, median", kLower, false, 3},
          {"/starts/rotation_error"}},
    Entry{{"rotation_error_p95", "deg", "the same, 95th percentile", kLower, false, 3},
          {"/starts/rotation_error_p95"}},
    Entry{{"direction_error", "deg", "of the way to a map's newest view, median", kLower, false, 2},
          {"/starts/direction_error"}},
    Entry{{"direction_error_p95", "deg", "the same, 95th percentile", kLower, false, 2},
          {"/starts/direction_error_p95"}},
    Entry{{"depth_error", "%", "inverse depth of a map's points, median", kLower, false, 2},
          {"/starts/depth_error"}},
    Entry{{"depth_error_p95", "%", "of the medians of maps, 95th percentile", kLower, false, 2},
          {"/starts/depth_error_p95"}},
    Entry{{"depth_outliers", "%", "points off by more than a fifth, median", kLower, false, 1},
          {"/starts/depth_outliers"}},
    Entry{{"map_points", "", "points of a map, median"}, {"/starts/map_points"}},
    Entry{{"map_lines", "", "lines of a map, median"}, {"/starts/map_lines"}},
    Entry{{"add_ms", "ms", "an initializer takes a frame, median", kLower, kTiming, 2},
          {"/add/median_ms"}},
    Entry{{"add_p95_ms", "ms", "the same, 95th percentile", kLower, kTiming, 2}, {"/add/p95_ms"}},
    Entry{{"add_max_ms", "ms", "the same, most", kLower, kTiming, 2}, {"/add/max_ms"}},
    Entry{{"fps",
           "1/s",
           "frames a second over the whole run, reading and writing included",
           kHigher,
           kTiming,
           1},
          {"/frames/in", 1, "/wall_seconds"}},
    Entry{{"frame_ms", "ms", "from a frame's arrival to its pose, median", kLower, kTiming, 1},
          {"/timing/total/median_ms"}},
    Entry{{"frame_p95_ms",
           "ms",
           "from a frame's arrival to its pose, 95th percentile",
           kLower,
           kTiming,
           1},
          {"/timing/total/p95_ms"}},
    Entry{{"track_ms",
           "ms",
           "from a frame's features to its pose, search of matches included, median",
           kLower,
           kTiming,
           2},
          {"/timing/track/median_ms"}},
    Entry{{"adjust_ms",
           "ms",
           "local bundle adjustment of a keyframe, its window included, median",
           kLower,
           kTiming,
           1},
          {"/timing/map_adjust/median_ms"}},
    Entry{{"adjust_p95_ms", "ms", "the same, 95th percentile", kLower, kTiming, 1},
          {"/timing/map_adjust/p95_ms"}},
    Entry{{"cpu_ms",
           "ms",
           "processor time a frame, decoding and mapping included",
           kLower,
           kTiming,
           1},
          {"/cpu_seconds", 1000, "/frames/in"}},
    Entry{{"first_pose_s",
           "s",
           "from the start of the program to the first pose",
           kLower,
           kTiming,
           2},
          {"/first_pose_seconds"}},
    Entry{{"wall_s", "s", "the whole run", kLower, kTiming, 1}, {"/wall_seconds"}},
    Entry{{"memory_mb", "MB", "peak memory", kLower, kTiming}, {"/peak_memory_mb"}},
    Entry{{"dropped", "frames", "frames that a live run had no time for", kLower, kTiming},
          {"/frames/dropped"}},
};

constexpr auto kMetrics = [] {
  std::array<Metric, kEntries.size()> metrics;
  for (std::size_t i = 0; i < metrics.size(); ++i) metrics[i] = kEntries[i].metric;
  return metrics;
}();

std::optional<double> NumberAt(const Json& summary, const char* where) {
  const Json::json_pointer pointer(where);
  if (!summary.contains(pointer) || !summary[pointer].is_number()) return std::nullopt;
  return summary[pointer].get<double>();
}

std::optional<double> Evaluate(const Json& summary, const Source& source) {
  const auto number = source.number == nullptr ? std::nullopt : NumberAt(summary, source.number);
  if (!number || source.divisor == nullptr) {
    return number ? std::optional(source.factor * *number) : std::nullopt;
  }
  const auto divisor = NumberAt(summary, source.divisor);
  if (!divisor || *divisor <= 0) return std::nullopt;
  return source.factor * *number / *divisor;
}

std::string WhyMissing(const Json& summary, const char* pointer) {
  const std::string_view number = pointer == nullptr ? "" : pointer;
  if (number.starts_with("/starts")) return "no such start, or the truth is not known";
  if (NumberAt(summary, "/frames/tracked").value_or(0) == 0) return "no frame has a pose";
  if (number.empty()) return "the true lines are not known";
  if (number.starts_with("/line_bytes")) return "there is no line";
  if (!number.starts_with("/accuracy")) return "not measured";
  const std::string part(number.substr(1, number.find('/', 1) - 1));
  if (!summary.contains(part) || summary[part].is_null()) return "no ground truth of any pose";
  if (number.ends_with("/scale_drift")) return "not one camera, or it does not get far";
  return "no two poses are 3 s apart";
}

// A whole number, not negative.
std::optional<double> CountAt(const Json& summary, const char* where) {
  const auto number = NumberAt(summary, where);
  return number && *number >= 0 && *number == std::floor(*number) ? number : std::nullopt;
}

bool IsSummaryOfRun(const Json& summary) {
  const auto all = CountAt(summary, "/frames/in");
  const auto tracked = CountAt(summary, "/frames/tracked");
  const auto lost = CountAt(summary, "/frames/lost");
  const auto wall = NumberAt(summary, "/wall_seconds");
  return all && *all > 0 && tracked && lost && *tracked + *lost <= *all && wall && *wall >= 0 &&
         CountAt(summary, "/keyframes").has_value();
}

bool IsSummaryOfStarts(const Json& summary) {
  const auto wall = NumberAt(summary, "/wall_seconds");
  return CountAt(summary, "/starts/starts").has_value() && wall && *wall >= 0;
}

}  // namespace

std::span<const Metric> Metrics() { return kMetrics; }

const Metric* FindMetric(std::string_view name) {
  const auto found = std::find_if(
      kMetrics.begin(), kMetrics.end(), [name](const Metric& m) { return m.name == name; });
  return found == kMetrics.end() ? nullptr : &*found;
}

std::optional<RunFigures> ReadFigures(const std::filesystem::path& folder) {
  const auto text = ReadFileIfThere(folder / "summary.json");
  if (!text) return std::nullopt;
  Json summary = Json::parse(*text, nullptr, false);
  if (!summary.is_object() || !(IsSummaryOfRun(summary) || IsSummaryOfStarts(summary))) {
    return std::nullopt;
  }
  const auto interrupted = summary.find("interrupted");
  if (interrupted != summary.end() && !interrupted->is_null()) return std::nullopt;
  const auto rows = ReadFileIfThere(folder / "trajectory.txt");
  // Earlier versions of the program, which experiments compare with, wrote the poses of the
  // trajectory but did not count them in summary.json.
  if (rows && !NumberAt(summary, "/frames/in_trajectory")) {
    summary["frames"]["in_trajectory"] = std::count(rows->begin(), rows->end(), '\n');
  }
  RunFigures figures;
  for (const Entry& entry : kEntries) {
    const std::string name(entry.metric.name);
    if (const auto value = Evaluate(summary, entry.source)) {
      figures.values[name] = *value;
    } else {
      figures.reasons[name] = WhyMissing(summary, entry.source.number);
    }
  }
  figures.trajectory = rows.value_or("") + ReadFileIfThere(folder / "starts.csv").value_or("");
  return figures;
}

}  // namespace plumbline
