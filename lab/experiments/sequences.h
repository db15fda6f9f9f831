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

// A sequence that is to be rendered where it is not in the cache (sequence_cache.h).
struct RenderedWorld {
  std::string world;
  SynthOptions options;
};

// A sequence to run on.
struct ExperimentSequence {
  std::string name;            // "euroc/MH_01_easy", "worlds/room"
  std::filesystem::path path;  // the folder; of a world, also when not there yet
  std::optional<RenderedWorld> rendered = std::nullopt;  // nullopt: recorded
  std::vector<std::string> arguments =
      {};                     // that plumbline run needs for it: {"--camera", "icl_nuim"}
  std::string identity = {};  // changes when lists, calibration or ground truth do, or the options
                              // of the world
  bool has_truth = false;
  std::size_t frames = 0;  // 0 for one that cannot be opened
  double megapixels = 0;   // of one image of each camera together; 0 likewise
  std::string paper = {};  // what a paper calls it
  bool part = false;       // of what the paper calls so
};

struct SequenceSources {
  std::optional<std::filesystem::path> data;  // nullopt: no recorded sequences
  std::filesystem::path cache;                // for rendered ones
  WorldSize size = WorldSize::kTest;
};

struct FoundSequences {
  std::vector<ExperimentSequence> sequences;  // in the order of the choices, then of the names
  // Patterns that nothing was found for; of those of a paper also what it calls them and where
  // they come from: "tum/rgbd_dataset_freiburg1_xyz (fr1_xyz; https://...)".
  std::vector<std::string> missing;
};

// Finds the sequences that are chosen.
//
// A recorded one is a folder in EuRoC, TUM or KITTI form, at most four levels below data/FOLDER,
// named FOLDER/<its own name>[@label]. One that cannot be opened is among them: its runs will tell
// why.
// Nothing is rendered yet. Throws InputError when the folder of the data is absent, two sequences
// have the same name, or a setting of a world is wrong.
FoundSequences FindSequences(const std::vector<SequenceChoice>& choices,
                             const SequenceSources& sources);

// Whether a name fits a pattern in which * and ? stand for any characters, / among them.
bool MatchesPattern(const std::string& name, const std::string& pattern);

}  // namespace plumbline
