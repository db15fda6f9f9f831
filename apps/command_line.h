// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

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

// An option of a subcommand, as listed by `plumbline SUBCOMMAND --help`.
struct CommandOption {
  std::string name;   // "--align"
  std::string value;  // its value, "none|se3|sim3"; empty for a switch
  std::string help;   // contains "may be repeated" if it may
};

// Syntax of a subcommand.
struct CommandSyntax {
  std::string name;     // "evaluate"
  std::string summary;  // one sentence
  // "REFERENCE", "ESTIMATE": all required, in this order; "[PATH]" is optional, and the last may be
  // "[PATH ...]": any number of them
  std::vector<std::string> positionals;
  std::vector<CommandOption> options;  // without --help, which is always understood
  std::vector<RemovedOption> removed = {};
};

// Valid whole numbers of an option, both ends included. Numbers beyond are surely mistakes, and
// would keep the program busy or exhaust the memory.
struct CountRange {
  int min = 0;
  int max = 0;
};

// Limit of frame indices, for --from, --to, --stride and similar options.
constexpr int kMostFrames = 1'000'000'000;

// The parsed arguments of a subcommand: `--name value`, `--name=value`, switches and positional
// arguments in any order; everything after `--` is positional.
class CommandLine {
 public:
  // Throws InputError for an unknown option (with the nearest known one, or the successor of a
  // removed one), a value that is missing, empty or unexpected, a second value of an option that
  // may not be repeated, or a wrong number of positional arguments. A value is missing, too, if an
  // option of the subcommand follows; `--name=--option` makes it the value. With --help among the
  // arguments nothing behind it is checked.
  CommandLine(const CommandSyntax& syntax, std::span<const std::string> arguments);

  bool help() const { return Has("--help"); }
  bool Has(std::string_view option) const;
  // The last value given.
  std::optional<std::string> Value(std::string_view option) const;
  // All values given, in order, for options that may be repeated.
  std::vector<std::string> Values(std::string_view option) const;
  // A whole number within the range, or `fallback` without the option. Throws InputError for
  // anything else.
  int Count(std::string_view option, int fallback, CountRange range) const;
  // Empty if an optional positional argument is missing.
  const std::string& Positional(std::size_t index) const;
  // All positional arguments from `index` on.
  std::vector<std::string> PositionalsFrom(std::size_t index) const;

 private:
  void AddValue(const CommandOption& option, std::string value);

  std::map<std::string, std::vector<std::string>, std::less<>> values_;
  std::vector<std::string> positionals_;
};

// Returns a whole number within the range. Throws InputError "--start: expected a whole number from
// 0 to 9, found x" for any other text.
int ParseCount(std::string_view option, std::string_view text, CountRange range);

// The text of --help.
std::string HelpText(const CommandSyntax& syntax);

// Returns the enumerator of this name. Throws InputError "--align: expected none, se3 or sim3,
// found se2". Enum types list their names as described in base/options.h.
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
