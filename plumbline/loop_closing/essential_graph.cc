// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/essential_graph.h"

#include "plumbline/base/ids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <queue>
#include <utility>

#include <Eigen/Cholesky>

namespace plumbline {
namespace {

// Returns the pairs of poses that are tied, each once, with the larger index first, ascending.
std::vector<std::pair<int, int>> TiesOf(const Map& map,
                                        const std::vector<KeyFrameId>& keyframes,
                                        const StrongCovisibility& covisible) {
  if (keyframes.empty()) return {};
  std::vector<int> pose_of(static_cast<std::size_t>(keyframes.back().value) + 1, -1);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    pose_of[static_cast<std::size_t>(keyframes[i].value)] = static_cast<int>(i);
  }
  std::vector<std::pair<int, int>> strong, with_parents, ties;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const int pose = static_cast<int>(i);
    for (const KeyFrameId earlier : covisible.EarlierOf(keyframes[i])) {
      strong.emplace_back(pose, pose_of[static_cast<std::size_t>(earlier.value)]);
    }
    const KeyFrameId parent = NearestAncestor(map, map.Find(keyframes[i])->parent);
    if (!parent.valid() || parent == keyframes[i]) continue;
    const int other = pose_of[static_cast<std::size_t>(parent.value)];
    with_parents.emplace_back(std::max(pose, other), std::min(pose, other));
  }
  std::sort(with_parents.begin(), with_parents.end());
  with_parents.erase(std::unique(with_parents.begin(), with_parents.end()), with_parents.end());
  ties.reserve(strong.size() + with_parents.size());
  std::set_union(strong.begin(),
                 strong.end(),
                 with_parents.begin(),
                 with_parents.end(),
                 std::back_inserter(ties));
  return ties;
}

// Returns the mean distance of the poses that a tie joins.
double UsualLength(const EssentialGraph& essential) {
  std::vector<Similarity3> inverses;
  inverses.reserve(essential.poses.size());
  for (const Similarity3& pose : essential.poses) inverses.push_back(Inverse(pose));
  const auto count = static_cast<double>(essential.ties.size());
  double length = 0;
  for (const auto& [to, from] : essential.ties) {
    length += (essential.poses[Index(to)] * inverses[Index(from)]).translation.norm() / count;
  }
  return length;
}

// Returns the information of a relative pose that odometry has. `step` is the usual distance
// between keyframes.
Matrix7d DriftInformation(const Similarity3& motion,
                          double step,
                          bool free_scale,
                          const DriftOptions& drift) {
  constexpr double kLeastStep = 0.2;  // relative to the usual step
  const double angle = LogSo3(motion.rotation).norm();
  const double rotation =
      drift.rotation_deg * std::numbers::pi / 180 + drift.rotation_per_turn * angle;
  const double translation =
      drift.translation_per_distance * (motion.translation.norm() + kLeastStep * step);
  Matrix7d information = Matrix7d::Zero();
  information.diagonal().head<3>().setConstant(1 / (rotation * rotation));
  information.diagonal().segment<3>(3).setConstant(1 / (translation * translation));
  const double turned = drift.log_scale_per_turn * angle;
  const double log_scale_variance = drift.log_scale * drift.log_scale + turned * turned;
  if (free_scale) information(6, 6) = 1 / log_scale_variance;
  return information;
}

Matrix7d CovarianceOf(const PoseGraphEdge& edge) {
  const Eigen::Index size = edge.information(6, 6) > 0 ? 7 : 6;
  Matrix7d covariance = Matrix7d::Zero();
  covariance.topLeftCorner(size, size) = edge.information.topLeftCorner(size, size)
                                             .ldlt()
                                             .solve(Eigen::MatrixXd::Identity(size, size));
  return covariance;
}

constexpr std::size_t kIdsOfPage = IdTable<KeyFrameId, KeyFrame>::kPage;

std::size_t PlaceOf(KeyFrameId id) { return static_cast<std::size_t>(id.value); }
std::size_t PageOf(KeyFrameId id) { return PlaceOf(id) / kIdsOfPage; }

// Counts the landmarks that keyframes share, one keyframe after the other.
class PairCounter {
 public:
  PairCounter(const Map& map, std::size_t ids) : map_(map), shared_(ids, 0) {}

