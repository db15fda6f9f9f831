// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Success rate of relocalization at random starts in a saved map: relocalization MAP MAPPED
// SEQUENCE [STARTS [SEED [KEY=VALUE...]]]
//
// MAP is the map of a run over the sequence MAPPED; SEQUENCE shows the same world, in the same
// world of ground truth. From STARTS (200) different random frames of it a system continues in the
// map, read-only, for five frames. Once with points and lines, once with points alone (in the same
// map). KEY=VALUE are options of runs.
//
// The error is that of the first reported pose: the map is aligned with the ground truth by its
// keyframes, so that errors of the map count. In addition the error relative to the nearest
// keyframe, without those of the map.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/random.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/slam/system.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace plumbline;  // NOLINT: a program of one file

constexpr std::size_t kFrames = 5;  // from each start
constexpr double kWrong = 0.3;      // metres

struct Error {
  double metres = 0, degrees = 0;
};

Error ErrorOf(const Rigid3& found, const Rigid3& is) {
  return {(found.translation - is.translation).norm(),
          LogSo3(is.rotation.conjugate() * found.rotation).norm() * 180 / std::numbers::pi};
}

// A map beside the true poses of its keyframes.
class MapTruth {
 public:
  MapTruth(const Map& map, const Eigen::Quaterniond& rectified_from_left, const Trajectory& truth) {
    constexpr std::int64_t kMaxGapNs = 200'000'000;
    std::vector<Eigen::Vector3d> places, true_places;
    for (const auto& [id, keyframe] : map.keyframes()) {
      const auto is = InterpolateAt(truth, keyframe.frame.stamp_ns, kMaxGapNs);
      if (!is) continue;
      const Rigid3 found = Inverse(keyframe.frame.cam_from_world) *
                           Rigid3{rectified_from_left, Eigen::Vector3d::Zero()};
      keyframes_.push_back({found, *is});
      places.push_back(found.translation);
      true_places.push_back(is->translation);
    }
    const auto aligned = AlignPoints(places, true_places, AlignmentScale::kFixed);
    if (aligned) truth_from_map_ = aligned->target_from_source;
  }
  bool known() const { return truth_from_map_.has_value(); }

  // Of a pose, world_from_camera, in the world of the map.
  Error AsSuch(const Rigid3& found, const Rigid3& is) const { return ErrorOf(InTruth(found), is); }
  Error BesideNearest(const Rigid3& found, const Rigid3& is) const {
    const auto nearest =
        std::min_element(keyframes_.begin(), keyframes_.end(), [&](const auto& a, const auto& b) {
          return (a.is.translation - is.translation).norm() <
                 (b.is.translation - is.translation).norm();
        });
    const Rigid3 to_truth = nearest->is * Inverse(InTruth(nearest->found));
    return ErrorOf(to_truth * InTruth(found), is);
  }

 private:
  struct Pair {
    Rigid3 found, is;
  };
  Rigid3 InTruth(const Rigid3& pose) const {
    return {truth_from_map_->rotation * pose.rotation, *truth_from_map_ * pose.translation};
  }

  std::vector<Pair> keyframes_;
  std::optional<Similarity3> truth_from_map_;
};

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> Of(const std::vector<Error>& errors, double Error::*part) {
  std::vector<double> values;
  for (const Error& error : errors) values.push_back(error.*part);
  return values;
}

struct Tally {
  std::vector<std::size_t> not_found, wrong;  // starts
  std::vector<Error> as_such, beside;
  std::vector<double> frames;  // until the first pose, that one included
  double cpu_s = 0;

  void Print(const char* name, std::size_t starts) const {
    const auto percent = [&](std::size_t count) {
      return 100.0 * static_cast<double>(count) / static_cast<double>(starts);
    };
    fmt::print(
        "{}: of {} starts {:.1f} % found within {} frames (median {:.0f}), error {:.1f} cm {:.2f} "
        "deg (beside the nearest keyframe {:.1f} cm {:.2f} deg), wrong by more than {} m {:.1f} %; "
        "{:.0f} ms a start\n",
        name,
        starts,
        percent(as_such.size()),
        kFrames,
        Median(frames),
        100 * Median(Of(as_such, &Error::metres)),
        Median(Of(as_such, &Error::degrees)),
        100 * Median(Of(beside, &Error::metres)),
        Median(Of(beside, &Error::degrees)),
        kWrong,
        percent(wrong.size()),
        1e3 * cpu_s / static_cast<double>(starts));
    if (!not_found.empty()) fmt::print("  not found from {}\n", fmt::join(not_found, " "));
    if (!wrong.empty()) fmt::print("  wrong from {}\n", fmt::join(wrong, " "));
  }
};

