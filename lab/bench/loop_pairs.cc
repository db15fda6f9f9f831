// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// How well pairs of keyframes are told apart that see the same place again or do not, on a map that
// a run wrote and the sequence it was made of: loop_pairs MAP.plb SEQUENCE [PAIRS]
//
// Then the loops of the true pairs are closed one after the other, and the keyframes compared with
// the ground truth.
//
// True pairs: 10 s apart, closer than 1 m and 30 degrees by ground truth, and sharing no landmarks.
// False pairs: further apart than 8 m. PAIRS of each kind (default 200), spread evenly.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/loop_closing/loop_closer.h"
#include "plumbline/loop_closing/verify_loop.h"
#include "plumbline/map/covisibility.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

namespace {

using namespace plumbline;  // NOLINT: a program of one file

struct Pair {
  KeyFrameId query, candidate;
};

struct Pairs {
  std::vector<Pair> same, different;
};

// The true pose of each keyframe: cam_from_world of the rectified left camera, in the world of the
// ground truth.
std::map<KeyFrameId, Rigid3> TruePoses(const SavedMap& saved, const Dataset& dataset) {
  constexpr std::int64_t kMaxGapNs = 200'000'000;
  const Trajectory truth = dataset.info().ground_truth->OfCamera(dataset.calibration());
  std::map<KeyFrameId, Rigid3> poses;
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    const auto pose = InterpolateAt(truth, keyframe.frame.stamp_ns, kMaxGapNs);
    if (!pose) continue;
    poses[id] = Rigid3{saved.rectified_from_left, Eigen::Vector3d::Zero()} * Inverse(*pose);
  }
  return poses;
}

template <class T>
void Thin(std::vector<T>& values, std::size_t most) {
  if (values.size() <= most) return;
  std::vector<T> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(values[i * values.size() / most]);
  values = kept;
}

Pairs FindPairs(const Map& map, const std::map<KeyFrameId, Rigid3>& truth, std::size_t most) {
  Pairs pairs;
  for (const auto& [query, query_pose] : truth) {
    const auto covisible = Covisible(map, query, 1);
    for (const auto& [candidate, candidate_pose] : truth) {
      const std::int64_t age =
          map.Find(query)->frame.stamp_ns - map.Find(candidate)->frame.stamp_ns;
      if (age < 10'000'000'000) continue;
      const bool shares = std::any_of(covisible.begin(), covisible.end(), [&](const auto& other) {
        return other.id == candidate;
      });
      if (shares) continue;
      const Rigid3 motion = candidate_pose * Inverse(query_pose);
      const double distance = motion.translation.norm();
      const double angle = LogSo3(motion.rotation).norm() * 57.29578;
      if (distance < 1 && angle < 30) pairs.same.push_back({query, candidate});
      if (distance > 8) pairs.different.push_back({query, candidate});
    }
  }
  Thin(pairs.same, most);
  Thin(pairs.different, most);
  return pairs;
}

struct Tally {
  std::map<std::string, int> outcomes;
  std::vector<double> accepted_ms, refused_ms, translation_m, rotation_deg, nees, log10_chance;

  static double Quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }

  void Print(const char* name) const {
    fmt::print("{}:", name);
    for (const auto& [outcome, count] : outcomes) fmt::print(" {} {}", outcome, count);
    fmt::print("\n  ms accepted {:.1f} (p95 {:.1f}), refused {:.1f} (p95 {:.1f})\n",
               Quantile(accepted_ms, 0.5),
               Quantile(accepted_ms, 0.95),
               Quantile(refused_ms, 0.5),
               Quantile(refused_ms, 0.95));
    if (translation_m.empty()) return;
    fmt::print(
        "  error of accepted {:.4f} m (p95 {:.4f}, max {:.4f}), {:.3f} deg (p95 {:.3f}); "
        "NEES {:.1f} (p90 {:.1f}); log10 of chance {:.0f} (most {:.0f})\n",
        Quantile(translation_m, 0.5),
        Quantile(translation_m, 0.95),
        Quantile(translation_m, 1),
        Quantile(rotation_deg, 0.5),
        Quantile(rotation_deg, 0.95),
        Quantile(nees, 0.5),
        Quantile(nees, 0.9),
        Quantile(log10_chance, 0.5),
        Quantile(log10_chance, 1));
  }
};

