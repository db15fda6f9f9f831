// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/features/front_end_fingerprint.h"

#include "plumbline/base/options_io.h"

#include <set>

namespace plumbline {

FrontEndFingerprint FingerprintOf(const FeatureOptions& options) {
  FeatureOptions copy = options;
  const OptionTable table(copy);
  FrontEndFingerprint fingerprint;
  fingerprint.feature_format = kFeatureFormat;
  for (const std::string& key : table.Keys()) {
    if (key != "parallel") fingerprint.settings["features." + key] = table.Value(key);
  }
  // Maps of earlier versions, which had these as options, may have been measured with other values.
  for (const auto& [key, value] : table.fixed()) fingerprint.settings["features." + key] = value;
  return fingerprint;
}

std::vector<std::string> Differences(const FrontEndFingerprint& of_map,
                                     const FrontEndFingerprint& now) {
  std::vector<std::string> differences;
  if (of_map.feature_format == 0) return differences;
  const auto compare = [&](const std::string& what, const std::string& a, const std::string& b) {
    if (a != b) differences.push_back(what + ": " + a + " in the map, " + b + " now");
  };
  compare("format of features",
          std::to_string(of_map.feature_format),
          std::to_string(now.feature_format));
  std::set<std::string> keys;
  for (const auto* one : {&of_map, &now}) {
    for (const auto& [key, value] : one->settings) keys.insert(key);
  }
  const auto value_of = [](const FrontEndFingerprint& one, const std::string& key) {
    const auto found = one.settings.find(key);
    return found == one.settings.end() ? std::string("no such option") : found->second;
  };
  for (const std::string& key : keys) compare(key, value_of(of_map, key), value_of(now, key));
  return differences;
}

}  // namespace plumbline
