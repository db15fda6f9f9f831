// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/viewer/web_access.h"

#include "apps/command_line.h"
#include <optional>

namespace plumbline {

// Where a viewer is to listen by --view and --view-origin, nullopt where none was asked for. Who
// listens for others than this machine gets a token. InputError for what is no address or origin,
// and where the token would not be told (quiet).
std::optional<WebAccess> ReadViewOptions(const CommandLine& line, bool quiet);

}  // namespace plumbline
