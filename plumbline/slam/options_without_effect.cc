// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/options_without_effect.h"

#include "plumbline/base/options_io.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

using OptionKeys = std::vector<std::string_view>;

// Options, each by its key or by a beginning that ends in a dot, that have an effect only while
// another option has certain values.
struct Dependence {
  OptionKeys keys;
  const char* other;
  bool (*has_effect)(const SlamOptions&);
};

bool StartsBy(const SlamOptions& o, std::initializer_list<std::string_view> methods) {
  return std::find(methods.begin(), methods.end(), o.initialization.method) != methods.end();
}

bool Cuts(const SlamOptions& o) { return o.cutting.method != "none"; }

std::vector<Dependence> OfFeatures() {
  const OptionKeys of_lines = {"features.line_detector",
                               "features.line.",
                               "features.stereo_lines.",
                               "lines.",
                               "cutting.method",
                               "cutting.information",
                               "cutting.ends",
                               "cutting.end_sigma",
                               "mapping.window.parallel_lines",
                               "mapping.line_map."};
  const OptionKeys of_points = {"features.orb.fast_min_threshold",
                                "features.orb.calibration_sigma",
                                "features.stereo_points."};
  const auto lines = [](const SlamOptions& o) { return o.features.lines; };
  const auto points = [](const SlamOptions& o) { return o.features.points; };
  return {
      {{"features.line_count"}, "features.lines", lines},
      {of_lines, "features.lines", lines},
      {of_lines, "features.line_count", [](const auto& o) { return o.features.line_count > 0; }},
      {{"features.point_count"}, "features.points", points},
      {of_points, "features.points", points},
      {of_points, "features.point_count", [](const auto& o) { return o.features.point_count > 0; }},
      {{"lines.constant_sigma_px"}, "lines.weighting", [](const auto& o) {
         return o.lines.weighting == LineWeighting::kNone;
       }}};
}

std::vector<Dependence> OfCutting() {
  return {{{"cutting.information", "cutting.ends", "cutting.end_sigma"}, "cutting.method", Cuts},
          {{"cutting.end_sigma"}, "cutting.ends", [](const auto& o) {
             return o.cutting.ends == CuttingEnds::kInverseDepth;
           }}};
}

std::vector<Dependence> OfInitialization() {
  const auto by_method = [](OptionKeys keys, bool (*has_effect)(const SlamOptions&)) {
    return Dependence{std::move(keys), "initialization.method", has_effect};
  };
  return {
      by_method({"initialization.pairwise."},
                [](const auto& o) { return StartsBy(o, {"rank1_pairwise"}); }),
      by_method(
          {"initialization.relative_pose", "initialization.interpolate", "initialization.matching"},
          [](const auto& o) { return StartsBy(o, {"rank1"}); }),
      by_method({"initialization.factorize",
                 "initialization.reweighting",
                 "initialization.min_line_angle_deg"},
                [](const auto& o) {
                  return StartsBy(o, {"rank1", "rank1_pairwise"});
                }),
      {{"initialization.interpolate",
        "initialization.reweighting",
        "initialization.min_line_angle_deg",
        "initialization.pairwise.missing"},
       "initialization.factorize",
       [](const auto& o) { return o.initialization.factorize; }},
      {{"initialization.min_line_angle_deg"},
       "initialization.interpolate",
       [](const auto& o) {
         return StartsBy(o, {"rank1_pairwise"}) || o.initialization.interpolate;
       }},
      {{"initialization.min_line_angle_deg"}, "initialization.pairwise.missing", [](const auto& o) {
         return StartsBy(o, {"rank1"}) ||
                o.initialization.pairwise.missing == MissingPlaces::kInterpolate;
       }}};
}

std::vector<Dependence> OfRunning() {
  return {// Odometry has no keyframe but the first.
          {{"lines.reconstruction",
            "tracking.keyframes.",
            "mapping.window.",
            "mapping.ba.",
            "mapping.cleanup.",
            "mapping.final_adjustment_keyframes"},
           "tracking.reference",
           [](const auto& o) { return o.tracking.reference != TrackingReference::kLastFrame; }},
          {{"relocalization.patience"},
           "relocalization.enabled",
           [](const auto& o) { return o.relocalization.enabled; }},
          {{"slam.lag"}, "slam.mode", [](const auto& o) { return o.slam.mode != RunMode::kLive; }}};
}

// Returns all dependences. The first of an option that is not met is the one that users are told.
std::vector<Dependence> AllDependences() {
  std::vector<Dependence> all;
  for (auto* part : {OfFeatures, OfCutting, OfInitialization, OfRunning}) {
    for (Dependence& dependence : part()) all.push_back(std::move(dependence));
  }
  return all;
}

// Options that have an effect with some sensors only.
struct SensorDependence {
  OptionKeys keys;
  std::vector<std::string_view> sensors;
};
const std::vector<SensorDependence> kSensorDependences = {
    {{"initialization.", "mapping.lens_calibration"}, {"mono"}},
    {{"features.stereo_points.", "features.stereo_lines."}, {"stereo"}},
    {{"features.depth."}, {"rgbd"}},
    {{"mapping.stereo_calibration"}, {"stereo", "rgbd"}}};

bool HoldsOption(const OptionKeys& keys, std::string_view key) {
  return std::any_of(keys.begin(), keys.end(), [key](std::string_view of_table) {
    return of_table.ends_with('.') ? key.starts_with(of_table) : key == of_table;
  });
}

// Returns the option, with its value, or the sensor that leaves an option without effect.
std::optional<std::string> WhatForbids(const std::string& key,
                                       const SlamOptions& options,
                                       const OptionTable& table,
                                       std::optional<std::string_view> sensor,
                                       bool has_map) {
  for (const auto& [keys, sensors] : kSensorDependences) {
    if (sensor && HoldsOption(keys, key) &&
        std::find(sensors.begin(), sensors.end(), *sensor) == sensors.end()) {
      return "--sensor " + std::string(*sensor);
    }
  }
  static const std::vector<Dependence> kDependences = AllDependences();
  for (const Dependence& dependence : kDependences) {
    const std::string_view other = dependence.other;
    if (!HoldsOption(dependence.keys, key) || dependence.has_effect(options)) continue;
    if (has_map && other.starts_with("features.") && !key.starts_with("features.")) continue;
    return fmt::format("{}={}", other, table.Value(other));
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> DifferentOptions(SlamOptions a, SlamOptions b) {
  const OptionTable of_a(a), of_b(b);
  std::vector<std::string> keys;
  for (const std::string& key : of_a.Keys()) {
    if (of_a.Value(key) != of_b.Value(key)) keys.push_back(key);
  }
  return keys;
}

std::vector<std::string> OptionsWithoutEffect(const SlamOptions& options,
                                              const std::vector<std::string>& set,
                                              std::optional<std::string_view> sensor,
                                              bool has_map) {
  SlamOptions copy = options;  // the table needs references to options that may be changed
  const OptionTable table(copy);
  std::map<std::string, std::vector<std::string>> keys_by_reason;
  for (const std::string& key : table.Keys()) {
    if (std::find(set.begin(), set.end(), key) == set.end()) continue;
    const auto reason = WhatForbids(key, options, table, sensor, has_map);
    if (reason) keys_by_reason[*reason].push_back(key);
  }
  std::vector<std::string> lines;
  for (const auto& [reason, keys] : keys_by_reason) {
    lines.push_back(fmt::format("{}: no effect with {}", fmt::join(keys, ", "), reason));
  }
  return lines;
}

}  // namespace plumbline
