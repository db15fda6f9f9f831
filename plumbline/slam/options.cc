// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/options.h"

#include "plumbline/base/error.h"

namespace plumbline {

void CheckOptions(const SlamOptions& options) {
  const FeatureOptions& f = options.features;
  if (!(f.points && f.point_count > 0) && !(f.lines && f.line_count > 0)) {
    throw InputError(
        "features.points, features.lines: expected at least one of them, found both off (or a "
        "count of 0)");
  }
}

}  // namespace plumbline
