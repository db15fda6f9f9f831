// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/features/extractor.h"
#include "plumbline/initialization/options.h"
#include "plumbline/line_cutting/cutting_problem.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/mapping/options.h"
#include "plumbline/matching/line_options.h"
#include "plumbline/tracking/options.h"

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// Execution of the stages: one after the other; in threads with the same results; or live, waiting
// for mapping only at the start of a map.
enum class RunMode { kInline, kLockstep, kLive };
constexpr auto EnumNames(std::type_identity<RunMode>) {
  return std::array{std::pair{RunMode::kInline, "inline"},
                    std::pair{RunMode::kLockstep, "lockstep"},
                    std::pair{RunMode::kLive, "live"}};
}

// Execution of the stages, and the seed of all random numbers.
struct ExecutionOptions {
  RunMode mode = RunMode::kLockstep;
  int seed = 0;
  int lag = 1;
};

template <class Visitor>
void VisitFields(Visitor&& visit, ExecutionOptions& o) {
  visit("mode",
        o.mode,
        "inline: stages one after the other; lockstep: each in its own thread, same results; "
        "live: never waits for a slower stage but at the start of a map, may drop frames");
  visit("seed", o.seed, "of everything random", Range{0, 2147483647});
  visit("lag",
        o.lag,
        "frames between a keyframe and the first frame that is tracked against the map with it, "
        "beyond the next one",
        Range{0, 100});
}

// All options of a run.
struct SlamOptions {
  FeatureOptions features;
  LineOptions lines;
  CuttingOptions cutting;
  InitializationOptions initialization;
  TrackingOptions tracking;
  RelocalizationOptions relocalization;
  MappingOptions mapping;
  LoopOptions loop;
  ExecutionOptions slam;
};

// Throws InputError for a value out of its range, a method that does not exist, and if options
// contradict each other: neither points nor lines, a minimum not below its maximum (depths, frames
// between keyframes), or a residual of lines that only poses have, with a map.
void CheckOptions(const SlamOptions& options);

template <class Visitor>
void VisitFields(Visitor&& visit, SlamOptions& o) {
  visit("slam", o.slam, "how the stages run");
  visit("features", o.features, "what is measured in the images");
  visit("lines", o.lines, "how lines enter optimization");
  visit("cutting", o.cutting, "which piece of each line decides about the pose of a frame");
  visit("initialization", o.initialization, "start of a map from one camera");
  visit("tracking", o.tracking, "pose of each frame");
  visit("relocalization", o.relocalization, "finding a lost camera in its map");
  visit("mapping", o.mapping, "keyframes, landmarks, local bundle adjustment");
  visit("loop", o.loop, "places that are seen again");
}

}  // namespace plumbline
