// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Name of the ground truth in the folder of a reversed sequence, in the form of TUM.
inline constexpr const char* kReversedTruth = "reversed_truth.txt";

// Writes a sequence that shows the images of another one from the last to the first: the lists of
// its images with other stamps, and links to all else. What was recorded at t has the stamp
// t_first + t_last - t, and so has the ground truth, which is beside the lists (kReversedTruth)
// where the data have any. For folders of EuRoC, of KITTI and with lists as TUM's.
//
// Does nothing where `folder` is there already. Throws InputError where the sequence cannot be
// opened or is of another format, std::filesystem::filesystem_error where nothing can be written.
void WriteReversedSequence(const std::filesystem::path& sequence,
                           const std::filesystem::path& folder);

}  // namespace plumbline
