// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/synth_options.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace plumbline {

// Names a rendered sequence: the world and a hash of all that its bytes depend on, that is the
// options and the source code of this module: "room-0123456789abcdef". Throws InputError for an
// unknown world.
std::string SequenceKey(std::string_view world, const SynthOptions& options);

// The rendered stereo sequence (EuRoC form) of a world, from the cache or made now.
//
// The folder is cache_folder / SequenceKey(). It is rendered beside it under a temporary name and
// renamed when whole, so that what has world.yaml is whole; what killed programs left behind is
// removed. Several processes may ask for the same sequence at once: one of them wins, the others'
// work is thrown away.
//
//   threads   used for rendering
//   progress  as of WriteSequence, called only when something is rendered; what it throws ends the
//             rendering, leaves no trace and comes out here
//   returns   the folder, as WriteSequence writes it
//   fails     InputError as WriteSequence, or when the folders cannot be made or renamed
std::filesystem::path CachedSequence(const std::filesystem::path& cache_folder,
                                     std::string_view world,
                                     const SynthOptions& options,
                                     int threads,
                                     const std::function<void(int)>& progress = {});

}  // namespace plumbline
