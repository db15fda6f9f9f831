// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/viewer/web_access.h"

#include "apps/command_line.h"
#include <optional>

namespace plumbline {

// Reads the address of the viewer from --view and --view-origin; nullopt if not requested.
// Listening for other machines requires a token. Throws InputError for an invalid address or
// origin, and if the token would not be printed (quiet).
std::optional<WebAccess> ReadViewOptions(const CommandLine& line, bool quiet);

}  // namespace plumbline