  // Returns the other keyframes before `end` that share at least `strong` landmarks with a
  // keyframe, ascending.
  std::vector<KeyFrameId> StrongBefore(KeyFrameId end, const KeyFrame& keyframe, int strong) {
    Count(end, keyframe.frame.points);
    Count(end, keyframe.frame.lines);
    std::vector<KeyFrameId> found;
    for (const KeyFrameId other : touched_) {
      if (shared_[PlaceOf(other)] >= strong && other != keyframe.id) found.push_back(other);
      shared_[PlaceOf(other)] = 0;
    }
    touched_.clear();
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  template <class LandmarkId>
  void Count(KeyFrameId end, const std::vector<LandmarkId>& matches) {
    for (const LandmarkId match : matches) {
      if (!match.valid()) continue;
      for (const auto& [other, feature] : map_.Find(match)->observations) {
        if (!(other < end)) break;
        if (shared_[PlaceOf(other)]++ == 0) touched_.push_back(other);
      }
    }
  }

  const Map& map_;
  std::vector<int> shared_;          // landmarks shared with the present keyframe, by id
  std::vector<KeyFrameId> touched_;  // keyframes whose entry in shared_ is not zero
};

// Returns which pages have changed since the table had made so many changes. A page without
// keyframes counts as changed.
std::vector<bool> ChangedPages(const IdTable<KeyFrameId, KeyFrame>& keyframes,
                               std::uint64_t changes) {
  std::vector<bool> changed(keyframes.page_count());
  for (std::size_t page = 0; page < changed.size(); ++page) {
    const std::uint64_t last = keyframes.PageChanged(page);
    changed[page] = last == 0 || last > changes;
  }
  return changed;
}

// Returns the first id after all pages that have not changed.
KeyFrameId EndOfUnchanged(const std::vector<bool>& changed) {
  std::size_t page = changed.size();
  while (page > 0 && changed[page - 1]) --page;
  return KeyFrameId{static_cast<std::int64_t>(page * kIdsOfPage)};
}

}  // namespace

KeyFrameId NearestAncestor(const Map& map, KeyFrameId id) {
  while (id.valid() && map.Find(id) == nullptr) id = map.ParentOf(id);
  return id;
}

int EssentialGraph::PoseOf(KeyFrameId id) const {
  const auto place = std::lower_bound(keyframes.begin(), keyframes.end(), id);
  if (place == keyframes.end() || *place != id) return -1;
  return static_cast<int>(place - keyframes.begin());
}

PoseGraphEdge EssentialGraph::Edge(std::size_t tie) const {
  PoseGraphEdge edge;
  edge.to = ties[tie].first;
  edge.from = ties[tie].second;
  edge.to_from = poses[Index(edge.to)] * Inverse(poses[Index(edge.from)]);
  edge.information =
      DriftInformation(edge.to_from, std::max(usual_length, 1e-9), free_scale, drift);
  return edge;
}

PoseGraph EssentialGraph::WithAllEdges() const {
  PoseGraph graph;
  graph.motion = free_scale ? PoseGraphMotion::kSimilarity : PoseGraphMotion::kRigid;
  graph.poses = poses;
  graph.fixed.assign(poses.size(), false);
  if (!graph.fixed.empty()) graph.fixed.front() = true;
  graph.edges.reserve(ties.size());
  for (std::size_t tie = 0; tie < ties.size(); ++tie) graph.edges.push_back(Edge(tie));
  return graph;
}

DriftOptions AsARule(DriftOptions drift) {
  drift.log_scale_per_turn = 0;
  return drift;
}

EssentialGraph MakeEssentialGraph(const Map& map,
                                  const StrongCovisibility& covisible,
                                  bool free_scale,
                                  const DriftOptions& drift) {
  EssentialGraph essential;
  essential.free_scale = free_scale;
  essential.drift = drift;
  for (const auto& [id, keyframe] : map.keyframes()) {
    essential.keyframes.push_back(id);
    essential.poses.push_back(ToSimilarity(keyframe.frame.cam_from_world));
  }
  essential.ties = TiesOf(map, essential.keyframes, covisible);
  essential.usual_length = UsualLength(essential);
  return essential;
}

EssentialGraph MakeEssentialGraph(const Map& map,
                                  bool free_scale,
                                  const DriftOptions& drift,
                                  int strong_covisibility) {
  StrongCovisibility covisible(strong_covisibility);
  covisible.Follow(map);
  return MakeEssentialGraph(map, covisible, free_scale, drift);
}

void ShareInformation(PoseGraph& graph) {
  std::vector<int> degree(graph.poses.size(), 0);
  for (const PoseGraphEdge& edge : graph.edges) {
    ++degree[Index(edge.to)];
    ++degree[Index(edge.from)];
  }
  for (PoseGraphEdge& edge : graph.edges) {
    const double d = 0.5 * (degree[Index(edge.to)] + degree[Index(edge.from)]);
    edge.information /= std::max(1.0, d * (d + 2) / 8);
  }
}

std::optional<PoseGraphEdge> LoopAsEdge(const Map& map,
                                        const EssentialGraph& essential,
                                        const LoopEdge& loop) {
  const KeyFrameId query = NearestAncestor(map, loop.query);
  const KeyFrameId candidate = NearestAncestor(map, loop.candidate);
  if (!query.valid() || !candidate.valid() || query == candidate) return std::nullopt;
  const KeyFramePose query_then = map.PlaceOf(loop.query);
  const KeyFramePose candidate_then = map.PlaceOf(loop.candidate);
  const PoseWithCovariance measured{
      CandidateFromQueryToday(loop, query_then.scale, candidate_then.scale), loop.covariance};
  const Similarity3 query_from_standin =
      ToSimilarity(query_then.cam_from_world * Inverse(map.PoseOf(query)));
  const Similarity3 standin_from_candidate =
      ToSimilarity(map.PoseOf(candidate) * Inverse(candidate_then.cam_from_world));
  const PoseWithCovariance between =
      Compose({standin_from_candidate}, Compose(measured, {query_from_standin}));
  LoopEdge moved = loop;
  moved.covariance = between.covariance;
  PoseGraphEdge edge;
  edge.to = essential.PoseOf(candidate);
  edge.from = essential.PoseOf(query);
  edge.to_from = between.pose;
  edge.information = InformationOf(moved);
  edge.may_be_wrong = true;
  return edge;
}

