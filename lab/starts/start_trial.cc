// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_trial.h"

#include "plumbline/base/options.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

namespace plumbline {
namespace {

using Clock = std::chrono::steady_clock;

std::optional<Rigid3> TrueMotion(const StartTruth& truth, int from, int to) {
  const auto world_from_a = truth.WorldFromCamera(from), world_from_b = truth.WorldFromCamera(to);
  if (!world_from_a || !world_from_b) return std::nullopt;
  return Inverse(*world_from_b) * *world_from_a;
}

std::optional<double> GreatestParallaxDeg(const StartRange& range,
                                          const StartTruth& truth,
                                          const TrueDepth* depth,
                                          const RectifiedCamera& camera) {
  if (depth == nullptr) return std::nullopt;
  const auto points = depth->Samples();
  std::optional<double> greatest;
  for (int frame = range.begin + 1; frame < range.in_time; ++frame) {
    const auto motion = TrueMotion(truth, range.begin, frame);
    if (!motion) continue;
    greatest = std::max(greatest.value_or(0), MedianParallaxDeg(points, *motion, camera));
  }
  return greatest;
}

int IndexOf(const InitialView& view) { return static_cast<int>(view.frame.id.value); }

// Description of the map, without frames and seconds.
StartMap DescribeMap(const InitializationResult& result,
                     const StartTruth& truth,
                     const RectifiedCamera& camera) {
  const InitialMap& initial = *result.map;
  StartMap map;
  map.reference = IndexOf(initial.views.front());
  map.newest = IndexOf(initial.views.back());
  map.estimated_parallax_deg = result.parallax_deg;
  map.points = static_cast<int>(initial.points.size());
  map.lines = static_cast<int>(initial.lines.size());
  const auto motion = TrueMotion(truth, map.reference, map.newest);
  const auto depth = truth.DepthAt(map.reference);
  if (motion && depth) map.parallax_deg = MedianParallaxDeg(depth->Samples(), *motion, camera);
  map.errors = CompareInitialMap(initial, motion, depth.get(), camera);
  return map;
}

void Judge(const StartLimits& limits, bool in_time, StartRecord& record) {
  record.reason = ExceededLimits(*record.map, limits);
  if (!record.reason.empty()) {
    record.outcome = StartOutcome::kWrong;
  } else if (record.map->errors.rotation_deg) {
    record.outcome = in_time ? StartOutcome::kRight : StartOutcome::kLate;
  } else {
    record.outcome = StartOutcome::kUnjudged;
  }
}

}  // namespace

StartRecord TryStart(const StartRange& range,
                     const StartTask& task,
                     Initializer& initializer,
                     std::vector<double>& milliseconds) {
  StartRecord record;
  record.frame = range.begin;
  record.greatest_parallax_deg =
      GreatestParallaxDeg(range, task.truth, task.truth.DepthAt(range.begin).get(), task.camera);
  std::optional<std::int64_t> first_stamp_ns;
  for (int index = range.begin; index < range.end; ++index) {
    const auto frame = task.frames(index);
    if (!frame) continue;
    if (!first_stamp_ns) first_stamp_ns = frame->stamp_ns;
    const auto start = Clock::now();
    const InitializationResult result = initializer.Add(*frame);
    milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    ++record.offered;
    record.reason = NameOf(result.wait);
    if (!result.map) continue;
    record.map = DescribeMap(result, task.truth, task.camera);
    record.map->frames = record.offered;
    record.map->seconds = 1e-9 * static_cast<double>(frame->stamp_ns - *first_stamp_ns);
    Judge(task.limits, index < range.in_time, record);
    if (task.on_map) task.on_map(record, *result.map);
    break;
  }
  return record;
}

}  // namespace plumbline
