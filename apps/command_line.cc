// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_line.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

namespace plumbline {
namespace {

const CommandOption* FindOption(const CommandSyntax& syntax, std::string_view name) {
  const auto found = std::find_if(
      syntax.options.begin(), syntax.options.end(), [name](const CommandOption& option) {
        return option.name == name;
      });
  return found == syntax.options.end() ? nullptr : &*found;
}

[[noreturn]] void FailUnknown(const CommandSyntax& syntax, const std::string& name) {
  for (const RemovedOption& removed : syntax.removed) {
    if (removed.name != name) continue;
    throw InputError(syntax.name + ": " + NoOptionAnyMore(removed));
  }
  std::vector<std::string> names = {"--help"};
  for (const CommandOption& option : syntax.options) names.push_back(option.name);
  const std::optional<std::string> nearest = NearestName(name, names);
  throw InputError(syntax.name + ": unknown option " + Printable(name) +
                   (nearest ? "; the nearest is " + *nearest : ""));
}

bool MayBeRepeated(const CommandOption& option) {
  return option.help.find("may be repeated") != std::string::npos;
}

bool IsHelp(std::string_view argument) { return argument == "--help" || argument == "-h"; }

// Throws InputError if the argument in the place of a value is an option.
void CheckValue(const CommandSyntax& syntax,
                const CommandOption& option,
                const std::string& argument) {
  if (FindOption(syntax, argument.substr(0, argument.find('='))) == nullptr) return;
  throw InputError(fmt::format("{0}: expected {1}, found the option {2}; {0}={2} is a value",
                               option.name,
                               option.value,
                               Printable(argument)));
}

bool IsAnyNumber(const std::string& positional) { return positional.ends_with(" ...]"); }

bool MayBeLeftOut(const std::string& positional) { return positional.starts_with('['); }

}  // namespace

CommandLine::CommandLine(const CommandSyntax& syntax, std::span<const std::string> arguments) {
  bool options_end = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (options_end || argument.size() < 2 || argument.front() != '-') {
      // An empty one comes from a variable of a script that is not set.
      if (argument.empty()) throw InputError(syntax.name + ": found an empty argument");
      positionals_.push_back(argument);
      continue;
    }
    if (argument == "--") {
      options_end = true;
      continue;
    }
    if (IsHelp(argument)) {
      values_["--help"].emplace_back();
      return;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const CommandOption* option = FindOption(syntax, name);
    if (option == nullptr) FailUnknown(syntax, name);
    if (option->value.empty()) {
      if (equals != std::string::npos) throw InputError(name + ": takes no value");
      values_[name].emplace_back();
    } else if (equals != std::string::npos) {
      AddValue(*option, argument.substr(equals + 1));
    } else {
      if (i + 1 == arguments.size()) throw InputError(name + ": expected " + option->value);
      if (IsHelp(arguments[i + 1])) continue;
      CheckValue(syntax, *option, arguments[++i]);
      AddValue(*option, arguments[i]);
    }
  }
  const auto wanted = syntax.positionals.size();
  const auto optional = static_cast<std::size_t>(
      std::count_if(syntax.positionals.begin(), syntax.positionals.end(), MayBeLeftOut));
  const bool any_number = wanted > 0 && IsAnyNumber(syntax.positionals.back());
  if (positionals_.size() > wanted && !any_number) {
    throw InputError(syntax.name + ": unexpected argument " + Printable(positionals_[wanted]));
  }
  if (positionals_.size() + optional < wanted) {
    throw InputError(syntax.name + ": expected " + syntax.positionals[positionals_.size()] +
                     "; see plumbline " + syntax.name + " --help");
  }
  positionals_.resize(std::max(wanted, positionals_.size()));
}

void CommandLine::AddValue(const CommandOption& option, std::string value) {
  if (value.empty()) {
    throw InputError(option.name + ": expected " + option.value + ", found an empty argument");
  }
  std::vector<std::string>& values = values_[option.name];
  if (!values.empty() && !MayBeRepeated(option)) {
    throw InputError(fmt::format("{}: expected it once, found {} and {}",
                                 option.name,
                                 InQuotes(values.front()),
                                 InQuotes(value)));
  }
  values.push_back(std::move(value));
}

bool CommandLine::Has(std::string_view option) const { return values_.contains(option); }

std::optional<std::string> CommandLine::Value(std::string_view option) const {
  const auto found = values_.find(option);
  if (found == values_.end()) return std::nullopt;
  return found->second.back();
}

std::vector<std::string> CommandLine::Values(std::string_view option) const {
  const auto found = values_.find(option);
  return found == values_.end() ? std::vector<std::string>{} : found->second;
}

int CommandLine::Count(std::string_view option, int fallback, CountRange range) const {
  const auto text = Value(option);
  return text ? ParseCount(option, *text, range) : fallback;
}

const std::string& CommandLine::Positional(std::size_t index) const {
  PLUMBLINE_CHECK(index < positionals_.size(), "positional argument of the syntax");
  return positionals_[index];
}

std::vector<std::string> CommandLine::PositionalsFrom(std::size_t index) const {
  std::vector<std::string> from;
  for (std::size_t i = index; i < positionals_.size(); ++i) {
    if (!positionals_[i].empty())
      from.push_back(positionals_[i]);  // one that was left out is empty
  }
  return from;
}

int ParseCount(std::string_view option, std::string_view text, CountRange range) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || value < range.min || value > range.max) {
    throw InputError(fmt::format("{}: expected a whole number from {} to {}, found {}",
                                 option,
                                 range.min,
                                 range.max,
                                 Printable(text)));
  }
  return value;
}

std::string HelpText(const CommandSyntax& syntax) {
  std::string text = "plumbline " + syntax.name;
  for (const std::string& positional : syntax.positionals) text += " " + positional;
  text += syntax.options.empty() ? "\n" : " [options]\n";
  text += syntax.summary + "\n";
  if (syntax.options.empty()) return text;
  text += "\n";
  std::size_t widest = 0;
  const auto left = [](const CommandOption& option) {
    return option.name + (option.value.empty() ? "" : " " + option.value);
  };
  for (const CommandOption& option : syntax.options) {
    widest = std::max(widest, left(option).size());
  }
  for (const CommandOption& option : syntax.options) {
    const std::string head = left(option);
    text += "  " + head + std::string(widest + 2 - head.size(), ' ') + option.help + "\n";
  }
  return text;
}

void FailChoice(std::string_view option,
                std::span<const std::string> names,
                std::string_view found) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "" : last ? " or " : ", ") + names[i];
  }
  throw InputError(std::string(option) + ": expected " + text + ", found " + Printable(found));
}

}  // namespace plumbline
