// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/frame.h"

namespace plumbline {

std::shared_ptr<const IndexedFeatures> WithCorrection(
    const std::shared_ptr<const IndexedFeatures>& indexed, const StereoCorrection& correction) {
  if (indexed->correction == correction) return indexed;
  auto corrected = std::make_shared<IndexedFeatures>(*indexed);
  Correct(indexed->correction, correction, corrected->features);
  corrected->correction = correction;
  return corrected;
}

}  // namespace plumbline
