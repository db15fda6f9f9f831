// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/base/yaml_document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <system_error>

#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

std::string Shortest(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string Join(const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : " | ") + name;
  return joined;
}

// Returns a double-quoted YAML scalar.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? std::string("\\n") : c == '\t' ? std::string("\\t") : std::string(1, c);
  }
  return quoted + "\"";
}

std::string RangeText(const Range& range) {
  if (std::isinf(range.max)) return "at least " + Shortest(range.min);
  if (std::isinf(range.min)) return "at most " + Shortest(range.max);
  return Shortest(range.min) + " to " + Shortest(range.max);
}

bool Bounded(const OptionField& field) {
  return field.range && (!std::isinf(field.range->min) || !std::isinf(field.range->max));
}

// Returns the allowed values in words: "one of a | b", "a whole number, 1 to 10".
std::string Allowed(const OptionField& field) {
  struct Name {
    std::string operator()(const bool*) const { return "true or false"; }
    std::string operator()(const int*) const { return "a whole number"; }
    std::string operator()(const std::int64_t*) const { return "a whole number"; }
    std::string operator()(const std::uint64_t*) const { return "a whole number, at least 0"; }
    std::string operator()(const double*) const { return "a number"; }
    std::string operator()(const std::string*) const { return "a text"; }
    std::string operator()(const NamedField& e) const { return "one of " + Join(e.names); }
  };
  std::string text = std::visit(Name{}, field.target);
  if (Bounded(field)) text += ", " + RangeText(*field.range);
  return text;
}

template <class T>
std::optional<T> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

bool HasName(const NamedField& field, const std::string& text) {
  return std::find(field.names.begin(), field.names.end(), text) != field.names.end();
}

bool InRange(const OptionField& field, double value) {
  return !std::isnan(value) &&
         (!field.range || (field.range->min <= value && value <= field.range->max));
}

// Writes the value that a text names to its option; returns false when the text is not allowed
// there.
struct Store {
  const OptionField& field;
  const std::string& text;

  bool operator()(bool* target) const {
    if (text != "true" && text != "false") return false;
    *target = text == "true";
    return true;
  }
  template <class T>
  bool operator()(T* target) const {
    const std::optional<T> value = ParseNumber<T>(text);
    if (!value || !InRange(field, static_cast<double>(*value))) return false;
    *target = *value;
    return true;
  }
  bool operator()(std::string* target) const {
    *target = text;
    return true;
  }
  bool operator()(const NamedField& target) const {
    if (!HasName(target, text)) return false;
    target.set(text);
    return true;
  }
};

struct HasAllowedValue {
  const OptionField& field;

  bool operator()(const NamedField& choice) const { return HasName(choice, choice.get()); }
  bool operator()(const std::string* /*text*/) const { return true; }
  template <class T>
  bool operator()(const T* value) const {
    return InRange(field, static_cast<double>(*value));
  }
};

struct ToText {
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const double* value) const { return Shortest(*value); }
  std::string operator()(const std::string* value) const { return Quoted(*value); }
  std::string operator()(const NamedField& value) const { return value.get(); }
  template <class T>
  std::string operator()(const T* value) const {
    return std::to_string(*value);
  }
};

std::string Comment(const OptionField& field) {
  std::string limits;
  if (const auto* choice = std::get_if<NamedField>(&field.target)) {
    limits = Join(choice->names);
  } else if (std::holds_alternative<bool*>(field.target)) {
    limits = "true | false";
  } else if (Bounded(field)) {
    limits = RangeText(*field.range);
  }
  if (limits.empty()) return field.help;
  return field.help + (field.help.empty() ? "(" : " (") + limits + ")";
}

std::string Indent(std::string_view key) {
  return std::string(2 * static_cast<std::size_t>(std::count(key.begin(), key.end(), '.')), ' ');
}

std::string LastPart(const std::string& key) { return key.substr(key.rfind('.') + 1); }

// The line of an option in a document, without its indent.
std::string Line(std::string_view key, const OptionField& field) {
  return std::string(key) + ": " + OptionTable::ValueOf(field) + "  # " + Comment(field) + "\n";
}

std::string RemovedMessage(const std::string& where,
                           const RemovedOption& removed,
                           const std::string& found) {
  return where + ": " + NoOptionAnyMore(removed) + ", found " + InQuotes(found);
}

