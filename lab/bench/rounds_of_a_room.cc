// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// A camera that walks through the same rooms for hours: rounds_of_a_room SEQUENCE [--rounds 20]
// [--frames 0] [--sensor mono|stereo|rgbd] [--set KEY=VALUE]...
//
// Plays a recorded sequence (its first frames) again and again, forwards and backwards in turn, so
// that the path is closed; every time with new stamps, another brightness and new noise of the
// sensor. Prints a Markdown row for each round: contents of the map, memory, CPU time of a frame
// and of the additional work of a keyframe, a snapshot, a saved map, and the error of the round in
// the map of that moment [mm]. Requirements and results: docs/benchmarks.md.
#include "lab/bench/replay_arguments.h"
#include "lab/bench/run_bench.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/map/snapshot.h"
#include "plumbline/report/error_options.h"
#include "plumbline/report/trajectory_error.h"
#include "plumbline/slam/atlas_context.h"
#include "plumbline/slam/system.h"
#include "worlds/sensor.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct Setup {
  fs::path sequence;
  int rounds = 20;
  int frames = 0;  // the first so many of the sequence; 0: all
  std::optional<SensorKind> sensor;
  std::vector<std::string> settings;
};

Setup ReadSetup(int count, char** arguments) {
  Setup setup;
  if (count < 2) throw InputError("expected the folder of a sequence");
  setup.sequence = arguments[1];
  for (int i = 2; i < count; i += 2) {
    const std::string name = arguments[i];
    if (i + 1 == count) throw InputError(name + ": expected a value after it");
    const std::string value = arguments[i + 1];
    if (name == "--rounds") {
      setup.rounds = ParseCount(name, value);
    } else if (name == "--frames") {
      setup.frames = ParseCount(name, value);
    } else if (name == "--sensor") {
      setup.sensor = ParseSensor(value);
    } else if (name == "--set") {
      setup.settings.push_back(value);
    } else {
      throw InputError(name + ": no such option");
    }
  }
  return setup;
}

// CPU milliseconds of this process, all its threads.
double CpuMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double ResidentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

// Allocated and not freed memory.
double HeapMegabytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / (1024.0 * 1024.0);
}

// The image of a picture by a sensor of this brightness and with noise of its own. Lens and
// response curve are in the picture already.
GrayImage SeenAgain(const GrayImage& picture, double gain, std::uint64_t stream) {
  Image<float> light(picture.width(), picture.height());
  std::copy_n(
      picture.data(),
      static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height()),
      light.data());
  const SensorModel sensor{.gain = gain, .gamma = 1, .vignetting = 0, .noise = 1, .blur_px = 0};
  return Expose(light, sensor, 1, stream);
}

// A frame of a round: which picture, and when.
struct Visit {
  std::size_t picture = 0;
  std::int64_t stamp_ns = 0;
};

// The rounds one after the other, each beginning at the end of the previous one.
class Walk {
 public:
  Walk(const Dataset& dataset, std::size_t frames) : dataset_(dataset), frames_(frames) {}

  std::vector<Visit> NextRound() {
    std::vector<Visit> visits;
    const bool backwards = round_ % 2 == 1;
    // At the turning point, the picture is taken once.
    for (std::size_t i = round_ == 0 ? 0 : 1; i < frames_; ++i) {
      const std::size_t picture = backwards ? frames_ - 1 - i : i;
      if (last_) now_ns_ += Distance(*last_, picture);
      last_ = picture;
      visits.push_back({picture, now_ns_});
    }
    ++round_;
    return visits;
  }

 private:
  std::int64_t Distance(std::size_t a, std::size_t b) const {
    return dataset_.stamp_ns(std::max(a, b)) - dataset_.stamp_ns(std::min(a, b));
  }

  const Dataset& dataset_;
  std::size_t frames_;
  int round_ = 0;
  std::optional<std::size_t> last_;
  std::int64_t now_ns_ = 1'000'000'000;
};

struct RoundFigures {
  int frames = 0, tracked = 0, keyframes_made = 0;
  double frame_ms = 0;     // CPU, mean
  double keyframe_ms = 0;  // CPU that a frame takes more when a keyframe is mapped meanwhile
};

