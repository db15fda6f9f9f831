// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options_io.h"
#include "plumbline/map/saved_atlas.h"
#include "plumbline/slam/options.h"

#include <functional>
#include <string>
#include <vector>

namespace plumbline {

// Returns the options that determined the results of saved maps; the default options if the file
// has none. Options of earlier versions that were removed are passed over; those at other values
// than their constants are reported to `on_removed`, and so are methods that are neither the
// product's nor among `added`. Throws InputError, which names `source`, if no version of the
// program until this one knows an option or a value.
SlamOptions SavedOptions(const AtlasContext& context,
                         const std::string& source,
                         const std::function<void(const RemovedSetting&)>& on_removed,
                         const std::vector<AddedMethod>& added = {});

// Returns SavedOptions, after `accept` (if given) has accepted them, and reports to `remark` the
// removed options that had another value. If one of the two throws
// InputError, returns the default options and reports the error and its consequence to `remark`:
// "<error>; <instead>".
SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept = {},
                                  const std::vector<AddedMethod>& added = {});

// Returns the differences in feature extraction between saved maps and others or a run, one line
// each: "features.line_count: 200 in the map, 100 now". Empty if there are none, or if nothing is
// known. Options of the map that this version does not know are one line, too.
std::vector<std::string> FrontEndDifferences(const AtlasContext& of_map, const AtlasContext& now);

// Returns the differences of the systems in the same form: of the other options that presets set
// (OptionTier::kPaper), which decide about the kind of line, the start of a map and what frames are
// tracked against. Empty as above, and if options are not known.
std::vector<std::string> SystemDifferences(const AtlasContext& of_map, const AtlasContext& now);

}  // namespace plumbline