class Experiment {
 public:
  Experiment(SavedAtlas saved, const Dataset& mapped, const Dataset& sequence)
      : saved_(std::move(saved)),
        sequence_(sequence),
        truth_(sequence.info().ground_truth.value().OfCamera(sequence.calibration())) {
    const Trajectory truth = mapped.info().ground_truth.value().OfCamera(mapped.calibration());
    for (const auto& [id, map] : saved_.atlas.maps()) {
      maps_.emplace(id, MapTruth(map, saved_.context.rectified_from_left, truth));
    }
  }

  Tally Measure(const SlamOptions& options, const std::vector<std::size_t>& starts) const {
    Tally tally;
    std::map<std::size_t, ExtractedFrame> extracted;
    const System front_end(sequence_.calibration(), options);
    for (const std::size_t start : starts) {
      for (std::size_t i = start; i < start + kFrames; ++i) {
        if (extracted.contains(i)) continue;
        const auto frame = sequence_.Read(i);
        if (frame) extracted.emplace(i, front_end.Extract(*frame));
      }
    }
    for (const std::size_t start : starts) Begin(options, start, extracted, tally);
    return tally;
  }

 private:
  void Begin(const SlamOptions& options,
             std::size_t start,
             const std::map<std::size_t, ExtractedFrame>& extracted,
             Tally& tally) const {
    System system(sequence_.calibration(), options);
    system.Continue(saved_, true);
    const double before = CpuSeconds();
    for (std::size_t i = start; i < start + kFrames && extracted.contains(i); ++i) {
      const FrameRecord& record = system.Track(extracted.at(i));
      if (!record.causal_world_from_camera) continue;
      tally.cpu_s += CpuSeconds() - before;
      tally.frames.push_back(static_cast<double>(i - start + 1));
      Compare(record, start, tally);
      return;
    }
    tally.cpu_s += CpuSeconds() - before;
    tally.not_found.push_back(start);
  }

  void Compare(const FrameRecord& record, std::size_t start, Tally& tally) const {
    constexpr std::int64_t kMaxGapNs = 200'000'000;
    const auto is = InterpolateAt(truth_, record.stamp_ns, kMaxGapNs);
    const MapTruth& map = maps_.at(record.map);
    if (!is || !map.known()) throw InputError("expected ground truth of all frames, found less");
    tally.as_such.push_back(map.AsSuch(*record.causal_world_from_camera, *is));
    tally.beside.push_back(map.BesideNearest(*record.causal_world_from_camera, *is));
    if (tally.as_such.back().metres > kWrong) tally.wrong.push_back(start);
  }

  SavedAtlas saved_;
  const Dataset& sequence_;
  Trajectory truth_;
  std::map<MapId, MapTruth> maps_;
};

// Different frames that have kFrames - 1 after them, in order.
std::vector<std::size_t> DrawStarts(std::size_t size, std::size_t count, std::uint64_t seed) {
  if (size < kFrames) throw InputError("expected a longer sequence");
  std::vector<std::size_t> all(size - kFrames + 1);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  Rng rng(seed, "relocalization");
  for (std::size_t i = 0; i < all.size(); ++i)
    std::swap(all[i], all[i + rng.Index(all.size() - i)]);
  all.resize(std::min(count, all.size()));
  std::sort(all.begin(), all.end());
  return all;
}

void Run(int count, char** arguments) {
  if (count < 4) {
    throw InputError("expected MAP MAPPED SEQUENCE [STARTS [SEED [KEY=VALUE...]]]");
  }
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  OptionTable table(options);
  for (int i = 6; i < count; ++i) table.Set(arguments[i]);
  SavedAtlas saved = LoadAtlas(arguments[1]);
  if (saved.context.camera.baseline == 0) {
    throw InputError("expected a map with measured depth, found one of a single camera");
  }
  const auto mapped = OpenDataset(arguments[2]);
  const auto sequence = OpenDataset(arguments[3]);
  const auto most = static_cast<std::size_t>(count > 4 ? std::atoi(arguments[4]) : 200);
  const auto seed = static_cast<std::uint64_t>(count > 5 ? std::atoi(arguments[5]) : 1);
  const auto starts = DrawStarts(sequence->size(), most, seed);
  const Experiment experiment(std::move(saved), *mapped, *sequence);
  experiment.Measure(options, starts).Print("points and lines", starts.size());
  options.features.lines = false;
  experiment.Measure(options, starts).Print("points alone", starts.size());
}

}  // namespace

int main(int count, char** arguments) {
  return bench::RunBench("relocalization", [&] { Run(count, arguments); });
}
