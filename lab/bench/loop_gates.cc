// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Correctness of recognized places, and of the refusals by the gates: loop_gates [--mono] [--from
// K] [--beside MAP.plb] [--verbose] SEQUENCE [FRAMES]
//
// Runs the sequence (inline) and compares every comparison with the newest keyframe with the truth:
// an edge is false if the two views share less than a tenth of their content, or if the error of
// the measured relative pose is above its covariance (99.9 % of chi2; one camera: of the rotation,
// since the scale is arbitrary). Relocalizations are false if off by more than 0.3 m or 5 degrees.
// --beside: with the maps of another world in the atlas, in which every recognition is false.
//
// Revisits: keyframes within 1 m and 30 degrees of one at least 10 s older, the camera having been
// elsewhere between; successive ones are one event. It is recognized if one of them closes a loop
// or merges maps, or shares landmarks with keyframes at least 10 s older.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/base/units.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/loop_closing/loop_closer.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/slam/system.h"

#include "view_truth.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace plumbline::bench {
namespace {

constexpr double kLeastShared = 0.1;
constexpr std::int64_t kSecond = 1'000'000'000;

struct Arguments {
  bool mono = false, verbose = false;
  std::optional<std::string> beside;
  std::string sequence;
  std::size_t from = 0, frames = SIZE_MAX;
};

// Error of a relative pose.
struct PoseError {
  double metres = 0, degrees = 0;
  double chi2 = 0;
  bool is_wrong = false;
};

// Results of all comparisons.
struct GateCounts {
  int same = 0;   // the views overlap, and the measured pose, if any, is right
  int wrong = 0;  // they do, but the pose is not
  int other = 0;  // they do not
};

std::string GateOf(const Atlas& atlas, const LoopAttempt& attempt) {
  if (attempt.unverified) return NameOf(*attempt.unverified);
  if (attempt.beyond_drift) return "beyond_drift";
  if (attempt.uncertain) return "uncertain";
  if (attempt.inconsistent) return "inconsistent";
  if (attempt.waits) return "waits";
  if (attempt.unclosed) return NameOf(*attempt.unclosed);
  return atlas.active().Find(attempt.candidate) != nullptr ? "CLOSED" : "JOINED";
}

const Map& MapWith(const Atlas& atlas, KeyFrameId id) {
  for (const auto& [map_id, map] : atlas.maps()) {
    if (map.Find(id) != nullptr) return map;
  }
  throw BugError("a keyframe that is in no map");
}

class Gates {
 public:
  Gates(const ViewTruth& truth, std::set<KeyFrameId> foreign, bool mono, bool verbose)
      : truth_(truth), foreign_(std::move(foreign)), mono_(mono), verbose_(verbose) {}

  void Count(const Atlas& atlas, const LoopAttempt& attempt) {
    const std::string gate = GateOf(atlas, attempt);
    GateCounts& counts = counts_[gate];
    const double shared = Shared(atlas, attempt);
    const bool overlaps = shared >= kLeastShared;
    const auto error = overlaps && attempt.edge ? ErrorOf(atlas, attempt) : std::nullopt;
    const bool wrong = error && error->is_wrong;
    (wrong ? counts.wrong : overlaps ? counts.same : counts.other) += 1;
    const bool changes_maps = gate == "CLOSED" || gate == "JOINED";
    if (changes_maps) accepted_.insert(attempt.query);
    if (!verbose_ && !changes_maps && !(attempt.edge && (wrong || !overlaps))) return;
    fmt::print("  {} with {}: {}, {:.0f} % of the view shared",
               attempt.query.value,
               attempt.candidate.value,
               gate,
               100 * shared);
    if (error) {
      fmt::print(
          ", off by {:.3f} m, {:.2f} deg, chi2 {:.1f}", error->metres, error->degrees, error->chi2);
    }
    if (attempt.edge) {
      fmt::print(", {} points {} lines, log10 {:.0f}, drift chi2 {:.1f}, sigmas {}",
                 attempt.edge->evidence.inlier_points,
                 attempt.edge->evidence.inlier_lines,
                 attempt.edge->evidence.log10_chance,
                 attempt.drift_chi2,
                 Sigmas(*attempt.edge));
      if (overlaps) PrintPairs(atlas, attempt);
    }
    fmt::print("\n");
  }

  bool Accepted(KeyFrameId query) const { return accepted_.contains(query); }

