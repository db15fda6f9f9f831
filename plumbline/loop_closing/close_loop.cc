// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/close_loop.h"

#include "plumbline/base/ids.h"
#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/map/motion.h"
#include "plumbline/mapping/map_correction.h"
#include "plumbline/optimization/pose_graph.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

bool ShowBoth(const Observations& a, const Observations& b) {
  return std::any_of(a.begin(), a.end(), [&](const auto& seen) { return b.contains(seen.first); });
}

// Returns a landmark pair with its current ids; nullopt if it cannot be fused (any more).
template <class LandmarkId>
std::optional<LandmarkPair<LandmarkId>> Fusible(const Map& map,
                                                const LandmarkPair<LandmarkId>& pair) {
  const LandmarkPair<LandmarkId> today{map.Current(pair.in_query), map.Current(pair.in_candidate)};
  if (!today.in_query.valid() || !today.in_candidate.valid()) return std::nullopt;
  if (today.in_query == today.in_candidate) return std::nullopt;
  if (ShowBoth(map.Find(today.in_query)->observations,
               map.Find(today.in_candidate)->observations)) {
    return std::nullopt;
  }
  return today;
}

// Returns the pairs that can be fused one after the other: no landmark is in two of them.
template <class LandmarkId>
std::vector<LandmarkPair<LandmarkId>> AllFusible(const Map& map,
                                                 std::span<const LandmarkPair<LandmarkId>> pairs) {
  std::set<LandmarkId> used;
  std::vector<LandmarkPair<LandmarkId>> fusible;
  for (const auto& pair : pairs) {
    const auto today = Fusible(map, pair);
    if (!today || used.contains(today->in_query) || used.contains(today->in_candidate)) continue;
    used.insert(today->in_query);
    used.insert(today->in_candidate);
    fusible.push_back(*today);
  }
  return fusible;
}

LineModel Moved(const MapLine& line, const edit::MoveKeyFrames& motion) {
  LineModel moved = line;
  const auto of_newest = motion.new_from_old.find(line.observations.newest().first);
  if (of_newest != motion.new_from_old.end()) Move(of_newest->second, moved);
  return moved;
}

// Returns the kept line with an interval that also covers the other line's.
edit::MoveLine Covering(const MapLine& kept,
                        const MapLine& gone,
                        const edit::MoveKeyFrames& motion) {
  const LineModel to = Moved(kept, motion);
  const Segment3 other = Moved(gone, motion).Interval();
  const double a = to.line.ParameterOf(other.start);
  const double b = to.line.ParameterOf(other.end);
  return {kept.id, to.line, std::min({to.start, a, b}), std::max({to.end, a, b}), to.information};
}

// Returns the places that the solution gives the keyframes.
MapCorrection CorrectionOf(const Map& map,
                           const EssentialGraph& essential,
                           const std::vector<Similarity3>& poses) {
  MapCorrection correction;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const KeyFrameId id = essential.keyframes[i];
    // The camera's own axes are in its new scale, so that lengths around it in the world are
    // divided by that scale.
    const Similarity3& cam_from_world = poses[i];
    const Rigid3 after{cam_from_world.rotation, cam_from_world.translation / cam_from_world.scale};
    correction.keyframes[id] = {
        map.Find(id)->frame.cam_from_world, after, 1 / cam_from_world.scale};
  }
  return correction;
}

// Adds loops as edges of the graph. Returns the index of the edge for each loop, or -1.
std::vector<int> AddLoops(const Map& map,
                          const EssentialGraph& essential,
                          std::span<const LoopEdge> loops,
                          PoseGraph& graph) {
  std::vector<int> places;
  for (const LoopEdge& loop : loops) {
    const auto edge = LoopAsEdge(map, essential, loop);
    places.push_back(edge ? static_cast<int>(graph.edges.size()) : -1);
    if (edge) graph.edges.push_back(*edge);
  }
  return places;
}

