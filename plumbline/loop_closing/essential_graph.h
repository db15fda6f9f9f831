// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/options.h"
#include "plumbline/map/map.h"
#include "plumbline/optimization/pose_graph.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {

// Pairs of keyframes of a map that share many landmarks, updated as the map changes.
//
// The number of landmarks that a pair shares depends on the matches of these two keyframes alone,
// since a landmark is observed by exactly the keyframes that match it (Map::CheckInvariants). A
// change of one of them changes its page of the table of keyframes, but not the page of the other
// one. Pairs are therefore counted again if either of the two is in a changed page.
class StrongCovisibility {
 public:
  // strong: least number of points and lines shown by both keyframes of a pair.
  explicit StrongCovisibility(int strong) : strong_(strong) {}

  // Updates the pairs for a map. The result does not depend on earlier calls: earlier counts are
  // used only if the map has the token of the last call.
  //
  //   cost  none if no keyframe has changed; otherwise the observations of the landmarks of the
  //         keyframes of changed pages, and a visit of each pair and each page
  void Follow(const Map& map);

  // Discards all counts, so that Follow() begins anew.
  void Forget();

  // Returns the earlier keyframes that share many landmarks with a keyframe of the map, ascending.
  const std::vector<KeyFrameId>& EarlierOf(KeyFrameId id) const;

 private:
  void Drop(const std::vector<bool>& changed);
  void Take(KeyFrameId earlier, KeyFrameId later);

  int strong_;
  std::shared_ptr<const char> token_;                // Map::token() of the followed map
  std::uint64_t changes_ = 0;                        // IdTable::changes() of its keyframes
  std::vector<std::vector<KeyFrameId>> earlier_of_;  // by id
};

// Returns the keyframe itself, or its nearest ancestor in the map; an invalid id if it has none.
KeyFrameId NearestAncestor(const Map& map, KeyFrameId id);

// The keyframes of a map and their connections, without landmarks: the pose graph that a loop
// corrects. A tie connects a keyframe with its nearest ancestor in the map, and any two keyframes
// that share many landmarks. Each tie is an edge of the pose graph. Its relative pose is that of
// the map, and its information models the drift of odometry between the two keyframes. Edges are
// large, and few are needed to check a loop, so that they are made on demand.
struct EssentialGraph {
  std::vector<KeyFrameId> keyframes;      // keyframe of each pose, ascending
  std::vector<Similarity3> poses;         // cam_from_world
  std::vector<std::pair<int, int>> ties;  // indices of poses, the larger one first; ascending
  double usual_length = 0;                // mean distance of poses connected by a tie
  bool free_scale = false;
  DriftOptions drift;

  // Returns the index of a keyframe's pose; -1 if it is not in the map.
  int PoseOf(KeyFrameId id) const;
  // Returns the edge of a tie, from its smaller index to the larger one.
  PoseGraphEdge Edge(std::size_t tie) const;
  // Returns the graph with the edges of all ties, in their order. The oldest keyframe is fixed.
  PoseGraph WithAllEdges() const;
};

// Returns the usual drift of odometry, without the worst case of a single camera that turns.
DriftOptions AsARule(DriftOptions drift);

// Makes the essential graph of a map. free_scale: true for a map of a single camera. `covisible`
// must have followed the current map. Cost: that of the product of two poses for each tie.
EssentialGraph MakeEssentialGraph(const Map& map,
                                  const StrongCovisibility& covisible,
                                  bool free_scale,
                                  const DriftOptions& drift);
// Makes the essential graph of a map without a StrongCovisibility. O(observations).
EssentialGraph MakeEssentialGraph(const Map& map,
                                  bool free_scale,
                                  const DriftOptions& drift,
                                  int strong_covisibility);

// Divides the information of each edge by the number of edges that carry nearly the same
// information. A keyframe is connected to several before and after it, but the drift from one
// keyframe to the next is common to all of these edges: with d edges at each pose of a path, d (d +
// 2) / 8 edges connect the part before a place with the part after it. The path as a whole is then
// as stiff as odometry along single edges.
void ShareInformation(PoseGraph& graph);

// Returns a loop as an edge of the graph, which may be wrong. If one of its keyframes has left the
// map, its nearest ancestor in the map replaces it. Returns nullopt if it has none, or if both
// keyframes are then the same.
std::optional<PoseGraphEdge> LoopAsEdge(const Map& map,
                                        const EssentialGraph& essential,
                                        const LoopEdge& loop);

// Relative poses by odometry of the poses of a graph, along the path with the fewest keyframes, on
// which the drifts of the edges add up. The paths from a pose are cached. The graph must outlive
// this object and must not change.
class OdometryWays {
 public:
  explicit OdometryWays(const EssentialGraph& essential);

  // Returns nullopt if the poses are not connected. O(ties) for the first call with a pose, then
  // O(length of the path).
  std::optional<PoseWithCovariance> Along(int to, int from);

 private:
  const std::vector<int>& WaysFrom(int first);

  const EssentialGraph& essential_;
  std::vector<std::vector<int>> ties_of_;  // ties of each pose, ascending
  // For each first pose: the last tie on the path to each pose.
  std::map<int, std::vector<int>> ways_from_;
};

}  // namespace plumbline