  void Print() const {
    fmt::print("compared: same place / pose wrong / other place\n");
    for (const auto& [gate, counts] : counts_) {
      fmt::print("  {:16} {:4} / {:4} / {:4}\n", gate, counts.same, counts.wrong, counts.other);
    }
  }

 private:
  std::optional<Rigid3> TruePose(const Atlas& atlas, KeyFrameId id) const {
    if (foreign_.contains(id)) return std::nullopt;
    return truth_.PoseAt(MapWith(atlas, id).Find(id)->frame.stamp_ns);
  }

  double Shared(const Atlas& atlas, const LoopAttempt& attempt) const {
    const auto query = TruePose(atlas, attempt.query);
    const auto candidate = TruePose(atlas, attempt.candidate);
    if (!query || !candidate) return 0;
    const auto seen_by = [&](KeyFrameId id, const Rigid3& other) {
      const Map& map = MapWith(atlas, id);
      return truth_.SharedView(*map.Find(id), map, other, Unit(map, id));
    };
    return std::max(seen_by(attempt.query, *candidate), seen_by(attempt.candidate, *query));
  }

  double Unit(const Map& map, KeyFrameId id) const {
    return mono_ ? truth_.UnitAround(map, id) : 1;
  }

  // Of a measured pose, along the least certain axes.
  static std::string Sigmas(const LoopEdge& edge) {
    const auto largest = [&](int first) {
      const Eigen::Matrix3d block = edge.covariance.block<3, 3>(first, first);
      return std::sqrt(
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues().maxCoeff());
    };
    return fmt::format("{:.2f} deg {:.3f} m", largest(0) / kDegree, largest(3));
  }

  // Distance on true surfaces between points matched as one: of the intersections of the rays of
  // their newest observations. Nothing for a recording.
  void PrintPairs(const Atlas& atlas, const LoopAttempt& attempt) const {
    constexpr double kOnePoint = 0.05;  // metres
    std::vector<double> apart;
    for (const auto& pair : attempt.edge->points) {
      const auto a = SurfaceOf(MapWith(atlas, attempt.query), pair.in_query);
      const auto b = SurfaceOf(MapWith(atlas, attempt.candidate), pair.in_candidate);
      if (a && b) apart.push_back((*a - *b).norm());
    }
    if (apart.empty()) return;
    std::sort(apart.begin(), apart.end());
    fmt::print(", {} pairs of points, {} of them two points, {:.3f} m apart in the middle",
               apart.size(),
               apart.end() - std::upper_bound(apart.begin(), apart.end(), kOnePoint),
               apart[apart.size() / 2]);
  }

  std::optional<Eigen::Vector3d> SurfaceOf(const Map& map, PointId id) const {
    const MapPoint* point = map.Find(id);
    if (point == nullptr) return std::nullopt;
    const auto& [seen_by, feature] = point->observations.newest();
    const Frame& frame = map.Find(seen_by)->frame;
    return truth_.SurfaceAt(frame.stamp_ns,
                            frame.features().points[static_cast<std::size_t>(feature)].px);
  }

  std::optional<PoseError> ErrorOf(const Atlas& atlas, const LoopAttempt& attempt) const {
    constexpr double kRigid = 22.46, kRotation = 16.27;  // 99.9 % of chi2 with 6, 3 degrees
    const auto query = TruePose(atlas, attempt.query);
    const auto candidate = TruePose(atlas, attempt.candidate);
    if (!query || !candidate) return std::nullopt;
    const double query_scale = Unit(MapWith(atlas, attempt.query), attempt.query);
    const double candidate_scale = Unit(MapWith(atlas, attempt.candidate), attempt.candidate);
    Similarity3 is = ToSimilarity(*candidate * Inverse(*query));
    is.scale = query_scale / candidate_scale;
    is.translation /= candidate_scale;
    const Vector7d off = LogSim3(attempt.edge->candidate_from_query * Inverse(is));
    const Eigen::Index size = mono_ ? 3 : 6;
    const Eigen::VectorXd part = off.head(size);
    PoseError error;
    error.metres = candidate_scale * off.segment<3>(3).norm();
    error.degrees = off.head<3>().norm() / kDegree;
    error.chi2 = part.dot(attempt.edge->covariance.topLeftCorner(size, size).ldlt().solve(part));
    error.is_wrong = error.chi2 > (mono_ ? kRotation : kRigid);
    return error;
  }

