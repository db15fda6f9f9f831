// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options_io.h"

#include <string>
#include <string_view>

namespace plumbline {

// Who sets an option.
enum class OptionTier {
  // What is used, how much of it, what a run does when it is lost or comes back, and what comes
  // out. docs/options.md explains each of them by its visible effect.
  kUser,
  kMethod,  // what a rare sensor or a measurement asks for; the defaults are measured
  kPaper,   // what the presets of the papers, their experiments and controls set
};

// Returns the tier of an option by its dotted key.
OptionTier TierOf(std::string_view key);

// Returns all options as `plumbline config --all` prints them: those of users and methods in
// groups, then those of the papers with dotted keys, under a heading. LoadText restores the same
// values from it.
std::string ListOptions(const OptionTable& table);

}  // namespace plumbline
