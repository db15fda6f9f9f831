// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

// Returns true if an option, by its dotted key, is a user option: methods, amounts, behaviour when
// a run is lost or returns, and the choices named by experiments. The other options are for
// developers of the methods; their defaults are measured. docs/options.md explains each user option
// by its visible effect.
bool IsUserOption(std::string_view key);

}  // namespace plumbline
