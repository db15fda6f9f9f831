// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worlds/synth_options.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace plumbline {

// Names a rendered sequence: the world and a hash of all inputs of its bytes, that is the options
// and the source code of this module: "room-0123456789abcdef". Throws InputError for an unknown
// world.
std::string SequenceKey(std::string_view world, const SynthOptions& options);

// Returns the rendered stereo sequence (EuRoC form) of a world, from the cache or made now.
//
// The folder is cache_folder / SequenceKey(). It is rendered beside it under a temporary name and
// renamed once complete, so that a folder with world.yaml is complete; remains of killed programs
// are removed. Several processes may request the same sequence at once: one of them wins, the
// others' work is discarded.
//
//   threads   used for rendering
//   progress  as in WriteSequence, called only if something is rendered; its exceptions end the
//             rendering, leave no files and are rethrown
//   returns   the folder, as written by WriteSequence
//   fails     InputError as WriteSequence, or if the folders cannot be made or renamed
std::filesystem::path CachedSequence(const std::filesystem::path& cache_folder,
                                     std::string_view world,
                                     const SynthOptions& options,
                                     int threads,
                                     const std::function<void(int)>& progress = {});

}  // namespace plumbline
