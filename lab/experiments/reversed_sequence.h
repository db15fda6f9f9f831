// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace plumbline {

// Name of the ground truth in the folder of a reversed sequence, in the form of TUM.
inline constexpr const char* kReversedTruth = "reversed_truth.txt";

// Writes a sequence with the images of another one from the last to the first: the lists of its
// images with other stamps, and links to all other files. Data recorded at t get the stamp
// t_first + t_last - t, and so does the ground truth, which is beside the lists (kReversedTruth) if
// the data have any. For folders of EuRoC, of KITTI and with lists as TUM's.
//
// Does nothing if `folder` exists. Throws InputError if the sequence cannot be opened or is of
// another format, std::filesystem::filesystem_error if nothing can be written.
void WriteReversedSequence(const std::filesystem::path& sequence,
                           const std::filesystem::path& folder);

}  // namespace plumbline
