// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/map_merge.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/loop_closing/close_loop.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/loop_closing/pairwise_consistency.h"
#include "plumbline/loop_closing/place_index.h"
#include "plumbline/loop_closing/verify_loop.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/local_mapper.h"
#include "plumbline/slam/atlas_places.h"
#include "plumbline/slam/map_join.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <set>
#include <span>

namespace plumbline {
namespace {

// Candidates of the first map that each keyframe of the second is compared with.
constexpr std::size_t kCandidates = 3;
constexpr std::size_t kMostEdges = 40;
constexpr std::size_t kFewestQueries = 2;

// Returns all places of a list in an order of which every first part is spread over the list.
std::vector<std::size_t> SpreadOrder(std::size_t size) {
  std::vector<std::size_t> order;
  if (size > 0) order.push_back(0);
  for (std::size_t step = std::bit_floor(size); step > 0; step /= 2) {
    for (std::size_t i = step; i < size; i += 2 * step) order.push_back(i);
  }
  return order;
}

std::vector<KeyFrameId> KeyFramesOf(const Map& map) {
  std::vector<KeyFrameId> ids;
  for (const auto& [id, keyframe] : map.keyframes()) ids.push_back(id);
  return ids;
}

std::size_t Queries(std::span<const LoopEdge> edges) {
  std::set<KeyFrameId> queries;
  for (const LoopEdge& edge : edges) queries.insert(edge.query);
  return queries.size();
}

// Edges, split into those that were chosen and the others.
struct Parts {
  std::vector<LoopEdge> chosen, others;
};
Parts Divide(const std::vector<LoopEdge>& edges, const std::vector<int>& chosen) {
  Parts parts;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool is_chosen =
        std::find(chosen.begin(), chosen.end(), static_cast<int>(i)) != chosen.end();
    (is_chosen ? parts.chosen : parts.others).push_back(edges[i]);
  }
  return parts;
}

// Returns the largest set of edges that agree. `map` has both ends of all edges, and nothing but
// the edges ties the one end to the other.
Parts Agreeing(const Map& map,
               const std::vector<LoopEdge>& edges,
               bool free_scale,
               const LoopOptions& options) {
  const EssentialGraph essential =
      MakeEssentialGraph(map, free_scale, AsARule(options.drift), options.strong_covisibility);
  std::vector<PoseGraphEdge> loops;
  for (const LoopEdge& edge : edges) loops.push_back(*LoopAsEdge(map, essential, edge));
  OdometryWays odometry(essential);
  std::vector<std::vector<bool>> agree(edges.size(), std::vector<bool>(edges.size(), true));
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      agree[i][j] = CycleChi2(odometry, loops[i], loops[j]) <= options.drift.max_chi2;
      agree[j][i] = agree[i][j];
    }
  }
  return Divide(edges, LargestConsistentSet(agree));
}

// Returns the edges on which the merge rests, the surest first; or why the maps stay two.
Expected<std::vector<LoopEdge>, MergeRefusal> Judged(const Atlas& atlas,
                                                     const std::vector<LoopEdge>& edges,
                                                     bool free_scale,
                                                     const LoopOptions& options) {
  if (Queries(edges) < kFewestQueries) return MergeRefusal::kNoOverlap;
  Atlas trial = atlas;
  JoinMaps(edges.front(), trial);
  Parts parts = Agreeing(trial.active(), edges, free_scale, options);
  if (Queries(parts.chosen) < kFewestQueries) return MergeRefusal::kNoOverlap;
  const Parts rivals = Agreeing(trial.active(), parts.others, free_scale, options);
  if (2 * Queries(rivals.chosen) >= Queries(parts.chosen)) return MergeRefusal::kAmbiguous;
  std::stable_sort(
      parts.chosen.begin(), parts.chosen.end(), [](const LoopEdge& a, const LoopEdge& b) {
        return a.evidence.log10_chance < b.evidence.log10_chance;
      });
  return std::move(parts.chosen);
}