  const ViewTruth& truth_;
  std::set<KeyFrameId> foreign_;
  bool mono_, verbose_;
  std::map<std::string, GateCounts> counts_;
  std::set<KeyFrameId> accepted_;
};

// Finds the keyframes, in order, at which the camera revisits a place.
class Revisits {
 public:
  Revisits(const ViewTruth& truth, const Gates& gates, KeyFrameId newest)
      : truth_(truth), gates_(gates), newest_(newest) {}

  void Look(const Atlas& atlas) {
    if (atlas.empty()) return;
    const Map& map = atlas.active();
    for (auto it = map.keyframes().upper_bound(newest_); it != map.keyframes().end(); ++it) {
      newest_ = it->first;
      Add(map, it->second);
    }
  }

  std::int64_t StampOf(KeyFrameId id) const { return stamps_.at(id); }
  bool Knows(KeyFrameId id) const { return stamps_.contains(id); }

  void Print() const {
    int closed = 0;
    int tied = 0;
    int missed = 0;
    int keyframes = 0;
    int recognized = 0;
    for (const Event& event : events_) {
      (event.closed ? closed : event.tied > 0 ? tied : missed) += 1;
      keyframes += event.keyframes;
      recognized += event.tied;
      if (!event.closed && event.tied == 0) {
        fmt::print("  missed: {} keyframes from {} on, {:.1f} to {:.1f} s\n",
                   event.keyframes,
                   event.first.value,
                   1e-9 * static_cast<double>(event.from_ns - first_ns_),
                   1e-9 * static_cast<double>(event.to_ns - first_ns_));
      }
    }
    fmt::print(
        "{} keyframes; {} revisits: {} closed, {} tied already, {} missed; of {} keyframes that "
        "revisit {} share landmarks with what was seen before\n",
        stamps_.size(),
        events_.size(),
        closed,
        tied,
        missed,
        keyframes,
        recognized);
  }

 private:
  struct View {
    std::int64_t stamp_ns;
    Rigid3 pose;
  };
  struct Event {
    KeyFrameId first;
    std::int64_t from_ns = 0, to_ns = 0;
    int keyframes = 0, tied = 0;
    bool closed = false;
  };
  static constexpr std::int64_t kAgo = 10 * kSecond;

  static bool IsNear(const Rigid3& a, const Rigid3& b) {
    return DistanceOfCentres(a, b) < 1 && AngularDistance(a.rotation, b.rotation) < 30 * kDegree;
  }

  void Add(const Map& map, const KeyFrame& keyframe) {
    const std::int64_t now = keyframe.frame.stamp_ns;
    if (stamps_.empty()) first_ns_ = now;
    stamps_[keyframe.id] = now;
    const auto pose = truth_.PoseAt(now);
    if (!pose) return;
    const bool again = IsRevisit(now, *pose);
    views_.push_back({now, *pose});
    if (!again) return;
    constexpr std::int64_t kPause = 2 * kSecond;
    if (events_.empty() || events_.back().to_ns + kPause < now) {
      events_.push_back({keyframe.id, now});
    }
    Event& event = events_.back();
    event.to_ns = now;
    ++event.keyframes;
    event.tied += IsTied(map, keyframe);
    event.closed = event.closed || gates_.Accepted(keyframe.id);
  }

  // The newest view before `now` that is near counts only if the camera was away since.
  bool IsRevisit(std::int64_t now, const Rigid3& pose) const {
    bool away = false;
    for (auto view = views_.rbegin(); view != views_.rend(); ++view) {
      const bool near = IsNear(view->pose, pose);
      if (near && away && view->stamp_ns + kAgo <= now) return true;
      away = away || !near;
    }
    return false;
  }

  static bool IsTied(const Map& map, const KeyFrame& keyframe) {
    const auto covisible = Covisible(map, keyframe.id);
    return std::any_of(covisible.begin(), covisible.end(), [&](const auto& other) {
      return map.Find(other.id)->frame.stamp_ns + kAgo <= keyframe.frame.stamp_ns;
    });
  }

