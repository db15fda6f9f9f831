// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop/loop_edge.h"
#include "plumbline/loop/options.h"
#include "plumbline/loop/uncertain_pose.h"
#include "plumbline/map/map.h"
#include "plumbline/optimization/pose_graph.h"

#include <map>
#include <optional>
#include <vector>

namespace plumbline {

// The keyframe itself, or its nearest ancestor that is in the map; invalid where there is none.
KeyFrameId StandIn(const Map& map, KeyFrameId id);

// The keyframes of a map and what ties them, without landmarks: the pose graph that a loop bends.
// An edge joins a keyframe with the nearest ancestor that is in the map, and any two that share
// many landmarks; its relative pose is that of the map, its information what odometry may have
// drifted from one to the other.
struct EssentialGraph {
  std::vector<KeyFrameId> keyframes;  // by index of the pose, ascending
  PoseGraph graph;                    // the oldest keyframe is fixed

  // The index of a keyframe; -1 where it is not in the map.
  int PoseOf(KeyFrameId id) const;
};

// The drift of odometry without what a single camera that turns may lose at worst.
DriftOptions AsARule(DriftOptions drift);

// free_scale: of a single camera. O(observations).
EssentialGraph MakeEssentialGraph(const Map& map,
                                  bool free_scale,
                                  const DriftOptions& drift,
                                  int strong_covisibility);

// Divides the information of each edge by how many edges say much the same. A keyframe is tied to
// several before and after it, but what drifts from one to the next drifts for all of them: of d
// edges at each pose of a path, d (d + 2) / 8 lead from what was before to what came after. The
// path as a whole is then as stiff as odometry along single edges.
void ShareInformation(PoseGraph& graph);

// A loop as an edge of the graph, which may be wrong. Where one of its keyframes has left the map,
// the nearest ancestor that has not stands for it. nullopt where there is none or both are one.
std::optional<PoseGraphEdge> LoopAsEdge(const Map& map,
                                        const EssentialGraph& essential,
                                        const LoopEdge& loop);

// The relative poses of a graph as odometry has them: along the way with the fewest keyframes, on
// which the drift of each edge adds to that of the others. What was found out about the ways from a
// pose is kept. The graph must outlive this and stay as it is.
class OdometryWays {
 public:
  explicit OdometryWays(const PoseGraph& graph);

  // nullopt where no edges lead from one to the other. The first time that is asked from a pose
  // O(edges), then O(length of the way).
  std::optional<UncertainPose> Along(int to, int from);

 private:
  const std::vector<int>& WaysFrom(int first);

  const PoseGraph& graph_;
  std::vector<std::vector<int>> edges_of_;     // by pose
  std::map<int, std::vector<int>> ways_from_;  // by first pose: by pose the edge that leads to it
};

}  // namespace plumbline
