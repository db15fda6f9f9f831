// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "node_parameters.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <optional>
#include <set>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline::ros_node {
namespace {

constexpr const char* kOptions = "options.";

std::string NameOfType(const ParameterValue& value) {
  static constexpr const char* kNames[] = {
      "a truth value", "a whole number", "a number", "a text", "a list"};
  return kNames[value.index()];
}

std::string TextOf(const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* number = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<double>(value));
}

// Reads parameters by name, and remembers the names.
class Reader {
 public:
  Reader(const Parameters& parameters, const ParameterNames& shown)
      : parameters_(parameters), shown_(shown), names_(shown.others.begin(), shown.others.end()) {}

  template <class T>
  void Read(const std::string& name, T& value) {
    names_.insert(name);
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return;
    if constexpr (std::is_same_v<T, double>) {
      if (const auto* number = std::get_if<std::int64_t>(&found->second)) {
        value = static_cast<double>(*number);
        return;
      }
    }
    const T* wanted = std::get_if<T>(&found->second);
    if (wanted == nullptr) Fail(name, NameOfType(T(value)), NameOfType(found->second));
    value = *wanted;
  }
  void Read(const std::string& name, int& value) {
    std::int64_t number = value;
    Read(name, number);
    if (number < 1 || number > 1'000'000) Fail(name, "at least 1", fmt::format("{}", number));
    value = static_cast<int>(number);
  }
  // Stays empty where it is not set.
  void Read(const std::string& name, std::optional<bool>& value) {
    bool flag = false;
    Read(name, flag);
    if (parameters_.contains(name)) value = flag;
  }
  // One of two texts; returns true for the second.
  bool IsSecond(const std::string& name, const std::string& first, const std::string& second) {
    std::string value = first;
    Read(name, value);
    if (value != first && value != second) Fail(name, first + " or " + second, Printable(value));
    return value == second;
  }
  // The options of SLAM: options.features.line_count is features.line_count.
  std::vector<OptionSetting> ReadOptions() {
    const std::string group(kOptions, std::string(kOptions).size() - 1);
    names_.insert(group);
    if (const auto whole = parameters_.find(group); whole != parameters_.end()) {
      Fail(group, "a group", NameOfType(whole->second));
    }
    std::vector<OptionSetting> options;
    for (const auto& [name, value] : parameters_) {
      if (!name.starts_with(kOptions)) continue;
      if (std::holds_alternative<ListValue>(value)) {
        Fail(name, "a number, a truth value or a text", "a list");
      }
      options.push_back(
          {name.substr(std::string(kOptions).size()), TextOf(value), shown_.Shown(name)});
    }
    return options;
  }

  // What was set for this node and is none of its parameters.
  void CheckNames() const {
    for (const auto& [name, value] : parameters_) {
      if (names_.contains(name) || name.starts_with(kOptions)) continue;
      const std::vector<std::string> known(names_.begin(), names_.end());
      const std::optional<std::string> nearest = NearestName(name, known);
      throw InputError(fmt::format("{}: expected a parameter of this node ({}){}",
                                   Printable(shown_.Shown(name)),
                                   fmt::join(known, ", "),
                                   nearest ? "; did you mean '" + *nearest + "'?" : ""));
    }
  }

  [[noreturn]] void Fail(const std::string& name,
                         const std::string& expected,
                         const std::string& found) const {
    throw InputError(fmt::format("{}: expected {}, found {}", shown_.Shown(name), expected, found));
  }

 private:
  const Parameters& parameters_;
  const ParameterNames& shown_;
  std::set<std::string> names_;
};

void CheckTogether(const Reader& reader, const NodeParameters& p) {
  if (p.slam.sensor != "mono" && p.slam.sensor != "stereo" && p.slam.sensor != "rgbd") {
    reader.Fail("sensor", "mono, stereo or rgbd", Printable(p.slam.sensor));
  }
  if (!(p.map_period > 0)) {
    reader.Fail("map_period", "seconds greater than 0", fmt::format("{}", p.map_period));
  }
  if ((p.load || p.localize) && p.map_file.empty()) {
    reader.Fail("map_file", "a file to load", "none");
  }
}

}  // namespace

NodeParameters ReadParameters(const Parameters& parameters, const ParameterNames& names) {
  NodeParameters p;
  Reader reader(parameters, names);
  reader.Read("sensor", p.slam.sensor);
  reader.Read("camera", p.slam.camera);
  reader.Read("rectified", p.slam.rectified);
  reader.Read("config", p.slam.config);
  p.slam.options = reader.ReadOptions();
  reader.Read("imu", p.slam.imu);
  if (reader.IsSecond("image_transport", "raw", "compressed")) p.image_transport = "compressed";
  if (reader.IsSecond("depth_transport", "raw", "compressedDepth")) {
    p.depth_transport = "compressedDepth";
  }
  p.approximate_sync = reader.IsSecond("sync", "exact", "approximate");
  reader.Read("queue_size", p.queue_size);
  reader.Read("map_file", p.map_file);
  reader.Read("load", p.load);
  reader.Read("localize", p.localize);
  reader.Read("map_frame", p.map_frame);
  reader.Read("odom_frame", p.odom_frame);
  reader.Read("base_frame", p.base_frame);
  reader.Read("publish_tf", p.publish_tf);
  reader.Read("publish_odom_tf", p.publish_odom_tf);
  reader.Read("map_period", p.map_period);
  reader.CheckNames();
  CheckTogether(reader, p);
  return p;
}

}  // namespace plumbline::ros_node