  const ViewTruth& truth_;
  const Gates& gates_;
  KeyFrameId newest_;
  std::int64_t first_ns_ = 0;
  std::map<KeyFrameId, std::int64_t> stamps_;
  std::vector<View> views_;
  std::vector<Event> events_;
};

void PrintRelocalizations(const RunResult& result,
                          const ViewTruth& truth,
                          const Revisits& revisits,
                          bool mono) {
  int wrong = 0;
  int foreign = 0;
  const auto& relocalizations = result.events.relocalizations;
  for (const Relocalization& found : relocalizations) {
    const FrameRecord& record = result.frames[static_cast<std::size_t>(found.frame.value)];
    const KeyFrameId reference = record.reference;
    if (!reference.valid() || !revisits.Knows(reference)) {
      ++foreign;
      continue;
    }
    const auto then = truth.PoseAt(revisits.StampOf(reference));
    const auto now = truth.PoseAt(record.stamp_ns);
    if (!then || !now) continue;
    const Rigid3 is = *now * Inverse(*then);
    const Rigid3& found_pose = record.from_reference.cam_from_keyframe;
    const double metres = (is.translation - found_pose.translation).norm();
    const double degrees = AngularDistance(is.rotation, found_pose.rotation) / kDegree;
    wrong += (!mono && metres > 0.3) || degrees > 5;
  }
  fmt::print("{} relocalizations, {} wrong, {} in maps of another world\n",
             relocalizations.size(),
             wrong,
             foreign);
}

RunResult Feed(const Dataset& dataset,
               const Arguments& arguments,
               System& system,
               Revisits& revisits) {
  for (std::size_t i = arguments.from; i < std::min(arguments.frames, dataset.size()); ++i) {
    auto frame = dataset.Read(i);
    if (frame) {
      system.Process(std::move(*frame));
    } else {
      system.Skip(dataset.stamp_ns(i), "unreadable");
    }
    system.ReadMaps([&](const CurrentMaps& maps) { revisits.Look(maps.atlas); });
    system.WaitForMapping();
  }
  RunResult result = system.Finish([] { return true; });
  revisits.Look(result.atlas);
  return result;
}

void Run(const Arguments& arguments) {
  DatasetOptions input;
  if (arguments.mono) input.sensor = SensorKind::kMono;
  const auto dataset = OpenDataset(arguments.sequence, input);
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  System system(dataset->calibration(), options);
  std::set<KeyFrameId> foreign;
  if (arguments.beside) {
    SavedAtlas saved = LoadAtlas(*arguments.beside);
    for (const auto& [map_id, map] : saved.atlas.maps()) {
      for (const auto& [id, keyframe] : map.keyframes()) foreign.insert(id);
    }
    system.Continue(std::move(saved), false);
  }
  const KeyFrameId newest = foreign.empty() ? KeyFrameId{} : *foreign.rbegin();
  const Rectifier& rectifier = system.rectifier();
  const ViewTruth truth(*dataset, rectifier.camera(), rectifier.rectified_left_from_left());
  Gates gates(truth, foreign, arguments.mono, arguments.verbose);
  Revisits revisits(truth, gates, newest);
  system.Observe(
      [&](const Atlas& atlas, const LoopAttempt& attempt) { gates.Count(atlas, attempt); });
  fmt::print("{}{}\n", arguments.sequence, arguments.mono ? ", one camera" : "");
  const RunResult result = Feed(*dataset, arguments, system, revisits);
  gates.Print();
  revisits.Print();
  PrintRelocalizations(result, truth, revisits, arguments.mono);
  const auto tracked =
      std::count_if(result.frames.begin(), result.frames.end(), [](const FrameRecord& record) {
        return record.status == FrameStatus::kTracked;
      });
  fmt::print("{} of {} frames tracked, {} maps\n",
             tracked,
             result.frames.size(),
             result.atlas.maps().size());
}

Arguments Parse(int count, char** words) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--mono") {
      arguments.mono = true;
    } else if (word == "--verbose") {
      arguments.verbose = true;
    } else if (word == "--from" && i + 1 < count) {
      arguments.from = static_cast<std::size_t>(std::atoi(words[++i]));
    } else if (word == "--beside" && i + 1 < count) {
      arguments.beside = words[++i];
    } else if (arguments.sequence.empty()) {
      arguments.sequence = word;
    } else {
      arguments.frames = static_cast<std::size_t>(std::atoi(words[i]));
    }
  }
  if (arguments.sequence.empty()) {
    throw InputError("expected [--mono] [--from K] [--beside MAP] [--verbose] SEQUENCE [FRAMES]");
  }
  return arguments;
}

}  // namespace
}  // namespace plumbline::bench

int main(int count, char** words) {
  using namespace plumbline::bench;  // NOLINT: a program of one file
  return RunBench("loop_gates", [&] { Run(Parse(count, words)); });
}
