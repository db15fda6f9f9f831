// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_closer.h"

#include "plumbline/base/units.h"
#include "plumbline/geometry/covariance.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/loop_closing/loop_edge.h"
#include "plumbline/loop_closing/pairwise_consistency.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace plumbline {
namespace {

// Newest loops with which a new one is compared.
constexpr std::size_t kCompared = 10;
constexpr std::size_t kMostWaiting = 5;  // most loops that may wait for another keyframe
constexpr std::int64_t kWaitFor = 5;     // age in keyframes at which such a loop is dropped

// Returns for each pair of loops true if they agree by way of odometry.
std::vector<std::vector<bool>> Consistency(OdometryWays& odometry,
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

double DriftChi2(OdometryWays& odometry, const PoseGraphEdge& loop, const LoopEdge& edge) {
  const auto drifted = odometry.Along(loop.from, loop.to);
  if (!drifted) return 0;
  return ClosingChi2(Compose({loop.to_from, edge.covariance}, *drifted));
}

// The landmarks that a keyframe shows, for comparison with those of others.
class ShownLandmarks {
 public:
  explicit ShownLandmarks(const Frame& frame) : points_(frame.points), lines_(frame.lines) {
    std::sort(points_.begin(), points_.end());
    std::sort(lines_.begin(), lines_.end());
  }

  int SharedWith(const Frame& other) const {
    return Count(points_, other.points) + Count(lines_, other.lines);
  }

 private:
  template <class LandmarkId>
  static int Count(const std::vector<LandmarkId>& sorted, const std::vector<LandmarkId>& others) {
    return static_cast<int>(std::count_if(others.begin(), others.end(), [&](LandmarkId id) {
      return id.valid() && std::binary_search(sorted.begin(), sorted.end(), id);
    }));
  }

  std::vector<PointId> points_;
  std::vector<LineId> lines_;
};

// Returns true if a candidate shares landmarks with any of some other keyframes.
bool IsBesideAny(const Map& map, KeyFrameId candidate, const std::vector<KeyFrameId>& others) {
  if (others.empty()) return false;
  const ShownLandmarks shown(map.Find(candidate)->frame);
  return std::any_of(others.begin(), others.end(), [&](KeyFrameId other) {
    return shown.SharedWith(map.Find(other)->frame) > 0;
  });
}

bool IsRefusedByOdometry(const LoopAttempt& attempt) {
  return attempt.beyond_drift || attempt.inconsistent ||
         attempt.unclosed == ClosingRefusal::kBendsOdometry;
}

}  // namespace

// The essential graph of a map with the usual drift of odometry and, with one camera, with the
// worst drift. Each graph is made when it is first asked for.
class LoopCloser::Drifts {
 public:
  Drifts(const Map& map, bool free_scale, const LoopOptions& options, StrongCovisibility& covisible)
      : map_(map), free_scale_(free_scale), options_(options), covisible_(covisible) {}

  bool MayBeLarger() const { return free_scale_; }

  const EssentialGraph& Usual() {
    if (!usual_) {
      covisible_.Follow(map_);
      usual_ = MakeEssentialGraph(map_, covisible_, free_scale_, AsARule(options_.drift));
    }
    return *usual_;
  }
  const EssentialGraph& Larger() {
    if (!larger_) {
      larger_ = Usual();
      larger_->drift = options_.drift;
    }
    return *larger_;
  }

