// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/parallel.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/options.h"
#include "plumbline/matching/projection_search.h"

#include <cstdint>
#include <memory>

namespace plumbline {

// Returns an initializer of the method in the options. `seed` seeds all its random numbers. The
// helper, if any, shares its work on images, with the same result, and must outlive it.
std::unique_ptr<Initializer> MakeInitializer(const CameraAndPyramid& imaging,
                                             const InitializationOptions& options,
                                             std::uint64_t seed,
                                             HelperThread* helper = nullptr);

}  // namespace plumbline
