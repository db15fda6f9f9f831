// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace plumbline {

// An option whose values have names.
struct NamedField {
  std::vector<std::string> names;
  std::function<std::string()> get;
  std::function<void(const std::string&)> set;  // to one of the names
  bool is_method = false;                       // programs may have more of them (Methods)
};

// One option: the location of its value, and its description.
struct OptionField {
  using Target =
      std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*, NamedField>;

  std::string key;  // dotted, e.g. "mapping.ba.huber_px"
  std::string help;
  std::optional<Range> range;
  Target target;
};

// A removed option (options.h) that a text sets to another value than that of its constant, or a
// method that this program does not have.
struct RemovedSetting {
  std::string key;       // dotted
  std::string found;     // the value of the text
  std::string constant;  // the value that counts
  std::string message;   // the InputError of such a setting
};

// All options of a tree of option structs (options.h): read from YAML, set one by one, and written
// back. Holds pointers into the struct it was made from, which must outlive it.
//
//   SlamOptions options;
//   OptionTable table(options);
//   table.LoadFile("euroc.yaml");
//   table.Set("loop.enabled=false");
//
// Settings apply in the order of the calls; a later one replaces an earlier one. All members that
// read settings throw InputError: an unknown key (with the nearest valid one), a value of the wrong
// type, out of range or not among the choices; the message names file and line, the key, what is
// allowed and what was found. Settings before the faulty one stay applied. A removed option
// (options.h) is an InputError, too, which names what serves instead; but files and texts may set
// it to the value of its constant, so that those of earlier versions are read.
class OptionTable {
 public:
  // The program's own methods are allowed beside those of the library; those of options that T does
  // not have are passed over.
  template <OptionGroup T>
  explicit OptionTable(T& options, const std::vector<AddedMethod>& added = {}) {
    Collect("", options);
    for (const AddedMethod& method : added) Add(method);
  }

  // Reads a YAML file of nested groups (`ba: {huber_px: 2}`); dotted keys are accepted as well.
  void LoadFile(const std::filesystem::path& path);
  // Loads options from text; `source` stands for the file name in messages. With `on_removed`,
  // removed options at other values than their constants, and methods that this program does not
  // have, are told to it and passed over, in place of an InputError.
  void LoadText(const std::string& text,
                const std::string& source,
                const std::function<void(const RemovedSetting&)>& on_removed = {});
  // Applies one setting "key=value" of the command line.
  void Set(std::string_view assignment);
  // Applies one setting that the caller has parsed; messages begin with `where`, such as
  // "room.yaml:7".
  void Set(const std::string& key, const std::string& text, const std::string& where);

  // Throws InputError if a number lies outside the range of its option, or no method has the name.
  // It is for values assigned to the struct directly, which no other check covers.
  void CheckRanges() const;

  // Returns a YAML document of all options with help, range and choices as comments. LoadText
  // restores the same values from it, to the last bit.
  std::string Dump() const;
  // Returns the same document restricted to the wanted options and their groups.
  std::string Dump(const std::function<bool(const OptionField&)>& wanted) const;
  // Returns the wanted options with dotted keys, without groups. It may follow a Dump of others.
  std::string DumpDotted(const std::function<bool(const OptionField&)>& wanted) const;
  // Returns the value of one option as Dump writes it; throws InputError for an unknown key.
  std::string Value(std::string_view key) const;
  static std::string ValueOf(const OptionField& field);
  // Returns the dotted keys of all options, in the order of the structs.
  std::vector<std::string> Keys() const;
  const std::vector<OptionField>& fields() const { return fields_; }
  // Removed options, by their dotted keys.
  const std::vector<RemovedOption>& removed() const { return removed_; }

 private:
  struct Group {
    std::string key;
    std::string help;
    std::size_t first_field;  // index of its first option in fields_
  };

  struct Collector {
    OptionTable* table;
    std::string prefix;

    template <class T>
    void operator()(std::string_view name, T& value, std::string_view help) const {
      const std::string key = prefix + std::string(name);
      if constexpr (OptionGroup<T>) {
        table->groups_.push_back({key, std::string(help), table->fields_.size()});
        table->Collect(key + ".", value);
      } else {
        table->fields_.push_back({key, std::string(help), std::nullopt, TargetOf(value)});
      }
    }
    template <class T>
    void operator()(std::string_view name, T& value, std::string_view help, Range range) const {
      static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>, "a range needs a number");
      (*this)(name, value, help);
      table->fields_.back().range = range;
    }
    void operator()(std::string_view name,
                    std::string& value,
                    std::string_view help,
                    Methods methods) const {
      (*this)(name, value, help);
      table->fields_.back().target =
          NamedField{std::move(methods.names),
                     [&value] { return value; },
                     [&value](const std::string& method) { value = method; },
                     true};
    }
  };

  template <class T>
  void Collect(const std::string& prefix, T& group) {
    if constexpr (HasRemovedOptions<T>) {
      for (RemovedOption& removed : RemovedOptions(std::type_identity<T>{})) {
        removed.name = prefix + removed.name;
        removed_.push_back(std::move(removed));
      }
    }
    VisitFields(Collector{this, prefix}, group);
  }

  template <class T>
  static OptionField::Target TargetOf(T& value) {
    if constexpr (std::is_enum_v<T>) {
      NamedField field;
      for (const auto& [enumerator, name] : EnumNames(std::type_identity<T>{})) {
        field.names.emplace_back(name);
      }
      field.get = [&value] { return NameOf(value); };
      field.set = [&value](const std::string& wanted) {
        for (const auto& [enumerator, name] : EnumNames(std::type_identity<T>{})) {
          if (wanted == name) value = enumerator;
        }
      };
      return field;
    } else {
      return &value;
    }
  }

  void Add(const AddedMethod& method);
  OptionField* FindField(std::string_view key);
  bool IsGroup(std::string_view key) const;
  const RemovedOption* FindRemoved(std::string_view key) const;

  std::vector<OptionField> fields_;
  std::vector<RemovedOption> removed_;
  std::vector<Group> groups_;
};

}  // namespace plumbline