// Returns a lower bound of the increase of the sum of chi2 over all believed edges by a loop. The
// sum without the loop is not solved for: that of the current poses is at least as large and
// replaces it.
double RaisedChi2(const PoseGraph& graph, std::size_t loop, const PoseGraphResult& solved) {
  const int size = graph.motion == PoseGraphMotion::kRigid ? 6 : 7;
  double raised = 0;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    raised += solved.weights[e] * solved.chi2[e];
    if (e == loop) continue;
    const Vector7d before =
        PoseGraphResidual(edge, graph.poses[Index(edge.to)], graph.poses[Index(edge.from)]);
    raised -= solved.weights[e] *
              before.head(size).dot(edge.information.topLeftCorner(size, size) * before.head(size));
  }
  return raised;
}

// The keyframes around both ends of a loop. Ids ascend in the order of time, even in maps that were
// joined.
class Ends {
 public:
  Ends(const Map& map, KeyFrameId query, KeyFrameId candidate)
      : early_end_(std::min(query, candidate)), late_end_(std::max(query, candidate)) {
    early_ = Around(map, early_end_, [&](KeyFrameId id) { return !IsLate(id); });
    late_ = Around(map, late_end_, [&](KeyFrameId id) { return IsLate(id); });
  }

  const std::set<KeyFrameId>& late() const { return late_; }

  bool IsLate(KeyFrameId id) const { return 2 * id.value >= early_end_.value + late_end_.value; }

  // Returns true if the loop fused these observations into one landmark.
  bool Ties(const Observations& seen) const {
    const auto first_late = std::find_if(
        seen.begin(), seen.end(), [&](const auto& entry) { return IsLate(entry.first); });
    if (first_late == seen.begin() || first_late == seen.end()) return false;
    const std::int64_t unseen = first_late->first.value - (first_late - 1)->first.value;
    if (2 * unseen < late_end_.value - early_end_.value) return false;
    return std::any_of(
        seen.begin(), first_late, [&](const auto& entry) { return early_.contains(entry.first); });
  }

 private:
  template <class OfThisEnd>
  static std::set<KeyFrameId> Around(const Map& map, KeyFrameId id, const OfThisEnd& of_this_end) {
    std::set<KeyFrameId> around{id};
    for (const CovisibleKeyFrame& other : Covisible(map, id)) {
      if (of_this_end(other.id)) around.insert(other.id);
    }
    return around;
  }

  KeyFrameId early_end_, late_end_;
  std::set<KeyFrameId> early_, late_;
};

template <class LandmarkId>
void AddShown(const std::vector<LandmarkId>& matches, std::set<LandmarkId>& shown) {
  for (const LandmarkId id : matches) {
    if (id.valid()) shown.insert(id);
  }
}

void Unobserve(PointId id, KeyFrameId keyframe, MapEdit& edit) {
  edit.push_back(edit::RemovePointObservation{id, keyframe});
}
void Unobserve(LineId id, KeyFrameId keyframe, MapEdit& edit) {
  edit.push_back(edit::RemoveLineObservation{id, keyframe});
}

void AddAndRefresh(MapPoint later, PointId earlier, MapEdit& edit) {
  const PointId id = later.id;
  edit.push_back(edit::AddPoint{std::move(later)});
  edit.push_back(edit::RefreshPoint{id});
  edit.push_back(edit::RefreshPoint{earlier});
}
void AddAndRefresh(MapLine later, LineId earlier, MapEdit& edit) {
  const LineId id = later.id;
  edit.push_back(edit::AddLine{std::move(later)});
  edit.push_back(edit::RefreshLine{id});
  edit.push_back(edit::RefreshLine{earlier});
}

