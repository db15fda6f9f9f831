// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/options.h"

#include <functional>
#include <string>
#include <vector>

namespace plumbline {

// Returns the options that decided about the results of saved maps; the default options where the
// file does not hold any. Throws InputError, which names `source`, where this version
// of the program does not know an option or a value.
SlamOptions SavedOptions(const AtlasContext& context, const std::string& source);

// Returns SavedOptions after `accept`, where given, has accepted them. Where one of the two throws
// InputError, returns the default options and tells `remark` the error and what is done instead:
// "<error>; <instead>".
SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept = {});

// Returns how the features of saved maps were measured in another way than those of others or of a
// run, one line each: "features.line_count: 200 in the map, 100 now". Empty where they were
// measured in the same way, or where nothing is known. Options of the map that this version does
// not know are one line, too.
std::vector<std::string> FrontEndDifferences(const AtlasContext& of_map, const AtlasContext& now);

}  // namespace plumbline
