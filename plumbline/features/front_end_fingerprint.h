// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/extractor.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace plumbline {

// Grows whenever the code measures or describes features in another way, so that those of earlier
// versions match less well.
inline constexpr std::int32_t kFeatureFormat = 1;

// How the features of a map were measured: descriptors of different front ends do not compare.
struct FrontEndFingerprint {
  std::int32_t feature_format = 0;  // 0: not known, of a map file of version 1
  std::map<std::string, std::string>
      settings;  // by key of the option; what changes no result left out

  friend bool operator==(const FrontEndFingerprint&, const FrontEndFingerprint&) = default;
};

// The front end of features measured with these options by the code of today.
FrontEndFingerprint FingerprintOf(const FeatureOptions& options);

// What tells two front ends apart, one line each: "features.line_count: 200 in the map, 100 now".
// Empty where they are the same, or where nothing is known of that of the map.
std::vector<std::string> Differences(const FrontEndFingerprint& of_map,
                                     const FrontEndFingerprint& now);

}  // namespace plumbline
