// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/close_loop.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/loop_closing/strong_covisibility.h"
#include "plumbline/loop_closing/verify_loop.h"
#include "plumbline/map/map.h"
#include "plumbline/matching/projection_search.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumbline {

// A closed loop, whose edge is the last of LoopCloser::loops().
struct LoopClosure {
  MapEdit edit;  // applies to the map as it was given
  // Earlier loops that the graph leaves out now. The closer has forgotten them; the caller unties
  // what they tie after the edit (UndoLoop).
  std::vector<LoopEdge> withdrawn;
};

// The result for a candidate that was looked at.
struct LoopAttempt {
  KeyFrameId query, candidate;
  std::optional<LoopRefusal> unverified;  // why it is not taken for the same place
  // The measured edge, where it is the same place.
  std::optional<LoopEdge> edge;
  double drift_chi2 = 0;  // chi2 of the edge against odometry
  // Why the verified loop is not closed.
  std::optional<ClosingRefusal> unclosed;
  bool beyond_drift = false;  // odometry cannot have drifted so far
  // The usual drift contradicts the edge, but one camera that turned may have drifted so far.
  bool drifted_far = false;
  // The edge is not accurate enough: a nearer view is expected.
  bool uncertain = false;
  bool inconsistent = false;  // the other loops contradict it
  // The loop waits for another keyframe that confirms it.
  bool waits = false;
};

// Closes the loops of one map as it grows. It verifies the candidates that an index of places
// proposes, compares them with the drift of odometry and the loops there are, and makes a
// correction.
//
// Its state is the loops that were closed, with their evidence. It also keeps which keyframes of
// the last map share many landmarks, which follows from the map. Deterministic; not thread-safe.
class LoopCloser {
 public:
  LoopCloser(const CameraAndPyramid& imaging, const LoopOptions& options);

  // Looks at the candidates for the newest keyframe, best first, and returns the first loop that
  // closes. Candidates that share landmarks with the newest keyframe already, or that are not in
  // the map, are passed over. The returned loop counts as closed at once, and the caller has to
  // apply the edit.
  //
  //   cost  VerifyLoop for each candidate; for those that pass, the essential graph once, of which
  //         only what has changed since the last time is counted (StrongCovisibility::Follow), and
  //         CloseLoop where odometry and the other loops agree
  std::optional<LoopClosure> Try(const Map& map,
                                 KeyFrameId newest,
                                 std::span<const KeyFrameId> candidates);

  // Adds an edge by which two maps were joined. It takes part in later corrections.
  void Know(const LoopEdge& edge) { loops_.push_back(edge); }

  const std::vector<LoopEdge>& loops() const { return loops_; }
  // The results of the last call of Try, one for each candidate that was looked at.
  const std::vector<LoopAttempt>& attempts() const { return attempts_; }

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

  CameraAndPyramid imaging_;
  LoopOptions options_;
  StrongCovisibility covisible_;
  std::vector<LoopEdge> loops_;
  std::vector<LoopEdge> waiting_;  // loops seen by one keyframe only, the newest last
  std::vector<LoopAttempt> attempts_;
  KeyFrameId last_closed_;  // the last query that closed a loop, in whatever map it is
};

}  // namespace plumbline
