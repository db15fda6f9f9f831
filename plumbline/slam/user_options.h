// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

// Whether an option, by its dotted key, is among those that users set: what is used, how much of
// it, what a run does when it is lost or comes back, and the choices that experiments name. The
// other options are for those who work on the methods; their defaults are measured. docs/options.md
// explains each user option by its visible effect.
bool IsUserOption(std::string_view key);

}  // namespace plumbline
