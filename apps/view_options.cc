// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/view_options.h"

#include "plumbline/base/error.h"

namespace plumbline {

std::optional<WebAccess> ReadViewOptions(const CommandLine& line, bool quiet) {
  const auto address = line.Value("--view");
  if (!address) {
    if (line.Has("--view-origin")) {
      throw InputError("--view-origin: expected --view [HOST:]PORT as well");
    }
    return std::nullopt;
  }
  WebAccess access = ParseWebAddress("--view", *address);
  for (const std::string& origin : line.Values("--view-origin")) {
    access.origins.push_back(ParseWebOrigin("--view-origin", origin));
  }
  if (IsLoopback(access.host)) return access;
  if (quiet) {
    throw InputError("--view " + *address +
                     ": expected no --quiet, which would not tell the address with its token");
  }
  access.token = MakeWebToken();
  return access;
}

}  // namespace plumbline
