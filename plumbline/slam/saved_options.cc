// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/saved_options.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/slam/user_options.h"

namespace plumbline {

namespace {

// Returns the value that a removed option would have with these settings.
std::string ValueOf(const RemovedOption& removed, const std::vector<RemovedSetting>& settings) {
  for (const RemovedSetting& setting : settings) {
    if (setting.key == removed.name) return setting.found;
  }
  return removed.value;
}

std::string Difference(const std::string& what, const std::string& a, const std::string& b) {
  return what + ": " + a + " in the map, " + b + " now";
}

bool IsOfFrontEnd(std::string_view key) { return key.starts_with("features."); }

}  // namespace

SlamOptions SavedOptions(const AtlasContext& context,
                         const std::string& source,
                         const std::function<void(const RemovedSetting&)>& on_removed,
                         const std::vector<AddedMethod>& added) {
  SlamOptions options;
  if (!context.options_yaml.empty()) {
    OptionTable(options, added).LoadText(context.options_yaml, source, on_removed);
  }
  return options;
}

SlamOptions SavedOptionsOrDefault(const AtlasContext& context,
                                  const std::string& source,
                                  const std::string& instead,
                                  const std::function<void(const std::string&)>& remark,
                                  const std::function<void(SlamOptions&)>& accept,
                                  const std::vector<AddedMethod>& added) {
  try {
    SlamOptions options = SavedOptions(
        context, source, [&](const RemovedSetting& removed) { remark(removed.message); }, added);
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
    if (a != b) differences.push_back(Difference(what, a, b));
  };
  compare("format of features",
          std::to_string(of_map.feature_format),
          std::to_string(now.feature_format));
  try {
    std::vector<RemovedSetting> removed_before, removed_after;
    SlamOptions before = SavedOptions(of_map, "its options", [&](const RemovedSetting& removed) {
      removed_before.push_back(removed);
    });
    SlamOptions after = SavedOptions(
        now, "options", [&](const RemovedSetting& removed) { removed_after.push_back(removed); });
    const OptionTable a(before), b(after);
    for (const std::string& key : b.Keys()) {
      const bool changes_results = key != "features.parallel";
      if (IsOfFrontEnd(key) && changes_results) compare(key, a.Value(key), b.Value(key));
    }
    for (const RemovedOption& removed : b.removed()) {
      if (!IsOfFrontEnd(removed.name)) continue;
      compare(removed.name, ValueOf(removed, removed_before), ValueOf(removed, removed_after));
    }
  } catch (const InputError& error) {
    differences.emplace_back(error.what());
  }
  return differences;
}

std::vector<std::string> SystemDifferences(const AtlasContext& of_map, const AtlasContext& now) {
  std::vector<std::string> differences;
  if (of_map.options_yaml.empty()) return differences;
  const auto pass_over = [](const RemovedSetting&) {};
  try {
    SlamOptions before = SavedOptions(of_map, "its options", pass_over);
    SlamOptions after = SavedOptions(now, "options", pass_over);
    const OptionTable a(before), b(after);
    for (const std::string& key : b.Keys()) {
      if (IsOfFrontEnd(key) || TierOf(key) != OptionTier::kPaper) continue;
      if (a.Value(key) != b.Value(key)) {
        differences.push_back(Difference(key, a.Value(key), b.Value(key)));
      }
    }
  } catch (const InputError&) {
    differences.clear();  // FrontEndDifferences tells what is not known
  }
  return differences;
}

}  // namespace plumbline
