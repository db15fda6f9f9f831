// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/close_loop.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
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
  MapEdit edit;  // for the map that was given
  // Earlier loops that the graph now rejects. The closer has forgotten them; the caller undoes them
  // after the edit (UndoLoop).
  std::vector<LoopEdge> withdrawn;
};

// Result for one candidate.
struct LoopAttempt {
  KeyFrameId query, candidate;
  std::optional<LoopRefusal> unverified;  // reason why verification failed
  // The measured edge, if verified.
  std::optional<LoopEdge> edge;
  double drift_chi2 = 0;  // chi2 of the edge against odometry
  // Reason why the verified loop is not closed.
  std::optional<ClosingRefusal> unclosed;
  bool beyond_drift = false;  // odometry cannot have drifted so far
  // The usual drift contradicts the edge, but the worst case of a turning single camera allows it.
  bool drifted_far = false;
  // The edge is not accurate enough: a nearer view is expected.
  bool uncertain = false;
  bool inconsistent = false;  // the other loops contradict it
  // The loop waits for confirmation by another keyframe.
  bool waits = false;
};

// Closes the loops of one map as it grows: verifies the candidates of a place index, compares them
// with the drift of odometry and the known loops, and computes a correction.
//
// Its state is the closed loops, with their evidence. It also caches the strong covisibility of the
// last map. Deterministic; not thread-safe.
class LoopCloser {
 public:
  LoopCloser(const CameraAndPyramid& imaging, const LoopOptions& options);

  // Tries the candidates for the newest keyframe, best first, and returns the first loop that
  // closes. Skips candidates that already share landmarks with the newest keyframe, or that are not
  // in the map. The returned loop counts as closed at once, and the caller must apply the edit.
  //
  //   cost  VerifyLoop for each candidate; for verified ones, the essential graph once, updated by
  //         what has changed since the last time (StrongCovisibility::Follow), and CloseLoop if it
  //         agrees with odometry and the other loops
  std::optional<LoopClosure> Try(const Map& map,
                                 KeyFrameId newest,
                                 std::span<const KeyFrameId> candidates);

  // Adds an edge by which two maps were merged. It takes part in later corrections.
  void Know(const LoopEdge& edge) { loops_.push_back(edge); }

  const std::vector<LoopEdge>& loops() const { return loops_; }
  // Results of the last call of Try, one for each tried candidate.
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
  KeyFrameId last_closed_;  // last query that closed a loop, in any map
};

}  // namespace plumbline
