// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// A camera that sees nothing for two seconds and is somewhere else then, in other light:
// kidnapped SEQUENCE OTHER [SEED [KEY=VALUE...]]
//
// Both sequences show one world, in one world of ground truth. First the beginning (300 frames) of
// SEQUENCE is mapped; then, five times, come two seconds of black and fifteen frames of OTHER, from
// a random place that is known (within 1 m and 30 degrees of a frame of SEQUENCE) and at least 3 m
// away, all grey values times 0.6 or 1.4. Then another run: the first 60 frames of SEQUENCE, black,
// and OTHER to its end from the first place that is not known: a new map is to begin, and to become
// one with the old. KEY=VALUE are options of runs.
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/base/random.h"
#include "plumbline/geometry/alignment.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/slam/system.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace plumbline;  // NOLINT: a program of one file

constexpr std::size_t kMapped = 300, kFewMapped = 60;  // frames
constexpr double kBlackSeconds = 2;
constexpr int kJumps = 5;
constexpr std::size_t kAfterJump = 15;  // frames
constexpr double kWrong = 0.3;          // metres

// A sequence with the true pose of each frame.
class Source {
 public:
  explicit Source(const char* path) : data_(OpenDataset(path)) {
    constexpr std::int64_t kMaxGapNs = 200'000'000;
    const Trajectory truth = data_->info().ground_truth.value().OfCamera(data_->calibration());
    for (std::size_t i = 0; i < data_->size(); ++i) {
      const auto pose = InterpolateAt(truth, data_->stamp_ns(i), kMaxGapNs);
      if (!pose) throw InputError("expected ground truth of all frames, found less");
      poses_.push_back(*pose);
    }
  }
  const Dataset& data() const { return *data_; }
  std::size_t size() const { return poses_.size(); }
  const Rigid3& PoseOf(std::size_t frame) const { return poses_[frame]; }
  std::int64_t interval_ns() const { return data_->stamp_ns(1) - data_->stamp_ns(0); }

  // Returns true if one of the first `count` frames was taken near this pose.
  bool Knows(const Rigid3& pose, std::size_t count) const {
    return std::any_of(
        poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(count), [&](const Rigid3& p) {
          const Rigid3 motion = Inverse(p) * pose;
          return motion.translation.norm() < 1 &&
                 LogSo3(motion.rotation).norm() < std::numbers::pi / 6;
        });
  }

 private:
  std::unique_ptr<Dataset> data_;
  std::vector<Rigid3> poses_;
};

void Amplify(GrayImage& image, double gain) {
  for (int y = 0; y < image.height(); ++y) {
    std::transform(
        image.row(y), image.row(y) + image.width(), image.row(y), [&](std::uint8_t value) {
          return static_cast<std::uint8_t>(std::min(255.0, gain * value));
        });
  }
}

// One run over frames of two sequences and black ones.
class Film {
 public:
  Film(const Source& first, const SlamOptions& options)
      : interval_ns_(first.interval_ns()), system_(first.data().calibration(), options) {}

  void Show(const Source& source, std::size_t frame, double gain) {
    auto read = source.data().Read(frame);
    if (!read) throw InputError("expected frames that can be read, found another");
    SensorFrame image = *read;
    width_ = image.left.width();
    height_ = image.left.height();
    Amplify(image.left, gain);
    if (image.right) Amplify(*image.right, gain);
    Feed(std::move(image), source.PoseOf(frame));
  }
  // Returns how many frames were not marked as lost.
  int ShowBlack() {
    const auto frames = std::llround(kBlackSeconds * 1e9 / static_cast<double>(interval_ns_));
    int not_lost = 0;
    for (int i = 0; i < frames; ++i) {
      SensorFrame black;
      black.left = GrayImage(width_, height_, 0);
      black.right = GrayImage(width_, height_, 0);
      Feed(std::move(black), std::nullopt);
      not_lost += newest_ != FrameStatus::kLost;
    }
    return not_lost;
  }

  bool FeatureTracks() const { return newest_ == FrameStatus::kTracked; }
  const Rigid3& Now() const { return poses_.back().value(); }
  RunResult Finish() { return system_.Finish(); }

  struct Outcome {
    double rmse = 0;
    int tracked = 0, wrong = 0;
  };
  // The final poses of a map against the truth.
  Outcome Compare(const RunResult& result, MapId map) const {
    std::vector<Eigen::Vector3d> places, true_places;
    for (const StampedPose& pose : result.FinalTrajectory(map)) {
      const auto frame = static_cast<std::size_t>(pose.stamp_ns / interval_ns_ - 1);
      places.push_back(pose.world_from_camera.translation);
      true_places.push_back(poses_[frame].value().translation);
    }
    Outcome outcome;
    outcome.tracked = static_cast<int>(places.size());
    const auto aligned = AlignPoints(places, true_places, AlignmentScale::kFixed);
    if (!aligned) return outcome;
    outcome.rmse = aligned->rmse;
    for (std::size_t i = 0; i < places.size(); ++i) {
      outcome.wrong += (aligned->target_from_source * places[i] - true_places[i]).norm() > kWrong;
    }
    return outcome;
  }

