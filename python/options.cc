// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include "plumbline/base/error.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/options_without_effect.h"
#include "plumbline/slam/preset.h"
#include "plumbline/slam/user_options.h"
#include "worlds/world.h"

#include "arrays.h"
#include "bindings.h"
#include "texts.h"
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// Groups in groups; deeper dictionaries are a slip, or hold themselves.
constexpr int kDeepest = 16;

// The value as one writes it behind --set KEY=.
std::string TextOf(const std::string& key, py::handle value) {
  // A number of numpy's becomes one of Python's.
  if (!py::isinstance<py::array>(value) && py::hasattr(value, "item") &&
      py::hasattr(value, "dtype")) {
    return TextOf(key, value.attr("item")());
  }
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return ReadText(value, key);
  if (py::isinstance<py::int_>(value)) return py::str(value).cast<std::string>();
  if (py::isinstance<py::float_>(value)) return py::repr(value).cast<std::string>();
  throw InputError(key + ": expected a number, True, False, a text or a dictionary, found " +
                   Describe(value));
}

void SetAll(const py::dict& options, const std::string& prefix, int depth, OptionTable& table) {
  for (const auto& [name, value] : options) {
    if (!py::isinstance<py::str>(name)) {
      throw InputError((prefix.empty() ? "options" : prefix) +
                       ": expected names of options, found " + Describe(name));
    }
    const std::string key = prefix + ReadText(name, prefix.empty() ? "options" : prefix);
    if (py::isinstance<py::dict>(value)) {
      if (depth == kDeepest) {
        throw InputError(key + ": expected at most " + std::to_string(kDeepest) +
                         " dictionaries one in the other, found more");
      }
      SetAll(py::reinterpret_borrow<py::dict>(value), key + ".", depth + 1, table);
    } else {
      table.Set(key + "=" + TextOf(key, value));
    }
  }
}

struct ToPython {
  template <class T>
  py::object operator()(const T* value) const {
    return py::cast(*value);
  }
  py::object operator()(const NamedField& field) const { return py::cast(field.get()); }
};

py::dict GroupOf(py::dict values, const std::string& key) {
  std::size_t from = 0;
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', from)) {
    const py::str name = key.substr(from, dot - from);
    if (!values.contains(name)) values[name] = py::dict();
    values = values[name];
    from = dot + 1;
  }
  return values;
}

py::dict OptionsOfRun(const RunArguments& arguments, const py::kwargs& given) {
  SlamOptions options = ReadRunOptions(arguments, given);
  return ValuesOf(OptionTable(options));
}

// Returns true if an option of the group slam is given by its dotted key or in a dictionary.
bool IsGiven(const py::dict& given, const char* name) {
  if (given.contains("slam." + std::string(name))) return true;
  return given.contains("slam") && py::isinstance<py::dict>(given["slam"]) &&
         given["slam"].contains(name);
}

std::string HelpOfOptions() {
  SlamOptions options;
  return ListOptions(OptionTable(options));
}

}  // namespace

void SetInTable(const py::dict& given, OptionTable& table) { SetAll(given, "", 0, table); }

py::dict ValuesOf(const OptionTable& table) {
  py::dict values;
  for (const OptionField& field : table.fields()) {
    const py::str name = field.key.substr(field.key.rfind('.') + 1);
    GroupOf(values, field.key)[name] = std::visit(ToPython(), field.target);
  }
  return values;
}

SlamOptions ReadRunOptions(const RunArguments& arguments, const py::dict& given) {
  SlamOptions options;
  OptionTable table(options);
  if (!arguments.preset.is_none()) {
    if (!py::isinstance<py::str>(arguments.preset)) {
      throw InputError("preset: expected a name, found " + Describe(arguments.preset));
    }
    LoadPreset(arguments.preset.cast<std::string>(), table);
  }
  const SlamOptions unset = options;
  py::dict all = given.attr("copy")();
  for (const auto& [name, value] : {std::pair{"seed", arguments.seed}, {"mode", arguments.mode}}) {
    if (value.is_none()) continue;
    if (IsGiven(given, name)) {
      throw InputError(fmt::format("{0}: expected it once, found slam.{0} as well", name));
    }
    all[py::str("slam." + std::string(name))] = value;
  }
  SetInTable(all, table);
  CheckOptions(options);
  for (const std::string& note : OptionsWithoutEffect(options, DifferentOptions(unset, options))) {
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  }
  return options;
}

void BindOptions(py::module_& module) {
  module.def(
      "options",
      [](const py::object& seed,
         const py::object& mode,
         const py::object& preset,
         const py::kwargs& given) {
        return OptionsOfRun({preset, seed, mode}, given);
      },
      py::arg("seed") = py::none(),
      py::arg("mode") = py::none(),
      py::arg("preset") = py::none(),
      R"(options(seed=None, mode=None, preset=None, **options) -> dict

All options of a run in groups, as `System` and `run` take them:
options()["features"]["line_count"]. preset="rippl" or "good-line-cutting" takes the options of a paper first; seed
and mode are slam.seed and slam.mode. Options that are given are checked and take the place of the
defaults. Raises InputError with the program's message. A UserWarning names options without effect,
and the option that leaves them so.)");
  module.def(
      "_preset_sensor",
      [](const std::string& name) { return FindPreset(name).needs_stereo ? "stereo" : "mono"; },
      "The sensor that a preset is made for.");
  module.def("describe_options",
             HelpOfOptions,
             R"(describe_options() -> str

All options of a run with default, meaning, unit and range, as YAML
(what `plumbline config --all` prints).)");
}

}  // namespace plumbline::python