std::string NotAllowed(const std::string& where,
                       const OptionField& field,
                       const std::string& found) {
  return where + ": " + field.key + ": expected " + Allowed(field) + ", found " + InQuotes(found);
}

bool IsUnknownMethod(const OptionField& field, const std::string& text) {
  const auto* methods = std::get_if<NamedField>(&field.target);
  return methods != nullptr && methods->is_method && !text.empty() && !HasName(*methods, text);
}

bool IsValueOf(const RemovedOption& removed, const std::string& text) {
  if (text == removed.value) return !text.empty();
  const std::optional<double> found = ParseNumber<double>(text);
  return found && found == ParseNumber<double>(removed.value);
}

struct Setting {
  std::string key;
  std::optional<std::string> text;  // nullopt: `key:` without a value
  int line;
};

// Collects the leaves of a YAML map, depth first in the order of the file, with dotted keys. By
// YAML's aliases groups may repeat others, even themselves; a limit keeps that from growing without
// end.
class Flattener {
 public:
  explicit Flattener(std::string source) : source_(std::move(source)) {}

  void Add(const YAML::Node& map, const std::string& prefix) {
    constexpr int kMaxEntries = 10000;
    constexpr std::size_t kMaxPrefix = 1000;
    for (const auto& entry : map) {
      const YAML::Node& value = entry.second;
      const int line = entry.first.Mark().line + 1;
      if (++entries_ > kMaxEntries || prefix.size() > kMaxPrefix) {
        throw InputError(source_ + ":" + std::to_string(line) +
                         ": expected options, found groups without end");
      }
      const std::string key = prefix + (entry.first.IsScalar() ? entry.first.Scalar() : "[...]");
      if (value.IsMap()) {
        Add(value, key + ".");
      } else if (value.IsNull()) {
        settings_.push_back({key, std::nullopt, line});
      } else {
        settings_.push_back({key, value.IsScalar() ? value.Scalar() : "[...]", line});
      }
    }
  }

  const std::vector<Setting>& settings() const { return settings_; }

 private:
  std::string source_;
  std::vector<Setting> settings_;
  int entries_ = 0;
};

}  // namespace

RemovedOption FixedAt(std::string_view key, double value, std::string_view constant) {
  const std::string text = Shortest(value);
  return {std::string(key), "it is fixed at " + text + " (" + std::string(constant) + ")", text};
}

std::string NoOptionAnyMore(const RemovedOption& removed) {
  return removed.name + " is no option any more: " + removed.instead;
}

// A group whose options are all removed is still one.
bool OptionTable::IsGroup(std::string_view key) const {
  const std::string inside = std::string(key) + ".";
  return std::any_of(groups_.begin(),
                     groups_.end(),
                     [key](const Group& group) { return group.key == key; }) ||
         std::any_of(removed_.begin(), removed_.end(), [&](const RemovedOption& removed) {
           return removed.name.starts_with(inside);
         });
}

const RemovedOption* OptionTable::FindRemoved(std::string_view key) const {
  const auto found = std::find_if(
      removed_.begin(), removed_.end(), [key](const RemovedOption& r) { return r.name == key; });
  return found == removed_.end() ? nullptr : &*found;
}

OptionField* OptionTable::FindField(std::string_view key) {
  const auto found = std::find_if(
      fields_.begin(), fields_.end(), [key](const OptionField& field) { return field.key == key; });
  return found == fields_.end() ? nullptr : &*found;
}

void OptionTable::Add(const AddedMethod& method) {
  OptionField* field = FindField(method.key);
  if (field == nullptr) return;
  auto* methods = std::get_if<NamedField>(&field->target);
  PLUMBLINE_CHECK(methods != nullptr && methods->is_method, "an option that names no method");
  methods->names.push_back(method.name);
  field->help += ", " + method.name + " (" + method.help + ")";
}

void OptionTable::Set(const std::string& key, const std::string& text, const std::string& where) {
  if (const OptionField* field = FindField(key)) {
    if (std::visit(Store{*field, text}, field->target)) return;
    throw InputError(NotAllowed(where, *field, text));
  }
  if (IsGroup(key)) {
    throw InputError(where + ": " + key + ": expected a group of options, found " + InQuotes(text));
  }
  if (const RemovedOption* removed = FindRemoved(key)) {
    throw InputError(RemovedMessage(where, *removed, text));
  }
  const std::vector<std::string> keys = Keys();
  const std::optional<std::string> nearest = NearestName(key, keys);
  throw InputError(where + ": unknown option " + InQuotes(key) +
                   (nearest ? "; did you mean '" + *nearest + "'?" : ""));
}

