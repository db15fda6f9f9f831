// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/initialization/options.h"

#include <cstdint>
#include <memory>

namespace plumbline {

// Returns an initializer of the method that the options name. `seed` seeds all its random numbers.
std::unique_ptr<Initializer> MakeInitializer(const ImagingModel& imaging,
                                             const InitializationOptions& options,
                                             std::uint64_t seed);

}  // namespace plumbline
