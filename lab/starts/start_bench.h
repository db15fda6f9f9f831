// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_trial.h"
#include "plumbline/base/options.h"
#include "plumbline/features/extractor.h"
#include "plumbline/initialization/initializer.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/matching/projection_search.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace plumbline {

// The options of a run that affect a start.
struct StartOptions {
  FeatureOptions features;
  InitializationOptions initialization;
};

template <class Visitor>
void VisitFields(Visitor&& visit, StartOptions& o) {
  visit("features", o.features, "what is measured in the images");
  visit("initialization", o.initialization, "start of a monocular map");
}

// Starts to try, and criteria of right ones.
struct StartPlan {
  std::vector<int> frames;  // first frames, ascending
  double seconds = 2;       // of video until there must be a map
  double patience = 6;      // of video until the attempt ends, at least `seconds`
  StartLimits limits;
  std::optional<Trajectory> poses = std::nullopt;                          // as of SequenceTruth
  std::function<void(const StartRecord&, const InitialMap&)> on_map = {};  // as of StartTask
};

// Returns every `every`-th frame from `from` on that has a successor.
std::vector<int> EveryStart(std::size_t frames, int from, int every);

// Returns the frames from `first` on taken at most `patience` later; those taken at most `seconds`
// later are in time.
StartRange RangeOf(const Dataset& dataset, int first, double seconds, double patience);

// Makes an initializer without frames.
using InitializerFactory = std::function<std::unique_ptr<Initializer>(const CameraAndPyramid&)>;

struct StartResults {
  std::vector<StartRecord> records;  // one for each start
  std::vector<double> add_ms;        // of every frame offered
};

// Tries all starts of a sequence, one after the other. Features are extracted once for each frame,
// however many starts use it; frames are kept while a start may need them.
//
//   mono       the sequence as monocular
//   camera     as DatasetOptions::camera, for the truth
//   progress   after each start; false ends the bench
//   fails      InputError as FrontEnd and SequenceTruth
StartResults RunStarts(const Dataset& mono,
                       const std::optional<std::string>& camera,
                       const StartOptions& options,
                       const StartPlan& plan,
                       const InitializerFactory& make_initializer,
                       const std::function<bool(std::size_t done)>& progress = {});

}  // namespace plumbline