class Rounds {
 public:
  explicit Rounds(const Setup& setup)
      : setup_(setup),
        dataset_(OpenDataset(setup.sequence, {.sensor = setup.sensor})),
        walk_(*dataset_, ChosenFrames()) {
    OptionTable table(options_);
    for (const std::string& setting : setup.settings) table.Set(setting);
    options_.slam.mode = RunMode::kInline;
    options_.features.parallel = false;
    system_ = std::make_unique<System>(dataset_->calibration(), options_);
    if (dataset_->info().ground_truth) {
      truth_ = dataset_->info().ground_truth->OfCamera(dataset_->calibration());
    }
  }

  void Play() {
    fmt::print(
        "| round | tracked | maps | keyframes | made | removed | points | lines | merged | loops | "
        "RSS | heap | frame | keyframe | snapshot | saved | ATE |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int round = 1; round <= setup_.rounds; ++round) {
      const std::vector<Visit> visits = walk_.NextRound();
      const RoundFigures figures = PlayRound(round, visits);
      Print(round, visits, figures);
    }
  }

 private:
  std::size_t ChosenFrames() const {
    const std::size_t all = dataset_->size();
    return setup_.frames == 0 ? all : std::min(all, static_cast<std::size_t>(setup_.frames));
  }

  SensorFrame See(const Visit& visit, int round) {
    auto read = dataset_->Read(visit.picture);
    if (!read) throw InputError(fmt::format("frame {}: cannot be read", visit.picture));
    SensorFrame frame = *std::move(read);
    constexpr double kGains[] = {1, 0.85, 1.1, 0.95, 1.05, 0.9, 1.15};
    const double gain = kGains[static_cast<std::size_t>(round - 1) % std::size(kGains)];
    const auto stream = [&](std::uint64_t camera) {
      return (static_cast<std::uint64_t>(round) << 33) + (visit.picture << 1) + camera;
    };
    frame.stamp_ns = visit.stamp_ns;
    frame.left = SeenAgain(frame.left, gain, stream(0));
    if (frame.right) frame.right = SeenAgain(*frame.right, gain, stream(1));
    return frame;
  }

  RoundFigures PlayRound(int round, const std::vector<Visit>& visits) {
    RoundFigures figures;
    double mapped_ms = 0, other_ms = 0;
    int mapped = 0;
    for (const Visit& visit : visits) {
      SensorFrame frame = See(visit, round);
      const double start = CpuMilliseconds();
      const FrameRecord& record = system_->Process(std::move(frame));
      const double taken = CpuMilliseconds() - start;
      ++figures.frames;
      figures.tracked += record.status == FrameStatus::kTracked;
      figures.keyframes_made += record.keyframe;
      records_.push_back(record);
      const bool maps = std::any_of(record.times.begin(), record.times.end(), [](const auto& time) {
        return time.stage == "map_take_in";
      });
      mapped += maps;
      (maps ? mapped_ms : other_ms) += taken;
      truth_by_frame_.push_back(TruthOf(visit.picture, visit.stamp_ns));
    }
    figures.frame_ms = (mapped_ms + other_ms) / figures.frames;
    const int others = std::max(1, figures.frames - mapped);
    figures.keyframe_ms = mapped_ms / std::max(1, mapped) - other_ms / others;
    return figures;
  }

  TrajectoryErrorOptions ErrorOptions() const {
    return ErrorOptionsFor(dataset_->sensor(), dataset_->info().format);
  }

  // The camera pose of a picture, at the time of the visit.
  std::optional<StampedPose> TruthOf(std::size_t picture, std::int64_t stamp_ns) const {
    const std::int64_t max_gap_ns = ErrorOptions().max_gap_ns;
    const auto pose = InterpolateAt(truth_, dataset_->stamp_ns(picture), max_gap_ns);
    if (!pose) return std::nullopt;
    return StampedPose{stamp_ns, *pose};
  }

