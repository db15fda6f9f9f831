// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/summary.h"

#include "plumbline/base/options.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/timing.h"

#include <ctime>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json Statistics(const ErrorStatistics& s, double factor, const char* unit) {
  return {{"rmse", s.rmse * factor},
          {"mean", s.mean * factor},
          {"median", s.median * factor},
          {"max", s.max * factor},
          {"count", s.count},
          {"unit", unit}};
}

Json Accuracy(const TrajectoryError& error, SensorKind sensor, int frames) {
  Json json;
  json["alignment"] = sensor == SensorKind::kMono ? "sim3" : "se3";
  if (sensor == SensorKind::kMono) {
    json["scale"] = error.reference_from_estimate.scale;
    json["scale_drift"] = OrNull(error.scale_drift);
  }
  json["association"] = "interpolate";
  json["associated"] = error.poses.size();
  json["coverage"] = frames > 0 ? static_cast<double>(error.estimated) / frames : 0.0;
  json["degenerate"] = error.degenerate ? Json(NameOf(*error.degenerate)) : Json(nullptr);
  json["ate"] = Statistics(error.ate, 1, "m");
  json["relative_window"] = "3s";
  if (error.rpe) json["rpe"] = Statistics(*error.rpe, 1, "m/s");
  if (error.roe) json["roe"] = Statistics(*error.roe, 180 / std::numbers::pi, "deg/s");
  return json;
}

std::optional<TrajectoryError> Compare(const Trajectory& estimate, const Dataset& dataset) {
  constexpr std::size_t kFewestPoses = 3;  // any two trajectories can be laid on each other
  if (!dataset.info().ground_truth) return std::nullopt;
  auto error = CompareTrajectories(dataset.info().ground_truth->OfCamera(dataset.calibration()),
                                   estimate,
                                   ErrorOptionsFor(dataset.sensor(), dataset.info().format));
  if (error && error->poses.size() < kFewestPoses) return std::nullopt;
  return error;
}

Json Timing(const FrameLog& frames) {
  Json json;
  for (const StageStatistics& s : TimingStatistics(frames)) {
    json[s.stage] = {{"median_ms", s.median}, {"p95_ms", s.p95}, {"p99_ms", s.p99}};
  }
  return json;
}

// Returns the peak memory of this program. ru_maxrss also counts memory from before exec, which is
// that of the program that started it.
double PeakMemoryMb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kilobytes) break;
  }
  return kilobytes / 1024;
}

}  // namespace

ResourceUse MeasureResources() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  ResourceUse use;
  use.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  use.peak_memory_mb = PeakMemoryMb();
  return use;
}

