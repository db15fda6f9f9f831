// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"

namespace plumbline {

SlamOptions SavedOptions(const AtlasContext& context, const std::string& source) {
  SlamOptions options;
  if (!context.options_yaml.empty()) {
    OptionTable(options).LoadText(context.options_yaml, source);
  }
  return options;
}

SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept) {
  try {
    SlamOptions options = SavedOptions(context, source);
    if (accept) accept(options);
    return options;
  } catch (const InputError& error) {
    remark(std::string(error.what()) + "; " + instead);
    return {};
  }
}

std::vector<std::string> FrontEndDifferences(const AtlasContext& of_map, const AtlasContext& now) {
  std::vector<std::string> differences;
  if (of_map.feature_format == 0 || now.feature_format == 0) return differences;
  const auto compare = [&](const std::string& what, const std::string& a, const std::string& b) {
    if (a != b) differences.push_back(what + ": " + a + " in the map, " + b + " now");
  };
  compare("format of features",
          std::to_string(of_map.feature_format),
          std::to_string(now.feature_format));
  try {
    SlamOptions before = SavedOptions(of_map, "its options"), after = SavedOptions(now, "options");
    const OptionTable a(before), b(after);
    for (const std::string& key : b.Keys()) {
      const bool changes_results = key != "features.parallel";
      if (key.starts_with("features.") && changes_results) compare(key, a.Value(key), b.Value(key));
    }
  } catch (const InputError& error) {
    differences.emplace_back(error.what());
  }
  return differences;
}

}  // namespace plumbline
