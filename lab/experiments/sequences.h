// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/experiment.h"
#include "worlds/synth_options.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// A sequence to render if it is not in the cache (sequence_cache.h).
struct RenderedWorld {
  std::string world;
  SynthOptions options;
};

// A sequence to run on.
struct ExperimentSequence {
  std::string name;            // "euroc/MH_01_easy", "worlds/room"
  std::filesystem::path path;  // folder; that of a world may not exist yet
  std::optional<RenderedWorld> rendered = std::nullopt;  // nullopt: recorded
  std::vector<std::string> arguments = {};  // required by plumbline run: {"--camera", "icl_nuim"}
  // changes with lists, calibration or ground truth, or with the options of the world
  std::string identity = {};
  bool has_truth = false;
  std::size_t frames = 0;  // 0 if it cannot be opened
  double megapixels = 0;   // of one image of each camera together; 0 if it cannot be opened
  std::string paper = {};  // name in a paper
  bool part = false;       // true for a part of the paper's sequence
};

struct SequenceSources {
  std::optional<std::filesystem::path> data;  // nullopt: no recorded sequences
  std::filesystem::path cache;                // for rendered ones
  WorldSize size = WorldSize::kTest;
};

struct FoundSequences {
  std::vector<ExperimentSequence> sequences;  // in the order of the choices, then of the names
  // Patterns without a sequence; for those of a paper also the paper's name and the source:
  // "tum/rgbd_dataset_freiburg1_xyz (fr1_xyz; https://...)".
  std::vector<std::string> missing;
};

// Finds the chosen sequences.
//
// A recorded one is a folder in EuRoC, TUM or KITTI form, at most four levels below data/FOLDER,
// named FOLDER/<its own name>[@label]. Unreadable ones are included: their runs will report the
// reason. Nothing is rendered yet. Throws InputError if the folder of the data is missing, two
// sequences have the same name, or a setting of a world is wrong.
FoundSequences FindSequences(const std::vector<SequenceChoice>& choices,
                             const SequenceSources& sources);

// Returns true if a name matches a pattern in which * and ? stand for any characters, including /.
bool MatchesPattern(const std::string& name, const std::string& pattern);

}  // namespace plumbline
