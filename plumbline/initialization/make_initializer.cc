// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/make_initializer.h"

#include "plumbline/base/error.h"
#include "plumbline/initialization/klt_initializer.h"
#include "plumbline/initialization/pairwise_initializer.h"
#include "plumbline/initialization/rank1_initializer.h"
#include "plumbline/initialization/two_view.h"

namespace plumbline {

std::unique_ptr<Initializer> MakeInitializer(const CameraAndPyramid& imaging,
                                             const InitializationOptions& options,
                                             std::uint64_t seed,
                                             HelperThread* helper) {
  switch (options.method) {
    case InitializationMethod::kRank1:
      return std::make_unique<Rank1Initializer>(imaging, options, seed, helper);
    case InitializationMethod::kRank1Pairwise:
      return std::make_unique<PairwiseInitializer>(imaging, options, seed);
    case InitializationMethod::kRank1Klt:
      return std::make_unique<KltInitializer>(imaging.camera, options, seed, helper);
    case InitializationMethod::kTwoView:
      return std::make_unique<TwoViewInitializer>(imaging.camera, seed);
    case InitializationMethod::kTwoViewImages:
      return std::make_unique<TwoViewImagesInitializer>(imaging, seed, helper);
  }
  throw BugError("unknown initialization method");
}

}  // namespace plumbline
