// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/loop/close_loop.h"
#include "plumbline/loop/essential_graph.h"
#include "plumbline/loop/loop_edge.h"
#include "plumbline/loop/options.h"
#include "plumbline/loop/verify_loop.h"
#include "plumbline/map/map.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// What is told of a closed loop.
struct LoopRecord {
  KeyFrameId query, candidate;
  LoopEvidence evidence;
  double drift_chi2 = 0;  // of the relative pose against what odometry says
  int merged_points = 0, merged_lines = 0;
  double largest_shift = 0;  // of a keyframe, map units
  double largest_turn = 0;   // of a keyframe, radians
  double query_scale = 1;    // of lengths around the query
};

struct LoopClosure {
  MapEdit edit;  // for the map as it was given
  LoopRecord record;
  // Earlier loops that the graph leaves out now. This has forgotten them; what they tie is to be
  // untied after the edit (OpenLoop).
  std::vector<LoopEdge> withdrawn;
};

// What became of a candidate that was looked at.
struct LoopAttempt {
  KeyFrameId query, candidate;
  std::optional<LoopRefusal> unverified;  // not the same place
  std::optional<LoopEdge> edge;           // as measured, where it is the same place
  double drift_chi2 = 0;                  // of the edge against what odometry says
  std::optional<ClosingRefusal> unclosed;
  bool beyond_drift = false;  // odometry cannot be so wrong
  bool drifted_far = false;   // it is more wrong than as a rule: one camera that turned
  bool uncertain = false;     // the edge says too little: a nearer view is to come
  bool inconsistent = false;  // the other loops say otherwise
  bool waits = false;         // for another keyframe that sees it
};

// Closes the loops of one map as it grows: verifies what an index of places proposes, holds it
// against the drift of odometry and the loops there are, and makes a correction of it.
//
// Its state are the loops that were closed, with their evidence. Deterministic; not thread-safe.
class LoopCloser {
 public:
  LoopCloser(const ImagingModel& imaging, const LoopOptions& options);

  // Looks at the candidates for the newest keyframe, best first, and returns the first loop that
  // closes. Candidates that share landmarks with the newest keyframe already, or that are not in
  // the map, are passed over. A loop is known to this from the moment that it is returned: the
  // caller applies the edit.
  //
  //   cost  VerifyLoop for each candidate, CloseLoop for those that pass
  std::optional<LoopClosure> Try(const Map& map,
                                 KeyFrameId newest,
                                 std::span<const KeyFrameId> candidates);

  // Two keyframes that are known to see the same place since their maps were joined by it: it has a
  // part in later corrections.
  void Know(const LoopEdge& edge) { loops_.push_back(edge); }

  const std::vector<LoopEdge>& loops() const { return loops_; }
  // What came of the last call of Try, by candidate that was looked at.
  const std::vector<LoopAttempt>& attempts() const { return attempts_; }

  // Takes back a loop that proved wrong: it has no part in later corrections. What it ties in the
  // map is the caller's to untie (OpenLoop). The index is that in loops().
  void Withdraw(std::size_t loop);

  // What it goes on from beside the map. Another one of the same options that is given the state
  // does what this one would do.
  struct State {
    std::vector<LoopEdge> loops;
    std::vector<LoopEdge> waiting;
    KeyFrameId last_closed;

    template <class Self, class Visitor>
    static void VisitState(Self& self, const Visitor& visit) {
      visit(self.loops, self.waiting, self.last_closed);
    }
  };
  State state() const { return {loops_, waiting_, last_closed_}; }
  void SetState(const State& state) {
    loops_ = state.loops;
    waiting_ = state.waiting;
    last_closed_ = state.last_closed;
  }

 private:
  class Drifts;

  std::vector<KeyFrameId> WorthTrying(const Map& map,
                                      KeyFrameId newest,
                                      std::span<const KeyFrameId> candidates) const;
  bool IsPausing(const Map& map, KeyFrameId newest) const;
  std::optional<LoopClosure> TryCandidate(const Map& map,
                                          KeyFrameId newest,
                                          KeyFrameId candidate,
                                          Drifts& drifts);
  std::optional<LoopClosure> Close(const Map& map,
                                   const EssentialGraph& essential,
                                   LoopAttempt& attempt);
  bool Supported(const Map& map, const EssentialGraph& essential, LoopAttempt& attempt);
  bool AgreesWithTheOthers(const Map& map,
                           const EssentialGraph& essential,
                           const PoseGraphEdge& newest,
                           OdometryWays& odometry) const;
  bool WasSaidBefore(const Map& map,
                     const EssentialGraph& essential,
                     const LoopEdge& edge,
                     const PoseGraphEdge& newest,
                     OdometryWays& odometry);
  void Wait(const LoopEdge& edge);
  std::vector<LoopEdge> Take(const LoopEdge& edge, const std::vector<bool>& earlier_kept);

  ImagingModel imaging_;
  LoopOptions options_;
  std::vector<LoopEdge> loops_;
  std::vector<LoopEdge> waiting_;  // seen by one keyframe only, the newest last
  std::vector<LoopAttempt> attempts_;
  KeyFrameId last_closed_;  // the last query that closed a loop, in whatever map it is
};

}  // namespace plumbline