std::optional<double> SecondsSinceProcessStart() {
  std::ifstream stat("/proc/self/stat");
  std::string text;
  if (!std::getline(stat, text)) return std::nullopt;
  // The name, field 2, is in brackets and may contain spaces. The start, in ticks since boot, is
  // field 22.
  const auto bracket = text.rfind(')');
  if (bracket == std::string::npos) return std::nullopt;
  std::istringstream rest(text.substr(bracket + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) rest >> field;
  timespec now{};
  double start_ticks = 0;
  if (!(std::istringstream(field) >> start_ticks) || clock_gettime(CLOCK_BOOTTIME, &now) != 0) {
    return std::nullopt;
  }
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         start_ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

RunCounts CountRun(const RunResult& result) {
  RunCounts counts;
  const auto main = result.MainMap();
  for (const FrameRecord& frame : result.frames) {
    ++counts.frames;
    counts.tracked += frame.status == FrameStatus::kTracked;
    counts.in_trajectory +=
        frame.status == FrameStatus::kTracked && result.atlas.Current(frame.map) == main;
    counts.lost += frame.status == FrameStatus::kLost;
    counts.skipped += frame.status == FrameStatus::kSkipped;
    counts.dropped += frame.shed == LoadLevel::kFrame;
    counts.shed_mapping += frame.shed == LoadLevel::kMapping;
    counts.shed_lines += frame.shed == LoadLevel::kLines;
    counts.shed_points += frame.shed == LoadLevel::kPoints;
    counts.demoted += frame.demoted;
    counts.initializing += frame.status == FrameStatus::kInitializing;
  }
  counts.maps = static_cast<int>(result.atlas.maps().size());
  if (main) {
    const Map& map = result.atlas.maps().at(*main);
    counts.keyframes = static_cast<int>(map.keyframes().size());
    counts.points = static_cast<int>(map.points().size());
    counts.lines = static_cast<int>(map.lines().size());
  }
  return counts;
}

LineMemory MeasureLineMemory(const RunResult& result) {
  const auto mean = [](std::size_t bytes, std::size_t count) -> std::optional<double> {
    if (count == 0) return std::nullopt;
    return static_cast<double>(bytes) / static_cast<double>(count);
  };
  LineMemory memory;
  const AdjustedLines& adjusted = result.adjusted_lines;
  memory.adjustment = mean(adjusted.bytes, adjusted.count);
  const auto main = result.MainMap();
  if (!main) return memory;
  const auto& lines = result.atlas.maps().at(*main).lines();
  std::size_t bytes = 0;
  for (const auto& [id, line] : lines) {
    bytes += sizeof(line) + line.observations.size() * sizeof(Observations::value_type);
  }
  memory.map = mean(bytes, lines.size());
  return memory;
}

std::string WhyNoErrors(const DatasetInfo& info) {
  if (info.ground_truth_fault) return *info.ground_truth_fault;
  return info.ground_truth ? "the ground truth covers fewer than three poses"
                           : "no ground truth to compare with";
}

std::optional<TrajectoryError> CompareWithGroundTruth(const RunResult& result,
                                                      const Dataset& dataset,
                                                      MapId map) {
  return Compare(result.FinalTrajectory(map), dataset);
}

std::optional<TrajectoryError> CompareWithGroundTruth(const RunResult& result,
                                                      const Dataset& dataset) {
  const auto main = result.MainMap();
  return main ? CompareWithGroundTruth(result, dataset, *main) : std::nullopt;
}

namespace {

Json Described(const Recognition& place) {
  return {{"frame", place.frame.value},
          {"keyframe", place.keyframe.value},
          {"older_keyframe", place.older.value},
          {"points", place.points},
          {"lines", place.lines},
          {"log10_chance", place.log10_chance},
          {"moved", place.moved},
          {"turned_deg", place.turned_deg},
          {"scale", place.scale}};
}

// Adds lists of the loops, joins and relocalizations.
void AddEvents(const MapEvents& events, Json& json) {
  json["loops"] = Json::array();
  for (const Recognition& loop : events.loops) json["loops"].push_back(Described(loop));
  json["joins"] = Json::array();
  for (const MapJoin& join : events.joins) {
    Json described = Described(join.place);
    described["kept_map"] = join.kept.value;
    described["gone_map"] = join.gone.value;
    json["joins"].push_back(std::move(described));
  }
  json["relocalizations"] = Json::array();
  for (const Relocalization& found : events.relocalizations) {
    json["relocalizations"].push_back({{"frame", found.frame.value},
                                       {"keyframe", found.keyframe.value},
                                       {"points", found.points},
                                       {"lines", found.lines}});
  }
}

// Adds the number of runs of each stage: the frames or keyframes with a time for it, and the steps
// of initializations and of line cutting.
void AddStages(const RunResult& result, Json& json) {
  std::map<std::string, std::int64_t> stages;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    for (const StageTime& time : result.frames[i].times) ++stages[time.stage];
  }
  stages.insert(result.step_counts.begin(), result.step_counts.end());
  json["stages"] = stages;
}

Json Described(const InertialResult& inertial) {
  const double degrees = 180 / std::numbers::pi;
  const auto list = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  const GyroscopeErrors &errors = inertial.errors, &sigmas = inertial.sigmas;
  return {{"turns", inertial.turns},
          {"contradicted", inertial.contradicted},
          {"gyroscope_bias", list(errors.head<3>())},
          {"gyroscope_bias_sigma", list(sigmas.head<3>())},
          {"rotation_correction_deg", list(degrees * errors.segment<3>(3))},
          {"rotation_correction_sigma_deg", list(degrees * sigmas.segment<3>(3))},
          {"time_offset_correction", errors[6]},
          {"time_offset_correction_sigma", sigmas[6]}};
}

}  // namespace

std::optional<std::string> DescribeGyroscope(const RunResult& result) {
  if (!result.inertial || result.inertial->turns == 0) return std::nullopt;
  const double degrees = 180 / std::numbers::pi, milliseconds = 1e3;
  const GyroscopeErrors &errors = result.inertial->errors, &sigmas = result.inertial->sigmas;
  const auto deviation = [&](int first) { return sigmas.segment<3>(first).maxCoeff(); };
  return fmt::format(
      "gyroscope: {} of {} turns used; found beyond its calibration: bias {:.2f} +-{:.2f} deg/s, "
      "rotation {:.2f} +-{:.2f} deg, clock {:.1f} +-{:.1f} ms",
      result.inertial->turns - result.inertial->contradicted,
      result.inertial->turns,
      degrees * errors.head<3>().norm(),
      degrees * deviation(0),
      degrees * errors.segment<3>(3).norm(),
      degrees * deviation(3),
      milliseconds * errors[6],
      milliseconds * sigmas[6]);
}

std::vector<std::string> NotesOf(const RunDescription& description, const Dataset& dataset) {
  std::vector<std::string> notes = dataset.info().notes;
  notes.insert(notes.end(), description.notes.begin(), description.notes.end());
  return notes;
}

std::string FormatSummary(const RunDescription& description,
                          const RunResult& result,
                          const Dataset& dataset,
                          const ResourceUse& resources) {
  const RunCounts counts = CountRun(result);
  Json json;
  json["version"] = description.version;
  json["data"] = description.data_path;
  json["sensor"] = NameOf(dataset.sensor());
  json["mode"] = NameOf(result.options.slam.mode);
  json["seed"] = description.seed;
  json["interrupted"] = description.interrupted ? Json(*description.interrupted) : Json(nullptr);
  json["notes"] = NotesOf(description, dataset);
  json["frames"] = {{"of", description.frames_chosen},
                    {"in", counts.frames},
                    {"tracked", counts.tracked},
                    {"in_trajectory", counts.in_trajectory},
                    {"lost", counts.lost},
                    {"skipped", counts.skipped},
                    {"dropped", counts.dropped},
                    {"relocalized", result.events.relocalizations.size()},
                    {"initializing", counts.initializing}};
  json["shed"] = {{"mapping", counts.shed_mapping},
                  {"lines", counts.shed_lines},
                  {"points", counts.shed_points},
                  {"frames", counts.dropped},
                  {"keyframes", counts.demoted}};
  json["maps"] = counts.maps;
  json["keyframes"] = counts.keyframes;
  json["points"] = counts.points;
  json["lines"] = counts.lines;
  AddEvents(result.events, json);
  json["inertial"] = result.inertial ? Described(*result.inertial) : Json(nullptr);
  const auto error = CompareWithGroundTruth(result, dataset);
  json["accuracy"] = error ? Accuracy(*error, dataset.sensor(), counts.frames) : Json(nullptr);
  json["no_errors"] = error ? Json(nullptr) : Json(WhyNoErrors(dataset.info()));
  const auto main = result.MainMap();
  const auto causal = main ? Compare(result.CausalTrajectory(*main), dataset) : std::nullopt;
  json["accuracy_causal"] =
      causal ? Accuracy(*causal, dataset.sensor(), counts.frames) : Json(nullptr);
  json["timing"] = Timing(result.frames);
  AddStages(result, json);
  json["first_pose_seconds"] = OrNull(resources.first_pose_seconds);
  json["wall_seconds"] = resources.wall_seconds;
  json["cpu_seconds"] = resources.cpu_seconds;
  json["peak_memory_mb"] = resources.peak_memory_mb;
  const LineMemory memory = MeasureLineMemory(result);
  json["line_bytes"] = {{"map", OrNull(memory.map)}, {"adjustment", OrNull(memory.adjustment)}};
  json["preset"] = description.preset ? Json(*description.preset) : Json(nullptr);
  json["options"] = description.options_yaml;
  // A path need not be UTF-8; bytes that are not become a replacement character.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumbline
