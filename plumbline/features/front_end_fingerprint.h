// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/extractor.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace plumbline {

// The version of the features. It is increased whenever the code measures or describes features in
// a way that makes those of earlier versions match less well.
inline constexpr std::int32_t kFeatureFormat = 1;

// How the features of a map were measured. Descriptors of different front ends cannot be compared.
struct FrontEndFingerprint {
  std::int32_t feature_format = 0;  // 0: unknown, in a map file of version 1
  std::map<std::string, std::string>
      settings;  // by key of the option; what changes no result left out

  friend bool operator==(const FrontEndFingerprint&, const FrontEndFingerprint&) = default;
};

// Returns the front end of features that the present code measures with these options.
FrontEndFingerprint FingerprintOf(const FeatureOptions& options);

// Returns the differences of two front ends, one line each: "features.line_count: 200 in the map,
// 100 now". Empty where they are the same, or where nothing is known about that of the map.
std::vector<std::string> Differences(const FrontEndFingerprint& of_map,
                                     const FrontEndFingerprint& now);

}  // namespace plumbline
