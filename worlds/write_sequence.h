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

// Checks that a folder may and can be written to: it is made if it is missing. A rendered sequence
// in it, complete or not, stays. Throws InputError if it contains anything else, also inside the
// folders of the sequence, or cannot be written to. WriteSequence does this, too; called before the
// work of preparing a sequence, it avoids the wait.
void CheckSequenceFolder(const std::filesystem::path& folder);

// Makes a folder ready to be written to, as the first step of WriteSequence: a rendered sequence in
// it is removed. Throws like CheckSequenceFolder.
void PrepareSequenceFolder(const std::filesystem::path& folder);

// Writes a sequence as the folder of a data set. In addition to the files of the format:
// `lines.csv` (the true lines, see TrueLines), `surfaces.csv` (all static surfaces) and
// `world.yaml` (world, format and options), which is written last: a folder with it is complete.
// `progress`, if given, is called after each frame with the number of frames done, one call at a
// time. The bytes written depend on neither the machine's load nor `threads`.
//
// Throws InputError like PrepareSequenceFolder, and if a file cannot be written.
void WriteSequence(const SyntheticSequence& sequence,
                   SequenceFormat format,
                   const std::filesystem::path& folder,
                   int threads,
                   const std::function<void(int)>& progress = {});

}  // namespace plumbline