// Bends the joined map so that all edges hold, and fuses the landmarks that they pair.
bool Bend(const std::vector<LoopEdge>& edges,
          bool free_scale,
          const LoopOptions& options,
          Map& map) {
  const auto bent = CloseLoop(
      map,
      MakeEssentialGraph(map, free_scale, AsARule(options.drift), options.strong_covisibility),
      std::span(edges).subspan(1),
      edges.front(),
      options);
  if (!bent) return false;
  map.Apply(bent->edit);
  for (const LoopEdge& edge : std::span(edges).subspan(1)) {
    map.Apply(FusePairs(map, edge.points, edge.lines));
  }
  return true;
}

// Returns the keyframe of `others` that shares most landmarks with a given keyframe; nullopt if
// none shares enough.
std::optional<KeyFrameId> ClosestAmong(const std::set<KeyFrameId>& others,
                                       const Map& map,
                                       KeyFrameId id,
                                       int min_shared) {
  std::optional<KeyFrameId> closest;
  int most = 0;
  for (const auto& covisible : Covisible(map, id, min_shared)) {
    if (covisible.shared <= most || !others.contains(covisible.id)) continue;
    most = covisible.shared;
    closest = covisible.id;
  }
  return closest;
}

// Fuses and adjusts around every keyframe of the second map that shows the same place as a keyframe
// of the first. It goes through them forwards and backwards, since each connected keyframe makes
// its neighbours share landmarks. Returns the number of connected keyframes.
int TieAll(const std::set<KeyFrameId>& of_first,
           std::vector<KeyFrameId> of_second,
           int min_shared,
           LocalMapper& mapper,
           Map& map) {
  std::set<KeyFrameId> tied;
  for (int pass = 0; pass < 2; ++pass) {
    for (const KeyFrameId id : of_second) {
      if (tied.contains(id)) continue;
      const auto older = ClosestAmong(of_first, map, id, min_shared);
      if (!older) continue;
      mapper.AdjustLoopNeighbourhood(map, id, *older);
      tied.insert(id);
    }
    std::reverse(of_second.begin(), of_second.end());
  }
  return static_cast<int>(tied.size());
}

}  // namespace

std::vector<LoopEdge> FindOverlap(const Map& first,
                                  const Map& second,
                                  const CameraAndPyramid& imaging,
                                  const LoopVerificationOptions& options) {
  PlaceIndex places;
  for (const auto& [id, keyframe] : first.keyframes()) places.Add(id, keyframe.frame.features());
  const std::vector<KeyFrameId> queries = KeyFramesOf(second);
  std::vector<LoopEdge> edges;
  for (const std::size_t i : SpreadOrder(queries.size())) {
    if (edges.size() >= kMostEdges) break;
    const Features& features = second.Find(queries[i])->frame.features();
    for (const KeyFrameId candidate : MostAlike(places, first, features, kCandidates)) {
      const auto edge = VerifyLoop(second, queries[i], first, candidate, imaging, options);
      if (edge) edges.push_back(*edge);
    }
  }
  return edges;
}

Expected<MergedMaps, MergeRefusal> MergeMaps(const Atlas& atlas,
                                             MapId first,
                                             MapId second,
                                             const CameraAndPyramid& imaging,
                                             const SlamOptions& options,
                                             const SystemMethods& methods) {
  PLUMBLINE_CHECK(atlas.Find(first) != nullptr && atlas.Find(second) != nullptr && first < second,
                  "maps to be merged, the older one first");
  const bool free_scale = !KnowsUnitOfLength(imaging.camera);
  const Map& of_first = *atlas.Find(first);
  const Map& of_second = *atlas.Find(second);
  const auto overlap = Judged(atlas,
                              FindOverlap(of_first, of_second, imaging, options.loop.verification),
                              free_scale,
                              options.loop);
  if (!overlap) return overlap.error();
  MergedMaps merged{atlas, {}, *overlap};
  merged.first_from_second = CandidateWorldFromQueryWorld(of_second, of_first, overlap->front());
  JoinMaps(overlap->front(), merged.atlas);
  Map& map = merged.atlas.active();
  if (!Bend(*overlap, free_scale, options.loop, map)) return MergeRefusal::kContradicted;
  const std::vector<KeyFrameId> ids = KeyFramesOf(of_first);
  LocalMapper mapper(imaging, methods.Lines(options.lines), options.mapping);
  merged.ties = TieAll(
      {ids.begin(), ids.end()}, KeyFramesOf(of_second), options.loop.min_shared, mapper, map);
  mapper.Finish(map);
  return merged;
}

}  // namespace plumbline
