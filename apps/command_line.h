// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plumbline {

// An option of a subcommand, as `plumbline SUBCOMMAND --help` lists it.
struct CommandOption {
  std::string name;   // "--align"
  std::string value;  // what follows it, "none|se3|sim3"; empty for a switch
  std::string help;   // with "may be repeated" for one that may
};

// An option of earlier versions. Whoever gives it is told what serves instead.
struct RemovedOption {
  std::string name;     // "--resume"
  std::string instead;  // a sentence without its point
};

// What a subcommand takes.
struct CommandSyntax {
  std::string name;                      // "evaluate"
  std::string summary;                   // one sentence
  std::vector<std::string> positionals;  // "REFERENCE", "ESTIMATE": all needed, in this order;
                                         // one in brackets, "[PATH]", may be left out, and the
                                         // last may be "[PATH ...]": any number of them
  std::vector<CommandOption> options;    // --help is understood always
  std::vector<RemovedOption> removed = {};
};

// Whole numbers that an option takes, both ends included. What is beyond is no wish that anybody
// has but a slip, and would keep the program busy or ask for memory without end.
struct CountRange {
  int min = 0;
  int max = 0;
};

// Frames by index, as --from, --to, --stride and the like take them.
constexpr int kMostFrames = 1'000'000'000;

// The arguments of a subcommand, taken apart: `--name value`, `--name=value`, switches and
// positional arguments in any order; everything behind `--` is positional.
class CommandLine {
 public:
  // Throws InputError for an unknown option (with the nearest one there is, or
  // what serves instead of a removed one), a value that is
  // missing, empty or not wanted, a second value of an option that may not be repeated, or a wrong
  // number of positional arguments. With --help among the arguments nothing else is checked.
  CommandLine(const CommandSyntax& syntax, std::span<const std::string> arguments);

  bool help() const { return Has("--help"); }
  bool Has(std::string_view option) const;
  // The last value given.
  std::optional<std::string> Value(std::string_view option) const;
  // All values given, in order, for options that may be repeated.
  std::vector<std::string> Values(std::string_view option) const;
  // A whole number within the range, or `fallback` where the option is not given. Throws InputError
  // for anything else.
  int Count(std::string_view option, int fallback, CountRange range) const;
  // Empty when a positional argument that may be left out is.
  const std::string& Positional(std::size_t index) const;
  // The positional arguments from one on, as many as there are.
  std::vector<std::string> PositionalsFrom(std::size_t index) const;

 private:
  void AddValue(const CommandOption& option, std::string value);

  std::map<std::string, std::vector<std::string>, std::less<>> values_;
  std::vector<std::string> positionals_;
};

// A whole number within the range; InputError "--start: expected a whole number from 0 to 9, found
// x" for any other text.
int ParseCount(std::string_view option, std::string_view text, CountRange range);

// The text of --help.
std::string HelpText(const CommandSyntax& syntax);

// The enumerator with this name; InputError "--align: expected none, se3 or sim3, found se2".
// Enum types list their names as described in base/options.h.
[[noreturn]] void FailChoice(std::string_view option,
                             std::span<const std::string> names,
                             std::string_view found);
template <class Enum>
Enum ParseChoice(std::string_view option, std::string_view text) {
  std::vector<std::string> names;
  for (const auto& [value, name] : EnumNames(std::type_identity<Enum>{})) {
    if (text == name) return value;
    names.emplace_back(name);
  }
  FailChoice(option, names, text);
}

}  // namespace plumbline
