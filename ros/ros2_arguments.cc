// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "ros2_arguments.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/yaml_document.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace plumbline::ros_node {
namespace {

constexpr std::uint32_t kLargestDomain = 232;

std::string Where(const std::string& source, const YAML::Node& node) {
  return fmt::format("{}:{}", source, node.Mark().line + 1);
}

// Quoted scalars are texts.
ParameterValue ValueOf(const YAML::Node& node) {
  if (!node.IsScalar()) return ListValue{};
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;
  bool flag = false;
  if (YAML::convert<bool>::decode(node, flag)) return flag;
  std::int64_t whole = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, whole);
  if (parsed.ec == std::errc() && parsed.ptr == end) return whole;
  double number = 0;
  if (YAML::convert<double>::decode(node, number)) return number;
  return text;
}

void AddValues(const std::string& name,
               const YAML::Node& node,
               const std::string& source,
               Ros2Settings& settings) {
  if (!node.IsMap()) {
    settings.parameters[name] = ValueOf(node);
    settings.sources[name] = Where(source, node);
    return;
  }
  for (const auto& entry : node) {
    const std::string& key = entry.first.Scalar();
    AddValues(name.empty() ? key : name + "." + key, entry.second, source, settings);
  }
}

// "FROM:=TO" in its two parts.
std::pair<std::string, std::string> SplitAssignment(const std::string& text) {
  const std::size_t at = text.find(":=");
  if (at == std::string::npos || at == 0 || at + 2 == text.size()) {
    throw InputError("arguments: expected NAME:=VALUE, found " + InQuotes(text));
  }
  return {text.substr(0, at), text.substr(at + 2)};
}

void CheckName(const std::string& name) {
  const bool valid = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '~';
  });
  if (valid && !name.empty() && !name.ends_with('/') && name.find("//") == std::string::npos)
    return;
  throw InputError("arguments: expected a name of letters, digits, _ and /, found " +
                   InQuotes(name));
}

std::uint32_t DomainOf(const std::string& text) {
  if (text.empty()) return 0;
  std::uint32_t domain = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, domain);
  if (parsed.ec != std::errc() || parsed.ptr != end || domain > kLargestDomain) {
    throw InputError(fmt::format("ROS_DOMAIN_ID: expected a whole number from 0 to {}, found {}",
                                 kLargestDomain,
                                 InQuotes(text)));
  }
  return domain;
}

bool IsLocalhostOnly(const std::string& text) {
  if (text.empty() || text == "0" || text == "1") return text == "1";
  throw InputError("ROS_LOCALHOST_ONLY: expected 0 or 1, found " + InQuotes(text));
}

// Sorts arguments by their kind, before names are known.
struct Arguments {
  std::vector<std::pair<std::string, std::string>> names;
  std::vector<std::pair<bool, std::string>> parameters;  // whether it is a file; in order
  std::vector<std::string> notes;

  explicit Arguments(std::span<const std::string> arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const std::string& word = arguments[i];
      if (word == "--ros-args" || word == "--") continue;
      const bool is_name = word == "-r" || word == "--remap", is_file = word == "--params-file";
      const bool is_level = word == "--log-level";
      if (!is_name && !is_file && !is_level && word != "-p" && word != "--param") {
        if (word.starts_with('-')) {
          throw InputError("arguments: expected -r, -p, --params-file or NAME:=NAME, found " +
                           InQuotes(word));
        }
        names.push_back(SplitAssignment(word));
        continue;
      }
      if (++i == arguments.size()) {
        throw InputError("arguments: expected a value after " + word + ", found none");
      }
      if (is_level) {
        notes.push_back("--log-level " + Printable(arguments[i]) + " is not used");
      } else if (is_name) {
        names.push_back(SplitAssignment(arguments[i]));
      } else {
        parameters.emplace_back(is_file, arguments[i]);
      }
    }
  }
};