void OptionTable::LoadFile(const std::filesystem::path& path) {
  const std::string text = ReadInputFile(path, kLargestSettings);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(path.string() + ": expected options as 'key: value', found an empty file");
  }
  LoadText(text, path.string());
}

void OptionTable::LoadText(const std::string& text,
                           const std::string& source,
                           const std::function<void(const RemovedSetting&)>& on_removed) {
  const YAML::Node root = ParseYaml(text, source);
  if (!root.IsMap() && !root.IsNull()) {
    throw InputError(source + ":1: expected options as 'key: value', found other YAML");
  }
  Flattener flattener(source);
  flattener.Add(root, "");
  std::map<std::string, int> lines;
  for (const Setting& setting : flattener.settings()) {
    const std::string where = source + ":" + std::to_string(setting.line);
    // `ba: {huber_px: 2}` and `ba.huber_px: 2` are the same option.
    const auto [first, added] = lines.emplace(setting.key, setting.line);
    if (!added) {
      throw InputError(where + ": " + Printable(setting.key) +
                       ": expected each option once, found it in line " +
                       std::to_string(first->second) + ", too");
    }
    if (const RemovedOption* removed = FindRemoved(setting.key)) {
      const std::string found = setting.text.value_or("");
      if (IsValueOf(*removed, found)) continue;
      if (on_removed) {
        on_removed({setting.key, found, removed->value, RemovedMessage(where, *removed, found)});
        continue;
      }
    }
    const OptionField* field = FindField(setting.key);
    if (on_removed && field != nullptr && IsUnknownMethod(*field, setting.text.value_or(""))) {
      on_removed(
          {setting.key, *setting.text, ValueOf(*field), NotAllowed(where, *field, *setting.text)});
      continue;
    }
    // A group without options, e.g. all of them commented out, is allowed.
    if (setting.text || !IsGroup(setting.key)) {
      Set(setting.key, setting.text.value_or(""), where);
    }
  }
}

void OptionTable::Set(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw InputError("--set: expected KEY=VALUE, found " + InQuotes(assignment));
  }
  Set(std::string(assignment.substr(0, equals)),
      std::string(assignment.substr(equals + 1)),
      "--set " + Printable(assignment));
}

void OptionTable::CheckRanges() const {
  for (const OptionField& field : fields_) {
    if (std::visit(HasAllowedValue{field}, field.target)) continue;
    throw InputError(field.key + ": expected " + Allowed(field) + ", found " + ValueOf(field));
  }
}

std::string OptionTable::Dump() const {
  return Dump([](const OptionField&) { return true; });
}

std::string OptionTable::Dump(const std::function<bool(const OptionField&)>& wanted) const {
  std::string out;
  std::size_t group = 0;
  std::vector<const Group*> open;  // groups with the present option that are not written yet
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    for (; group < groups_.size() && groups_[group].first_field == i; ++group) {
      open.push_back(&groups_[group]);
    }
    const OptionField& field = fields_[i];
    std::erase_if(open, [&](const Group* g) { return !field.key.starts_with(g->key + "."); });
    if (!wanted(field)) continue;
    for (const Group* g : open) {
      if (Indent(g->key).empty() && !out.empty()) out += '\n';
      out += Indent(g->key) + LastPart(g->key) + ":  # " + g->help + "\n";
    }
    open.clear();
    out += Indent(field.key) + Line(LastPart(field.key), field);
  }
  return out;
}

std::string OptionTable::DumpDotted(const std::function<bool(const OptionField&)>& wanted) const {
  std::string out;
  for (const OptionField& field : fields_) {
    if (wanted(field)) out += Line(field.key, field);
  }
  return out;
}

std::string OptionTable::ValueOf(const OptionField& field) {
  return std::visit(ToText{}, field.target);
}

std::string OptionTable::Value(std::string_view key) const {
  for (const OptionField& field : fields_) {
    if (field.key == key) return ValueOf(field);
  }
  throw InputError("unknown option " + InQuotes(key));
}

std::vector<std::string> OptionTable::Keys() const {
  std::vector<std::string> keys;
  keys.reserve(fields_.size());
  for (const OptionField& field : fields_) keys.push_back(field.key);
  return keys;
}

}  // namespace plumbline
