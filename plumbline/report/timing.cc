// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/timing.h"

#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

// Returns the stages in the order of first appearance, with "total" last.
std::vector<std::string> StageNames(const FrameLog& frames) {
  std::vector<std::string> names;
  for (const FrameRecord& frame : frames) {
    for (const StageTime& time : frame.times) {
      if (time.stage != "total" &&
          std::find(names.begin(), names.end(), time.stage) == names.end()) {
        names.push_back(time.stage);
      }
    }
  }
  names.emplace_back("total");
  return names;
}

// Returns the nearest-rank percentile of sorted values.
double Percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

std::map<std::string, double> SumByStage(const FrameRecord& frame) {
  std::map<std::string, double> sums;
  for (const StageTime& time : frame.times) sums[time.stage] += time.milliseconds;
  return sums;
}

}  // namespace

std::vector<StageStatistics> TimingStatistics(const FrameLog& frames) {
  std::map<std::string, std::vector<double>> values;
  for (const FrameRecord& frame : frames) {
    for (const auto& [stage, ms] : SumByStage(frame)) values[stage].push_back(ms);
  }
  std::vector<StageStatistics> result;
  for (const std::string& stage : StageNames(frames)) {
    std::vector<double>& v = values[stage];
    if (v.empty()) continue;
    std::sort(v.begin(), v.end());
    const double sum = std::accumulate(v.begin(), v.end(), 0.0);
    result.push_back({stage,
                      v.size(),
                      StatisticsOf(v)->median,
                      Percentile(v, 0.95),
                      Percentile(v, 0.99),
                      v.back(),
                      sum / static_cast<double>(v.size())});
  }
  return result;
}

std::vector<std::optional<double>> StageMilliseconds(const FrameLog& frames,
                                                     const std::vector<std::size_t>& numbers,
                                                     const std::string& stage) {
  std::vector<std::optional<double>> column;
  column.reserve(numbers.size());
  for (const std::size_t number : numbers) {
    std::optional<double> sum;
    for (const StageTime& time : frames[number].times) {
      if (time.stage == stage) sum = sum.value_or(0) + time.milliseconds;
    }
    column.push_back(sum);
  }
  return column;
}

std::string FormatTimingCsv(const FrameLog& frames) {
  const std::vector<std::string> stages = StageNames(frames);
  std::string text = "frame,timestamp";
  for (const std::string& stage : stages) text += "," + stage + "_ms";
  text += '\n';
  for (const FrameRecord& frame : frames) {
    const auto sums = SumByStage(frame);
    text += fmt::format("{},{}", frame.id.value, FormatStamp(frame.stamp_ns));
    for (const std::string& stage : stages) {
      const auto it = sums.find(stage);
      text += it == sums.end() ? std::string(",") : fmt::format(",{:.3f}", it->second);
    }
    text += '\n';
  }
  return text;
}

std::string FormatTimingJson(const FrameLog& frames) {
  nlohmann::ordered_json json;
  for (const StageStatistics& s : TimingStatistics(frames)) {
    json[s.stage] = {{"frames", s.count},
                     {"median_ms", s.median},
                     {"p95_ms", s.p95},
                     {"p99_ms", s.p99},
                     {"max_ms", s.max},
                     {"mean_ms", s.mean}};
  }
  return json.dump(2) + "\n";
}

}  // namespace plumbline