 private:
  const Map& map_;
  bool free_scale_;
  const LoopOptions& options_;
  StrongCovisibility& covisible_;
  std::optional<EssentialGraph> usual_, larger_;
};

LoopCloser::LoopCloser(const CameraAndPyramid& imaging, const LoopOptions& options)
    : imaging_(imaging), options_(options), covisible_(options.strong_covisibility) {}

std::vector<KeyFrameId> LoopCloser::WorthTrying(const Map& map,
                                                KeyFrameId newest,
                                                std::span<const KeyFrameId> candidates) const {
  const ShownLandmarks shown(map.Find(newest)->frame);
  std::vector<KeyFrameId> worth;
  for (const KeyFrameId id : candidates) {
    if (static_cast<int>(worth.size()) >= options_.max_candidates) break;
    const KeyFrame* candidate = map.Find(id);
    if (id == newest || candidate == nullptr) continue;
    if (shown.SharedWith(candidate->frame) < options_.min_shared) worth.push_back(id);
  }
  return worth;
}

std::optional<LoopClosure> LoopCloser::Try(const Map& map,
                                           KeyFrameId newest,
                                           std::span<const KeyFrameId> candidates) {
  attempts_.clear();
  if (map.Find(newest) == nullptr) return std::nullopt;
  if (IsPausing(map, newest)) return std::nullopt;
  Drifts drifts(map, !KnowsUnitOfLength(imaging_.camera), options_, covisible_);
  std::vector<KeyFrameId> elsewhere;
  for (const KeyFrameId candidate : WorthTrying(map, newest, candidates)) {
    if (IsBesideAny(map, candidate, elsewhere)) continue;
    auto closure = TryCandidate(map, newest, candidate, drifts);
    if (attempts_.back().beyond_drift) elsewhere.push_back(candidate);
    if (!closure) continue;
    last_closed_ = newest;
    return closure;
  }
  return std::nullopt;
}

// Numbers of keyframes are those of their map: in another map there is nothing to wait for.
bool LoopCloser::IsPausing(const Map& map, KeyFrameId newest) const {
  return last_closed_.valid() && map.Knows(last_closed_) &&
         map.NumberOf(newest) < map.NumberOf(last_closed_) + options_.pause;
}

std::optional<LoopClosure> LoopCloser::TryCandidate(const Map& map,
                                                    KeyFrameId newest,
                                                    KeyFrameId candidate,
                                                    Drifts& drifts) {
  LoopAttempt& attempt = attempts_.emplace_back();
  attempt.query = newest;
  attempt.candidate = candidate;
  auto edge = VerifyLoop(map, newest, map, candidate, imaging_, options_.verification);
  if (!edge) {
    attempt.unverified = edge.error();
    return std::nullopt;
  }
  attempt.edge = *std::move(edge);
  auto closure = Close(map, drifts.Usual(), attempt);
  if (closure || !drifts.MayBeLarger() || !IsRefusedByOdometry(attempt)) return closure;
  attempt.unclosed.reset();
  attempt.inconsistent = false;
  attempt.drifted_far = true;
  return Close(map, drifts.Larger(), attempt);
}

std::optional<LoopClosure> LoopCloser::Close(const Map& map,
                                             const EssentialGraph& essential,
                                             LoopAttempt& attempt) {
  if (!Supported(map, essential, attempt)) return std::nullopt;
  const LoopEdge& edge = *attempt.edge;
  auto correction = CloseLoop(map, essential, loops_, edge, options_);
  if (!correction) {
    attempt.unclosed = correction.error();
    return std::nullopt;
  }
  LoopClosure closure;
  closure.edit = std::move(correction->edit);
  closure.withdrawn = Take(edge, correction->earlier_kept);
  return closure;
}

// Returns true if evidence other than the images supports a loop. The attempt records
// contradictions.
bool LoopCloser::Supported(const Map& map, const EssentialGraph& essential, LoopAttempt& attempt) {
  const LoopEdge& edge = *attempt.edge;
  const auto newest = LoopAsEdge(map, essential, edge);
  if (!newest) {
    attempt.unclosed = ClosingRefusal::kOutOfMap;
    return false;
  }
  OdometryWays odometry(essential);
  attempt.drift_chi2 = DriftChi2(odometry, *newest, edge);
  attempt.beyond_drift = attempt.drift_chi2 > options_.drift.max_chi2;
  if (attempt.beyond_drift) return false;
  attempt.uncertain = LargestSigma(edge.covariance.topLeftCorner<3, 3>()) >
                      options_.max_rotation_sigma_deg * kDegree;
  if (attempt.uncertain) return false;
  attempt.inconsistent = !AgreesWithTheOthers(map, essential, *newest, odometry);
  if (attempt.inconsistent) return false;
  // Another query must confirm the loop if no neighbour of the query could be tested, or if the
  // usual drift of odometry contradicts it.
  attempt.waits = (edge.evidence.asked == 0 || attempt.drifted_far) &&
                  !WasSaidBefore(map, essential, edge, *newest, odometry);
  if (attempt.waits) Wait(edge);
  return !attempt.waits;
}

bool LoopCloser::AgreesWithTheOthers(const Map& map,
                                     const EssentialGraph& essential,
                                     const PoseGraphEdge& newest,
                                     OdometryWays& odometry) const {
  std::vector<PoseGraphEdge> known;
  const std::size_t first = loops_.size() - std::min(loops_.size(), kCompared);
  for (std::size_t i = first; i < loops_.size(); ++i) {
    if (const auto loop = LoopAsEdge(map, essential, loops_[i])) known.push_back(*loop);
  }
  // A loop that agrees with all others is in every largest set.
  const bool agrees_with_all = std::all_of(known.begin(), known.end(), [&](const auto& loop) {
    return CycleChi2(odometry, newest, loop) <= options_.drift.max_chi2;
  });
  if (agrees_with_all) return true;
  known.push_back(newest);
  const std::vector<int> set =
      LargestConsistentSet(Consistency(odometry, known, options_.drift.max_chi2));
  return std::find(set.begin(), set.end(), static_cast<int>(known.size()) - 1) != set.end();
}

bool LoopCloser::WasSaidBefore(const Map& map,
                               const EssentialGraph& essential,
                               const LoopEdge& edge,
                               const PoseGraphEdge& newest,
                               OdometryWays& odometry) {
  std::erase_if(waiting_, [&](const LoopEdge& other) {
    return !map.Knows(other.query) ||
           map.NumberOf(other.query) + kWaitFor < map.NumberOf(edge.query);
  });
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const LoopEdge& other) {
    if (other.query == edge.query) return false;
    const auto loop = LoopAsEdge(map, essential, other);
    return loop && CycleChi2(odometry, newest, *loop) <= options_.drift.max_chi2;
  });
}

void LoopCloser::Wait(const LoopEdge& edge) {
  waiting_.push_back(edge);
  if (waiting_.size() > kMostWaiting) waiting_.erase(waiting_.begin());
}

// Takes the new loop and keeps only earlier ones that agree with it. Returns those that are not
// kept.
std::vector<LoopEdge> LoopCloser::Take(const LoopEdge& edge,
                                       const std::vector<bool>& earlier_kept) {
  std::vector<LoopEdge> kept;
  std::vector<LoopEdge> withdrawn;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    (earlier_kept[i] ? kept : withdrawn).push_back(std::move(loops_[i]));
  }
  kept.push_back(edge);
  loops_ = std::move(kept);
  waiting_.clear();
  return withdrawn;
}

}  // namespace plumbline
