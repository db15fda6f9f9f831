// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "worlds/sequence.h"

#include <array>
#include <filesystem>
#include <functional>
#include <type_traits>
#include <utility>

namespace plumbline {

enum class SequenceFormat {
  kEuroc,  // stereo: mav0/cam0, cam1, imu0, state_groundtruth_estimate0 at 200 Hz
  kTum,  // RGB-D of the left camera: rgb/, depth/, rgb.txt, depth.txt, groundtruth.txt, camera.yaml
};

constexpr auto EnumNames(std::type_identity<SequenceFormat>) {
  return std::array{std::pair{SequenceFormat::kEuroc, "euroc"},
                    std::pair{SequenceFormat::kTum, "tum"}};
}

// Makes sure that a folder may be written to, and can be: it is made where it is missing. A
// rendered sequence in it, whole or not, stays. Throws InputError when it holds anything else, or
// such a file lies in the folders of the sequence, or it cannot be written to. WriteSequence does
// this, too; called before the work of preparing a sequence, it saves the wait.
void CheckSequenceFolder(const std::filesystem::path& folder);

// Makes a folder ready to be written to, as WriteSequence does first: a rendered sequence in it is
// removed. Throws as CheckSequenceFolder.
void PrepareSequenceFolder(const std::filesystem::path& folder);

// Writes a sequence as the folder of a data set. Beside what the format has: `lines.csv` (the true
// lines, see TrueLines), `surfaces.csv` (all that stands still) and `world.yaml` (world, format and
// options), which is written last: a folder with it is whole. `progress`, where given, is called
// after each frame with the number of frames done, one call at a time. The bytes written depend on
// neither the machine's load nor `threads`.
//
// Throws InputError as PrepareSequenceFolder does, and when a file cannot be written.
void WriteSequence(const SyntheticSequence& sequence,
                   SequenceFormat format,
                   const std::filesystem::path& folder,
                   int threads,
                   const std::function<void(int)>& progress = {});

}  // namespace plumbline
