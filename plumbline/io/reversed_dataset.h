// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/dataset.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace plumbline {

// Returns frames of a recorded sequence as a data set that plays them from the last to the first.
//
// Time still runs forward: a frame recorded at t is played at t_first + t_last - t, with t_first
// and t_last of the chosen frames. The same span is thus played with the same intervals in the
// opposite order. All poses of the ground truth, even outside the span, are stamped in the same way
// and stay with their images. DatasetInfo::time_mirror_ns is t_first + t_last; the same reflection
// leads back to the stamps of the recording.
//
//   frames    indices in the data set, ascending, at least one
//   fails     InputError for a video, which can only be read in its order; other errors are those
//             of the data set
//
// Cost: that of reading the frames.
std::unique_ptr<Dataset> PlayedBackwards(std::unique_ptr<Dataset> recorded,
                                         std::vector<std::size_t> frames);

}  // namespace plumbline