void ReadNames(const Arguments& arguments, Ros2Settings& settings) {
  for (const auto& [from, to] : arguments.names) {
    if (from == "__ns" && to == "/") continue;
    CheckName(to);
    if (from == "__node" && to.find_first_of("/~") != std::string::npos) {
      throw InputError("__node: expected a name of letters, digits and _, found " + InQuotes(to));
    }
    if (from == "__node") settings.name = to;
    if (from == "__ns") settings.name_space = to.starts_with('/') ? to : "/" + to;
  }
  for (const auto& [from, to] : arguments.names) {
    if (from == "__node" || from == "__ns") continue;
    CheckName(from);
    settings.remappings[settings.Expand(from)] = settings.Expand(to);
  }
}

// Parameters that any node of ROS 2 has, and those of the transport; the others stay.
void TakeOwnParameters(Ros2Settings& settings) {
  const ParameterNames names{"", settings.sources};
  if (const auto found = settings.parameters.find("use_sim_time");
      found != settings.parameters.end()) {
    if (!std::holds_alternative<bool>(found->second)) {
      throw InputError(names.Shown("use_sim_time") + ": expected a truth value, found another one");
    }
    settings.use_sim_time = std::get<bool>(found->second);
    settings.parameters.erase(found);
  }
  const auto found = settings.parameters.find("reliability");
  if (found == settings.parameters.end()) return;
  const auto* text = std::get_if<std::string>(&found->second);
  if (text == nullptr || (*text != "reliable" && *text != "best_effort")) {
    throw InputError(names.Shown("reliability") + ": expected best_effort or reliable, found " +
                     (text != nullptr ? Printable(*text) : "another value"));
  }
  settings.reliable = *text == "reliable";
  settings.parameters.erase(found);
}

}  // namespace

std::string Ros2Settings::Expand(const std::string& topic) const {
  if (topic.starts_with('/')) return topic;
  if (topic.starts_with("~/")) return FullName() + topic.substr(1);
  return (name_space == "/" ? "" : name_space) + "/" + topic;
}

std::string Ros2Settings::Resolve(const std::string& topic) const {
  const std::string expanded = Expand(topic);
  const auto found = remappings.find(expanded);
  return found != remappings.end() ? found->second : expanded;
}

void ReadParameterFile(const std::string& text, const std::string& source, Ros2Settings& settings) {
  const YAML::Node document = ParseYaml(text, source);
  if (!document.IsMap()) {
    throw InputError(Where(source, document) + ": expected groups named after nodes");
  }
  for (const auto& node : document) {
    const std::string& name = node.first.Scalar();
    const bool is_own = name == "/**" || name == settings.FullName() ||
                        (settings.name_space == "/" && name == settings.name);
    if (!is_own) continue;
    const YAML::Node values = node.second.IsMap() ? node.second["ros__parameters"]
                                                  : YAML::Node(YAML::NodeType::Undefined);
    if (!values || !values.IsMap()) {
      const bool is_list = values && values.IsSequence(), is_text = values && values.IsScalar();
      throw InputError(Where(source, node.first) + ": expected a group ros__parameters in " +
                       InQuotes(name) + ", found " +
                       (is_list   ? "a list"
                        : is_text ? "a single value"
                                  : "none"));
    }
    AddValues("", values, source, settings);
  }
}

Ros2Settings ReadRos2Settings(std::span<const std::string> arguments,
                              const Ros2Environment& environment) {
  Ros2Settings settings;
  settings.domain = DomainOf(environment.domain_id);
  settings.localhost_only = IsLocalhostOnly(environment.localhost_only);
  const bool is_old = environment.distro == "foxy" || environment.distro == "galactic" ||
                      environment.distro == "humble";
  if (is_old) settings.gid_size = 24;
  const Arguments sorted(arguments);
  settings.notes = sorted.notes;
  ReadNames(sorted, settings);
  for (const auto& [is_file, text] : sorted.parameters) {
    if (is_file) {
      ReadParameterFile(ReadInputFile(text), text, settings);
    } else {
      const auto [name, value] = SplitAssignment(text);
      settings.parameters[name] = ValueOf(ParseYaml(value, "-p " + name));
      settings.sources.erase(name);
    }
  }
  TakeOwnParameters(settings);
  return settings;
}

}  // namespace plumbline::ros_node
