// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plumbline {

// Options are plain structs. Beside each struct stands one function template
//
//   template <class Visitor>
//   void VisitFields(Visitor&& visit, LocalBaOptions& o) {
//     visit("max_iterations", o.max_iterations, "iterations per solve", Range{1, 1000});
//     visit("huber_px", o.huber_px, "Huber threshold of a residual [px]", Range{0, 100});
//   }
//
// which is the single source of the option's key, help text and allowed range: YAML reading, --set,
// `plumbline config` and checks all come from it (options_io.h). A nested group is visited as
// visit("ba", o.ba, "local bundle adjustment"). Field types: bool, int, double, std::string, enums.
// For an enum E, a function found by ADL lists the names in the order shown to users:
//
//   constexpr auto EnumNames(std::type_identity<E>) {
//     return std::array{std::pair{E::kFirst, "first"}, std::pair{E::kSecond, "second"}};
//   }
//
// A method that programs may have more of than the library is a std::string, with the names of the
// library's: visit("method", o.method, "search for the cuts", Methods{{"none", "greedy"}}).

// Returns the name of an enumerator, as EnumNames lists it.
template <class Enum>
std::string NameOf(Enum value) {
  for (const auto& [candidate, name] : EnumNames(std::type_identity<Enum>{})) {
    if (candidate == value) return name;
  }
  throw BugError("enumerator without a name");
}

// Closed interval of allowed values.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// Names of the methods of an option of type std::string.
struct Methods {
  std::vector<std::string> names;
};

// A method that a program has beside those of the library.
struct AddedMethod {
  std::string key;  // dotted, of the option that names it
  std::string name;
  std::string help;  // added to the help of the option
};

struct FieldProbe {
  template <class... Args>
  void operator()(Args&&...) const {}
};

template <class T>
concept OptionGroup = requires(T& t, FieldProbe probe) {
  VisitFields(probe, t);
};

// What was an option in an earlier version. Whoever sets it is told what serves instead. Beside a
// struct whose fields were options stands a function found by ADL:
//
//   inline std::vector<RemovedOption> RemovedOptions(std::type_identity<OrbOptions>) {
//     return {FixedAt("sigma_px", kCornerSigmaPx, "kCornerSigmaPx")};
//   }
struct RemovedOption {
  std::string name;        // "--resume", or a key in its group (dotted if the group is gone, too)
  std::string instead;     // a clause without its point
  std::string value = {};  // of a key: the value of its constant, as files have it; may be empty
};

// Returns an option that is now a constant of the code with this value and this name.
RemovedOption FixedAt(std::string_view key, double value, std::string_view constant);

// Returns the message for whoever sets it: "--resume is no option any more: <instead>".
std::string NoOptionAnyMore(const RemovedOption& removed);

template <class T>
concept HasRemovedOptions = requires {
  RemovedOptions(std::type_identity<T>{});
};

}  // namespace plumbline