void Ask(const SavedMap& saved,
         const std::map<KeyFrameId, Rigid3>& truth,
         const Pair& pair,
         Tally& tally) {
  CameraAndPyramid imaging;
  imaging.camera = saved.camera;
  const auto start = std::chrono::steady_clock::now();
  const auto edge = VerifyLoop(saved.map, pair.query, saved.map, pair.candidate, imaging, {});
  const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
  ++tally.outcomes[edge ? "accepted" : NameOf(edge.error())];
  (edge ? tally.accepted_ms : tally.refused_ms).push_back(ms.count());
  if (!edge) return;
  const Similarity3 true_pose =
      ToSimilarity(truth.at(pair.candidate) * Inverse(truth.at(pair.query)));
  const Vector7d error = LogSim3(edge->candidate_from_query * Inverse(true_pose));
  tally.translation_m.push_back(error.segment<3>(3).norm());
  tally.rotation_deg.push_back(error.head<3>().norm() * 57.29578);
  tally.log10_chance.push_back(edge->evidence.log10_chance);
  // The scale of a single camera's map is arbitrary: only the rotation is comparable.
  const Eigen::Index size = saved.camera.baseline == 0 ? 3 : 6;
  const Eigen::VectorXd part = error.head(size);
  tally.nees.push_back(part.dot(edge->covariance.topLeftCorner(size, size).ldlt().solve(part)));
  if (std::getenv("LOOP_PAIRS_VERBOSE") != nullptr) {
    const LoopEvidence& e = edge->evidence;
    fmt::print(
        "{} {}: {} points {} lines of {}, share {:.3f}, log10 {:.0f}, rival {:.2f}, spread "
        "{:.2f}, area {:.2f}, confirmed {}/{}, pairs {} {}, error {:.3f} m\n",
        pair.query.value,
        pair.candidate.value,
        e.inlier_points,
        e.inlier_lines,
        e.tested,
        e.chance_share,
        e.log10_chance,
        e.rival_share,
        e.spread,
        e.area_share,
        e.confirmed,
        e.asked,
        edge->points.size(),
        edge->lines.size(),
        error.segment<3>(3).norm());
  }
}

// Root mean square distance of the keyframes from the ground truth after alignment, metres.
double Ate(const SavedMap& saved, const std::map<KeyFrameId, Rigid3>& truth) {
  std::vector<Eigen::Vector3d> estimated;
  std::vector<Eigen::Vector3d> true_places;
  for (const auto& [id, pose] : truth) {
    estimated.push_back(Inverse(saved.map.PoseOf(id)).translation);
    true_places.push_back(Inverse(pose).translation);
  }
  const auto scale = saved.camera.baseline == 0 ? AlignmentScale::kFree : AlignmentScale::kFixed;
  return AlignPoints(estimated, true_places, scale)->rmse;
}

void CloseAll(SavedMap& saved,
              const std::map<KeyFrameId, Rigid3>& truth,
              const std::vector<Pair>& pairs) {
  CameraAndPyramid imaging;
  imaging.camera = saved.camera;
  LoopCloser closer(imaging, {});
  fmt::print("closing: ATE {:.4f} m before\n", Ate(saved, truth));
  std::map<KeyFrameId, std::vector<KeyFrameId>> candidates;
  for (const Pair& pair : pairs) candidates[pair.query].push_back(pair.candidate);
  for (const auto& [query, offered] : candidates) {
    const auto start = std::chrono::steady_clock::now();
    const auto closure = closer.Try(saved.map, query, offered);
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
    for (const LoopAttempt& attempt : closer.attempts()) {
      if (attempt.unclosed)
        fmt::print("  {} unclosed: {}\n", query.value, NameOf(*attempt.unclosed));
      if (attempt.beyond_drift) fmt::print("  {} beyond drift\n", query.value);
      if (attempt.uncertain) fmt::print("  {} uncertain\n", query.value);
      if (attempt.inconsistent) fmt::print("  {} inconsistent\n", query.value);
    }
    if (!closure) continue;
    const Map before = saved.map;
    const auto before_apply = std::chrono::steady_clock::now();
    saved.map.Apply(closure->edit);
    const std::chrono::duration<double, std::milli> apply_ms =
        std::chrono::steady_clock::now() - before_apply;
    saved.map.CheckInvariants();
    const LoopEdge& edge = closer.loops().back();
    const KeyFramePose old_place = before.PlaceOf(query), new_place = saved.map.PlaceOf(query);
    fmt::print(
        "  {} with {}: drift chi2 {:.1f}, {} points and {} lines merged, moved {:.3f} m, "
        "scale {:.4f}, {:.0f} + {:.0f} ms; ATE {:.4f} m\n",
        query.value,
        edge.candidate.value,
        closer.attempts().back().drift_chi2,
        before.points().size() - saved.map.points().size(),
        before.lines().size() - saved.map.lines().size(),
        (Inverse(new_place.cam_from_world).translation -
         Inverse(old_place.cam_from_world).translation)
            .norm(),
        new_place.scale / old_place.scale,
        ms.count(),
        apply_ms.count(),
        Ate(saved, truth));
  }
}

void Run(const char* map_path, const char* sequence, std::size_t most) {
  SavedMap saved = LoadMap(map_path);
  const auto dataset = OpenDataset(sequence);
  const auto truth = TruePoses(saved, *dataset);
  const Pairs pairs = FindPairs(saved.map, truth, most);
  fmt::print("{}: {} keyframes, {} true pairs, {} false pairs\n",
             map_path,
             saved.map.keyframes().size(),
             pairs.same.size(),
             pairs.different.size());
  Tally same;
  for (const Pair& pair : pairs.same) Ask(saved, truth, pair, same);
  same.Print("true pairs");
  Tally different;
  for (const Pair& pair : pairs.different) Ask(saved, truth, pair, different);
  different.Print("false pairs");
  CloseAll(saved, truth, FindPairs(saved.map, truth, 100000).same);
}

}  // namespace

int main(int count, char** arguments) {
  return bench::RunBench("loop_pairs", [&] {
    if (count < 3) throw InputError("expected MAP SEQUENCE [PAIRS]");
    Run(arguments[1],
        arguments[2],
        count > 3 ? static_cast<std::size_t>(std::atoi(arguments[3])) : 200);
  });
}