OdometryWays::OdometryWays(const EssentialGraph& essential)
    : essential_(essential), ties_of_(essential.poses.size()) {
  for (std::size_t tie = 0; tie < essential.ties.size(); ++tie) {
    ties_of_[Index(essential.ties[tie].first)].push_back(static_cast<int>(tie));
    ties_of_[Index(essential.ties[tie].second)].push_back(static_cast<int>(tie));
  }
}

// Returns for each pose the tie that leads to it on the way from pose `first`, or -1.
const std::vector<int>& OdometryWays::WaysFrom(int first) {
  const std::size_t poses = essential_.poses.size();
  const auto [entry, is_new] = ways_from_.try_emplace(first, poses, -1);
  std::vector<int>& tie_to = entry->second;
  if (!is_new) return tie_to;
  std::vector<bool> reached(poses, false);
  std::queue<int> queue;
  queue.push(first);
  reached[Index(first)] = true;
  while (!queue.empty()) {
    const int pose = queue.front();
    queue.pop();
    for (const int tie : ties_of_[Index(pose)]) {
      const auto& [to, from] = essential_.ties[Index(tie)];
      const int other = to == pose ? from : to;
      if (reached[Index(other)]) continue;
      reached[Index(other)] = true;
      tie_to[Index(other)] = tie;
      queue.push(other);
    }
  }
  return tie_to;
}

std::optional<PoseWithCovariance> OdometryWays::Along(int to, int from) {
  if (to == from) return PoseWithCovariance{};
  const std::vector<int>& tie_to = WaysFrom(from);
  if (tie_to[Index(to)] < 0) return std::nullopt;
  PoseWithCovariance to_from;
  for (int pose = to; pose != from;) {
    const PoseGraphEdge edge = essential_.Edge(Index(tie_to[Index(pose)]));
    const PoseWithCovariance step{edge.to_from, CovarianceOf(edge)};
    to_from = Compose(to_from, edge.to == pose ? step : Inverse(step));
    pose = edge.to == pose ? edge.from : edge.to;
  }
  return to_from;
}

void StrongCovisibility::Follow(const Map& map) {
  if (map.token() == nullptr || map.token() != token_) Forget();
  const auto& keyframes = map.keyframes();
  if (token_ != nullptr && keyframes.changes() == changes_) return;
  const std::vector<bool> changed = ChangedPages(keyframes, changes_);
  const KeyFrameId end_of_unchanged = EndOfUnchanged(changed);
  earlier_of_.resize(changed.size() * kIdsOfPage);
  Drop(changed);
  PairCounter counter(map, earlier_of_.size());
  for (std::size_t page = 0; page < changed.size(); ++page) {
    if (!changed[page]) continue;
    keyframes.ForEachOfPage(page, [&](KeyFrameId id, const KeyFrame& keyframe) {
      const KeyFrameId end = std::max(id, end_of_unchanged);
      for (const KeyFrameId other : counter.StrongBefore(end, keyframe, strong_)) {
        // A later keyframe of a page that has changed counts this one when it is its turn.
        if (other < id) Take(other, id);
        if (id < other && !changed[PageOf(other)]) Take(id, other);
      }
    });
  }
  token_ = map.token();
  changes_ = keyframes.changes();
}

void StrongCovisibility::Forget() {
  token_ = nullptr;
  changes_ = 0;
  earlier_of_.clear();
}

const std::vector<KeyFrameId>& StrongCovisibility::EarlierOf(KeyFrameId id) const {
  return earlier_of_.at(PlaceOf(id));
}

// Drops the pairs of which a keyframe is in a page that has changed.
void StrongCovisibility::Drop(const std::vector<bool>& changed) {
  const auto is_dropped = [&](KeyFrameId id) { return changed[PageOf(id)]; };
  const auto first = std::find(changed.begin(), changed.end(), true);
  // No pair of an earlier page has a keyframe of this one or a later one.
  auto place = static_cast<std::size_t>(first - changed.begin()) * kIdsOfPage;
  for (; place < earlier_of_.size(); ++place) {
    std::vector<KeyFrameId>& earlier = earlier_of_[place];
    if (changed[place / kIdsOfPage]) {
      earlier.clear();
    } else {
      std::erase_if(earlier, is_dropped);
    }
  }
}

void StrongCovisibility::Take(KeyFrameId earlier, KeyFrameId later) {
  std::vector<KeyFrameId>& list = earlier_of_[PlaceOf(later)];
  list.insert(std::upper_bound(list.begin(), list.end(), earlier), earlier);
}

}  // namespace plumbline
