// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"

#include <pybind11/pybind11.h>

namespace plumbline::python {

// Sets options from keyword arguments: groups are dictionaries, {"features": {"line_count": 100}};
// dotted keys mean the same. Throws the InputError of `--set KEY=VALUE`.
void SetInTable(const pybind11::dict& given, OptionTable& table);
template <OptionGroup T>
void SetOptions(const pybind11::dict& given, T& options) {
  OptionTable table(options);
  SetInTable(given, table);
}

// Arguments of a run beside the groups of options; each may be None.
struct RunArguments {
  pybind11::object preset;      // name of a preset, whose options are set first
  pybind11::object seed, mode;  // slam.seed and slam.mode, which must not be set twice
};

// Returns the options of a run, checked. Throws InputError like SetInTable, FindPreset and
// CheckOptions.
SlamOptions ReadRunOptions(const RunArguments& arguments, const pybind11::dict& given);

// The values of all options, in groups.
pybind11::dict ValuesOf(const OptionTable& table);

}  // namespace plumbline::python