// Splits the landmarks that the loop ties. `next` is the id of the first new landmark.
template <class LandmarkId>
void Part(const Map& map,
          const std::set<LandmarkId>& shown,
          const Ends& ends,
          LandmarkId next,
          MapEdit& edit) {
  for (const LandmarkId id : shown) {
    const auto& landmark = *map.Find(id);
    if (!ends.Ties(landmark.observations)) continue;
    auto later = landmark;
    later.id = next;
    next = LandmarkId{next.value + 1};
    later.observations = Observations();
    for (const auto& [keyframe, feature] : landmark.observations) {
      if (!ends.IsLate(keyframe)) continue;
      Unobserve(id, keyframe, edit);
      later.observations.emplace(keyframe, feature);
    }
    later.created_by = later.observations.begin()->first;
    AddAndRefresh(std::move(later), id, edit);
  }
}

}  // namespace

Expected<LoopCorrection, ClosingRefusal> CloseLoop(const Map& map,
                                                   const EssentialGraph& essential,
                                                   std::span<const LoopEdge> earlier,
                                                   const LoopEdge& newest,
                                                   const LoopOptions& options) {
  PoseGraph graph = essential.WithAllEdges();
  ShareInformation(graph);
  const std::size_t odometry = graph.edges.size();
  const std::vector<int> earlier_places = AddLoops(map, essential, earlier, graph);
  const int newest_place = AddLoops(map, essential, std::span(&newest, 1), graph).front();
  if (newest_place < 0) return ClosingRefusal::kOutOfMap;
  const PoseGraphResult solved = SolvePoseGraph(graph);
  if (!solved.converged) return ClosingRefusal::kNotSolved;
  if (solved.weights[Index(newest_place)] < 0.5) return ClosingRefusal::kContradicted;
  if (RaisedChi2(graph, Index(newest_place), solved) > options.drift.max_chi2) {
    return ClosingRefusal::kBendsOdometry;
  }
  for (std::size_t e = 0; e < odometry; ++e) {
    if (solved.chi2[e] > options.max_odometry_chi2) return ClosingRefusal::kBendsOdometry;
  }
  LoopCorrection out;
  for (const int place : earlier_places) {
    out.earlier_kept.push_back(place < 0 || solved.weights[Index(place)] >= 0.5);
  }
  out.edit = RebaseCorrection(CorrectionOf(map, essential, solved.poses), map);
  const auto& motion = std::get<edit::MoveKeyFrames>(out.edit.front());
  const MapEdit fusion = FusePairs(map, newest.points, newest.lines, motion);
  out.edit.insert(out.edit.end(), fusion.begin(), fusion.end());
  return out;
}

MapEdit FusePairs(const Map& map,
                  std::span<const LandmarkPair<PointId>> points,
                  std::span<const LandmarkPair<LineId>> lines,
                  const edit::MoveKeyFrames& motion) {
  MapEdit edit;
  for (const auto& pair : AllFusible(map, points)) {
    edit.push_back(edit::MergePoints{pair.in_candidate, pair.in_query});
    edit.push_back(edit::RefreshPoint{pair.in_candidate});
  }
  for (const auto& pair : AllFusible(map, lines)) {
    edit.push_back(Covering(*map.Find(pair.in_candidate), *map.Find(pair.in_query), motion));
    edit.push_back(edit::MergeLines{pair.in_candidate, pair.in_query});
    edit.push_back(edit::RefreshLine{pair.in_candidate});
  }
  return edit;
}

MapEdit UndoLoop(const Map& map, const LoopEdge& loop) {
  const KeyFrameId query = NearestAncestor(map, loop.query);
  const KeyFrameId candidate = NearestAncestor(map, loop.candidate);
  if (!query.valid() || !candidate.valid() || query == candidate) return {};
  const Ends ends(map, query, candidate);
  std::set<PointId> points;
  std::set<LineId> lines;
  for (const KeyFrameId id : ends.late()) {
    const Frame& frame = map.Find(id)->frame;
    AddShown(frame.points, points);
    AddShown(frame.lines, lines);
  }
  MapEdit edit;
  Part(map, points, ends, map.NextPointId(), edit);
  Part(map, lines, ends, map.NextLineId(), edit);
  return edit;
}

}  // namespace plumbline