 private:
  void Feed(SensorFrame frame, const std::optional<Rigid3>& pose) {
    poses_.push_back(pose);
    frame.stamp_ns = static_cast<std::int64_t>(poses_.size()) * interval_ns_;
    newest_ = system_.Process(std::move(frame)).status;
  }

  std::int64_t interval_ns_;
  System system_;
  FrameStatus newest_ = FrameStatus::kInitializing;
  int width_ = 0, height_ = 0;
  std::vector<std::optional<Rigid3>> poses_;  // by frame, the true ones
};

void PrintMaps(Film& film) {
  const RunResult result = film.Finish();
  for (const auto& [id, map] : result.atlas.maps()) {
    const Film::Outcome outcome = film.Compare(result, id);
    fmt::print("  map {}: {} keyframes, {} frames, rmse {:.1f} mm, {} wrong by more than {} m\n",
               id.value,
               map.keyframes().size(),
               outcome.tracked,
               1e3 * outcome.rmse,
               outcome.wrong,
               kWrong);
  }
  for (const MapJoin& join : result.events.joins) {
    fmt::print("  map {} became part of map {} at frame {}\n",
               join.gone.value,
               join.kept.value,
               join.place.frame.value);
  }
}

// A frame of `other` that the first frames of `mapped` show, far away from here.
std::optional<std::size_t> FarAway(
    const Source& other, const Source& mapped, std::size_t count, const Rigid3& here, Rng& rng) {
  constexpr int kTries = 1000;
  constexpr double kFar = 3;
  for (int i = 0; i < kTries; ++i) {
    const std::size_t frame = rng.Index(other.size() - kAfterJump);
    const bool far = (other.PoseOf(frame).translation - here.translation).norm() > kFar;
    if (far && mapped.Knows(other.PoseOf(frame), count)) return frame;
  }
  return std::nullopt;
}

void JumpWhereThePlaceIsKnown(const Source& first,
                              const Source& other,
                              const SlamOptions& options,
                              std::uint64_t seed) {
  Film film(first, options);
  const std::size_t mapped = std::min(kMapped, first.size());
  for (std::size_t i = 0; i < mapped; ++i) film.Show(first, i, 1);
  Rng rng(seed, "kidnapped");
  for (int jump = 0; jump < kJumps; ++jump) {
    const auto place = FarAway(other, first, mapped, film.Now(), rng);
    if (!place) throw InputError("expected sequences of the same places, found others");
    const double distance = (other.PoseOf(*place).translation - film.Now().translation).norm();
    const int not_lost = film.ShowBlack();
    const double gain = jump % 2 == 0 ? 0.6 : 1.4;
    std::size_t found = 0;
    int tracked = 0;
    for (std::size_t i = 0; i < kAfterJump; ++i) {
      film.Show(other, *place + i, gain);
      if (film.FeatureTracks() && tracked++ == 0) found = i + 1;
    }
    fmt::print(
        "jump of {:.1f} m, light times {}: {}, {} of {} frames tracked; {} black frames "
        "not marked as lost\n",
        distance,
        gain,
        found == 0 ? "not found" : fmt::format("a pose with frame {}", found),
        tracked,
        kAfterJump,
        not_lost);
  }
  PrintMaps(film);
}

void JumpWhereItIsNot(const Source& first, const Source& other, const SlamOptions& options) {
  Film film(first, options);
  const std::size_t mapped = std::min(kFewMapped, first.size());
  for (std::size_t i = 0; i < mapped; ++i) film.Show(first, i, 1);
  const int not_lost = film.ShowBlack();
  std::size_t place = 0;
  while (place < other.size() && first.Knows(other.PoseOf(place), mapped)) ++place;
  for (std::size_t i = place; i < other.size(); ++i) film.Show(other, i, 0.6);
  fmt::print("to an unknown place (frame {} of the other): {} black frames not marked as lost\n",
             place,
             not_lost);
  PrintMaps(film);
}

void Run(int count, char** arguments) {
  if (count < 3) throw InputError("expected SEQUENCE OTHER [SEED [KEY=VALUE...]]");
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  OptionTable table(options);
  for (int i = 4; i < count; ++i) table.Set(arguments[i]);
  const Source first(arguments[1]), other(arguments[2]);
  const auto seed = static_cast<std::uint64_t>(count > 3 ? std::atoi(arguments[3]) : 1);
  JumpWhereThePlaceIsKnown(first, other, options, seed);
  JumpWhereItIsNot(first, other, options);
}

}  // namespace

int main(int count, char** arguments) {
  return bench::RunBench("kidnapped", [&] { Run(count, arguments); });
}
