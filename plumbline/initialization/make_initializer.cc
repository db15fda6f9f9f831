// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/make_initializer.h"

#include "plumbline/base/error.h"
#include "plumbline/initialization/pairwise_initializer.h"
#include "plumbline/initialization/rank1_initializer.h"

namespace plumbline {

std::unique_ptr<Initializer> MakeInitializer(const CameraAndPyramid& imaging,
                                             const InitializationOptions& options,
                                             std::uint64_t seed,
                                             HelperThread* helper) {
  if (options.method == "rank1") {
    return std::make_unique<Rank1Initializer>(imaging, options, seed, helper);
  }
  if (options.method == "rank1_pairwise") {
    return std::make_unique<PairwiseInitializer>(imaging, options, seed);
  }
  throw BugError("unknown initialization method");
}

}  // namespace plumbline