  // The map with most of the frames so far.
  std::optional<MapId> MainMap() const {
    std::map<MapId, int> counts;
    for (const FrameRecord& record : records_) {
      if (record.status == FrameStatus::kTracked) ++counts[maps_.atlas.Current(record.map)];
    }
    const auto most =
        std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        });
    if (most == counts.end()) return std::nullopt;
    return most->first;
  }

  // The camera as delivered in the current map; nullopt if the reference keyframe of the frame is
  // not in this map, or not yet.
  std::optional<Rigid3> PoseToday(const FrameRecord& record, const Map& map) const {
    const bool here = record.status == FrameStatus::kTracked &&
                      maps_.atlas.Current(record.map) == map.id() && map.Knows(record.reference);
    if (!here) return std::nullopt;
    return DeliveredPose(ComposePose(map.PlaceOf(record.reference), record.from_reference),
                         system_->rectifier().rectified_left_from_left());
  }

  // Of the frames of a round, in millimetres.
  std::optional<double> Error(const Map& map, std::int64_t from_ns) const {
    Trajectory estimate, truth;
    for (const FrameRecord& record : records_) {
      if (record.stamp_ns < from_ns) continue;
      if (const auto pose = PoseToday(record, map)) estimate.push_back({record.stamp_ns, *pose});
    }
    for (const auto& pose : truth_by_frame_) {
      if (pose && pose->stamp_ns >= from_ns) truth.push_back(*pose);
    }
    TrajectoryErrorOptions options = ErrorOptions();
    options.association = TrajectoryAssociation::kNearest;
    const auto error = CompareTrajectories(truth, estimate, options);
    if (!error) return std::nullopt;
    return 1e3 * error->ate.rmse;
  }

  double SavedMegabytes() const {
    const fs::path path =
        fs::temp_directory_path() / fmt::format("rounds_of_a_room_{}.plb", getpid());
    SaveAtlas(path, maps_.atlas, maps_.context);
    const double size = static_cast<double>(fs::file_size(path)) / (1024.0 * 1024.0);
    fs::remove(path);
    return size;
  }

  void Print(int round, const std::vector<Visit>& visits, const RoundFigures& figures) {
    const double resident = ResidentMegabytes(), heap = HeapMegabytes();
    MapEvents events;
    system_->ReadMaps([&](const CurrentMaps& maps) {
      maps_ = maps.copy();
      events = maps.events;
    });
    system_->WaitForMapping();
    const auto main = MainMap();
    if (!main) {
      fmt::print("| {} | 0 of {} |\n", round, figures.frames);
      return;
    }
    const Map& map = maps_.atlas.maps().at(*main);
    constexpr int kSnapshots = 20;
    const double start = CpuMilliseconds();
    for (int i = 0; i < kSnapshots; ++i) TakeSnapshot(map, map.keyframes().rbegin()->first);
    const double snapshot_ms = (CpuMilliseconds() - start) / kSnapshots;
    const MapRecord record = map.Record();
    const auto error = Error(map, visits.front().stamp_ns);
    fmt::print(
        "| {} | {} of {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} | {:.0f} | {:.1f} | "
        "{:.1f} | {:.2f} | {:.1f} | {} |\n",
        round,
        figures.tracked,
        figures.frames,
        maps_.atlas.maps().size(),
        map.keyframes().size(),
        figures.keyframes_made,
        record.removed_keyframes.size(),
        map.points().size(),
        map.lines().size(),
        record.merged_points.size() + record.merged_lines.size(),
        events.loops.size(),
        resident,
        heap,
        figures.frame_ms,
        figures.keyframe_ms,
        snapshot_ms,
        SavedMegabytes(),
        error ? fmt::format("{:.1f}", *error) : "-");
    std::fflush(stdout);
  }

  Setup setup_;
  SlamOptions options_;
  std::unique_ptr<Dataset> dataset_;
  Walk walk_;
  std::unique_ptr<System> system_;
  std::vector<FrameRecord> records_;  // as first told
  SavedAtlas maps_;                   // after the last round
  Trajectory truth_;                  // of the recording
  std::vector<std::optional<StampedPose>> truth_by_frame_;
};

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("rounds_of_a_room", [&] {
    plumbline::Rounds(plumbline::ReadSetup(count, arguments)).Play();
  });
}
