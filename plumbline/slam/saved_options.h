// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/options.h"

#include <functional>
#include <string>

namespace plumbline {

// The options that decided about the results of saved maps; the default ones where the file does
// not say (version 1). Throws InputError, with `source` for a name, where this version of the
// program does not know what they say.
SlamOptions SavedOptions(const AtlasContext& context, const std::string& source);

// SavedOptions, after `accept` where it is given; where one of them throws InputError, the default
// ones, and `remark` is told the error and what is done instead: "<error>; <instead>".
SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept = {});

}  // namespace plumbline
