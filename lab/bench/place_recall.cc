// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Recall of a place index: place_recall MAP TRUTH [MAP2 [TRUTH2]]. Maps are those of runs
// (map.plb), the truth is a trajectory of the same sequence. With one map each keyframe queries
// those at least 10 s older, as in a run; with two each keyframe of the second queries all of the
// first, both in one world; without its truth it is of another world, and every candidate is wrong.
//
// A place is revisited if the camera comes within 1 m and 30 degrees of a keyframe; a candidate is
// wrong if it is further away than 4 m or 75 degrees. For each method: the share of revisits with a
// right one among the first 1, 5 and 10 candidates; the share whose first candidate is right and
// scores higher than any wrong first candidate (recall at full precision, without verification);
// that score; CPU time of a query.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/base/units.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/trajectory_io.h"

#include "place_rivals.h"
#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

struct View {
  KeyFrameId id;
  std::int64_t stamp_ns = 0;
  Rigid3 world_from_camera;
  const Features* features = nullptr;
};

struct Sequence {
  Map map;
  std::vector<View> views;  // of the keyframes whose place is known
};

// Without a truth: all views at one place that nothing else is near to.
Sequence Load(const char* map_path, const char* truth_path) {
  constexpr std::int64_t kMaxGap = 200'000'000;
  Sequence sequence{LoadMap(map_path).map, {}};
  const Trajectory truth = truth_path != nullptr ? ReadTrajectory(truth_path).poses : Trajectory();
  const Rigid3 elsewhere{Eigen::Quaterniond::Identity(), Eigen::Vector3d(1e9, 0, 0)};
  for (const auto& [id, keyframe] : sequence.map.keyframes()) {
    const auto pose = truth_path != nullptr ? InterpolateAt(truth, keyframe.frame.stamp_ns, kMaxGap)
                                            : std::optional(elsewhere);
    if (!pose) continue;
    sequence.views.push_back({id, keyframe.frame.stamp_ns, *pose, &keyframe.frame.features()});
  }
  return sequence;
}

enum class Relation { kSame, kNear, kOther };

Relation RelationOf(const View& a, const View& b) {
  const Rigid3 motion = Inverse(a.world_from_camera) * b.world_from_camera;
  const double distance = motion.translation.norm();
  const double angle = LogSo3(motion.rotation).norm();
  if (distance < 1 && angle < 30 * kDegree) return Relation::kSame;
  return distance > 4 || angle > 75 * kDegree ? Relation::kOther : Relation::kNear;
}

double CpuMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

constexpr std::array<std::size_t, 3> kRanks = {1, 5, 10};

class Tally {
 public:
  // One query; `known`: the contents of the index.
  void Count(const View& image,
             const std::vector<PlaceCandidate>& candidates,
             const std::vector<const View*>& known) {
    ++queries_;
    std::vector<Relation> relations;
    for (const PlaceCandidate& candidate : candidates) {
      if (relations.size() == kRanks.back()) break;
      const auto view = std::find_if(
          known.begin(), known.end(), [&](const View* v) { return v->id == candidate.id; });
      relations.push_back(RelationOf(image, **view));
    }
    const bool revisit = std::any_of(known.begin(), known.end(), [&](const View* view) {
      return RelationOf(image, *view) == Relation::kSame;
    });
    if (!relations.empty() && relations[0] == Relation::kOther) {
      worst_wrong_ = std::max(worst_wrong_, candidates[0].score);
    }
    if (!revisit) return;
    ++revisits_;
    const auto first = std::find(relations.begin(), relations.end(), Relation::kSame);
    for (std::size_t i = 0; i < kRanks.size(); ++i) {
      found_[i] += first - relations.begin() < static_cast<std::ptrdiff_t>(kRanks[i]) &&
                           first != relations.end()
                       ? 1
                       : 0;
    }
    if (first == relations.begin() && first != relations.end()) {
      right_.push_back(candidates[0].score);
    }
  }

  void Print(const std::string& name, double milliseconds) const {
    const double all = std::max(1, revisits_);
    const auto sure = std::count_if(
        right_.begin(), right_.end(), [&](double score) { return score > worst_wrong_; });
    fmt::print(
        "  {:24} {:4} revisits of {:4}; first {:5.1f} %, of 5 {:5.1f} %, of 10 {:5.1f} %; at full "
        "precision {:5.1f} %; scores wrong up to {:.3f}, right {:.3f} (5 %: {:.3f}); {:.2f} ms\n",
        name,
        revisits_,
        queries_,
        100 * found_[0] / all,
        100 * found_[1] / all,
        100 * found_[2] / all,
        100 * static_cast<double>(sure) / all,
        worst_wrong_,
        Quantile(0.5),
        Quantile(0.05),
        milliseconds / std::max(1, queries_));
  }

 private:
  // The score below which this share of the right first candidates lies.
  double Quantile(double share) const {
    std::vector<double> sorted = right_;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty()
               ? 0
               : sorted[static_cast<std::size_t>(share * (static_cast<double>(sorted.size()) - 1))];
  }

  int queries_ = 0, revisits_ = 0;
  std::array<double, kRanks.size()> found_{};
  double worst_wrong_ = 0;     // score of a first candidate
  std::vector<double> right_;  // scores of right first candidates
};

void Measure(const PlaceMethod& method, const Sequence& known, const Sequence* images) {
  constexpr std::int64_t kAgo = 10'000'000'000;
  const bool within = images == nullptr;
  Tally tally;
  double milliseconds = 0;
  std::vector<const View*> added;
  for (const View& image : within ? known.views : images->views) {
    while (added.size() < known.views.size() &&
           (!within || known.views[added.size()].stamp_ns <= image.stamp_ns - kAgo)) {
      const View& view = known.views[added.size()];
      method.add(view.id, *view.features);
      added.push_back(&view);
    }
    if (added.empty()) continue;
    const double start = CpuMilliseconds();
    const std::vector<PlaceCandidate> candidates = method.query(*image.features);
    milliseconds += CpuMilliseconds() - start;
    tally.Count(image, candidates, added);
  }
  tally.Print(method.name, milliseconds);
}

void Run(const Sequence& known, const Sequence* images) {
  for (const PlaceMethod& method : {OurIndex(true, true),
                                    OurIndex(true, false),
                                    OurIndex(false, true),
                                    BruteForce(),
                                    HashedWords(8, 16),
                                    HashedWords(4, 12),
                                    BinarySearchTree()}) {
    Measure(method, known, images);
  }
}

void Run(int count, char** arguments) {
  if (count < 3 || count > 5) throw InputError("expected MAP TRUTH [MAP2 [TRUTH2]]");
  const Sequence known = Load(arguments[1], arguments[2]);
  fmt::print("{}: {} keyframes\n", arguments[1], known.views.size());
  if (count == 3) return Run(known, nullptr);
  const Sequence images = Load(arguments[3], arguments[4]);  // ends with null
  Run(known, &images);
}

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("place_recall", [&] { plumbline::Run(count, arguments); });
}
