// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop/loop_closer.h"

#include "plumbline/loop/essential_graph.h"
#include "plumbline/loop/pairwise_consistency.h"
#include "plumbline/loop/uncertain_pose.h"
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <cstddef>

namespace plumbline {
namespace {

constexpr std::size_t kCompared = 10;    // newest loops that a new one is held against
constexpr std::size_t kMostWaiting = 5;  // loops that wait for another keyframe
constexpr std::int64_t kWaitFor = 5;     // keyframes that such a loop may be old

// By pair whether the loops agree by way of odometry.
std::vector<std::vector<bool>> Consistency(const PoseGraph& odometry,
                                           const std::vector<PoseGraphEdge>& loops,
                                           double max_chi2) {
  std::vector<std::vector<bool>> consistent(loops.size(), std::vector<bool>(loops.size(), true));
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      consistent[i][j] = CycleChi2(odometry, loops[i], loops[j]) <= max_chi2;
      consistent[j][i] = consistent[i][j];
    }
  }
  return consistent;
}

double DriftChi2(const PoseGraph& odometry, const PoseGraphEdge& loop, const LoopEdge& edge) {
  const auto drifted = Along(odometry, loop.from, loop.to);
  if (!drifted) return 0;
  return ClosingChi2(Compose({loop.to_from, edge.covariance}, *drifted));
}

}  // namespace

LoopCloser::LoopCloser(const ImagingModel& imaging, const LoopOptions& options)
    : imaging_(imaging), options_(options) {}

std::vector<KeyFrameId> LoopCloser::WorthTrying(const Map& map,
                                                KeyFrameId newest,
                                                std::span<const KeyFrameId> candidates) const {
  const auto covisible = Covisible(map, newest, options_.closing.min_shared);
  std::vector<KeyFrameId> worth;
  for (const KeyFrameId candidate : candidates) {
    if (static_cast<int>(worth.size()) >= options_.closing.max_candidates) break;
    if (candidate == newest || map.Find(candidate) == nullptr) continue;
    const bool is_covisible = std::any_of(
        covisible.begin(), covisible.end(), [&](const auto& c) { return c.id == candidate; });
    if (!is_covisible) worth.push_back(candidate);
  }
  return worth;
}

std::optional<LoopClosure> LoopCloser::Try(const Map& map,
                                           KeyFrameId newest,
                                           std::span<const KeyFrameId> candidates) {
  attempts_.clear();
  if (map.Find(newest) == nullptr) return std::nullopt;
  const std::int64_t number = map.NumberOf(newest);
  if (last_closed_ >= 0 && number < last_closed_ + options_.closing.pause) return std::nullopt;
  for (const KeyFrameId candidate : WorthTrying(map, newest, candidates)) {
    LoopAttempt& attempt = attempts_.emplace_back();
    attempt.query = newest;
    attempt.candidate = candidate;
    const auto edge = VerifyLoop(map, newest, map, candidate, imaging_, options_.verification);
    if (!edge) {
      attempt.unverified = edge.error();
      continue;
    }
    auto closure = Close(map, *edge, attempt);
    if (!closure) continue;
    last_closed_ = number;
    return closure;
  }
  return std::nullopt;
}

std::optional<LoopClosure> LoopCloser::Close(const Map& map,
                                             const LoopEdge& edge,
                                             LoopAttempt& attempt) {
  LoopClosure closure;
  if (!Supported(map, edge, attempt, closure.record.drift_chi2)) return std::nullopt;
  const auto correction = CloseLoop(map, imaging_.camera.baseline == 0, loops_, edge, options_);
  if (!correction) {
    attempt.unclosed = correction.error();
    return std::nullopt;
  }
  closure.edit = correction->edit;
  closure.correction = correction->correction;
  LoopRecord& record = closure.record;
  record.query = edge.query;
  record.candidate = edge.candidate;
  record.evidence = edge.evidence;
  record.merged_points = correction->merged_points;
  record.merged_lines = correction->merged_lines;
  record.largest_shift = correction->largest_shift;
  record.largest_turn = correction->largest_turn;
  record.query_scale = correction->query_scale;
  record.withdrawn = static_cast<int>(
      std::count(correction->earlier_kept.begin(), correction->earlier_kept.end(), false));
  Take(edge, correction->earlier_kept);
  return closure;
}

bool LoopCloser::Supported(const Map& map,
                           const LoopEdge& edge,
                           LoopAttempt& attempt,
                           double& drift_chi2) {
  const EssentialGraph essential = MakeEssentialGraph(
      map, imaging_.camera.baseline == 0, options_.drift, options_.closing.strong_covisibility);
  const auto newest = LoopAsEdge(map, essential, edge);
  if (!newest) {
    attempt.unclosed = ClosingRefusal::kOutOfMap;
    return false;
  }
  drift_chi2 = DriftChi2(essential.graph, *newest, edge);
  attempt.beyond_drift = drift_chi2 > options_.drift.max_chi2;
  if (attempt.beyond_drift) return false;
  std::vector<PoseGraphEdge> known;
  const std::size_t first = loops_.size() - std::min(loops_.size(), kCompared);
  for (std::size_t i = first; i < loops_.size(); ++i) {
    if (const auto loop = LoopAsEdge(map, essential, loops_[i])) known.push_back(*loop);
  }
  known.push_back(*newest);
  const auto set =
      LargestConsistentSet(Consistency(essential.graph, known, options_.drift.max_chi2));
  attempt.inconsistent =
      std::find(set.begin(), set.end(), static_cast<int>(known.size()) - 1) == set.end();
  if (attempt.inconsistent) return false;
  if (edge.evidence.asked > 0) return true;
  // Nobody beside the query could be asked: another query must say the same.
  std::erase_if(waiting_, [&](const LoopEdge& other) {
    return !map.Knows(other.query) ||
           map.NumberOf(other.query) + kWaitFor < map.NumberOf(edge.query);
  });
  attempt.waits = true;
  for (const LoopEdge& other : waiting_) {
    if (other.query == edge.query) continue;
    const auto loop = LoopAsEdge(map, essential, other);
    if (loop && CycleChi2(essential.graph, *newest, *loop) <= options_.drift.max_chi2) {
      attempt.waits = false;
    }
  }
  if (!attempt.waits) return true;
  waiting_.push_back(edge);
  if (waiting_.size() > kMostWaiting) waiting_.erase(waiting_.begin());
  return false;
}

void LoopCloser::Take(const LoopEdge& edge, const std::vector<bool>& earlier_kept) {
  std::vector<LoopEdge> kept;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (earlier_kept[i]) kept.push_back(std::move(loops_[i]));
  }
  kept.push_back(edge);
  loops_ = std::move(kept);
  waiting_.clear();
}

void LoopCloser::Withdraw(std::size_t loop) {
  loops_.erase(loops_.begin() + static_cast<std::ptrdiff_t>(loop));
}

}  // namespace plumbline
