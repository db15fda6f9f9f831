// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Live runs over recorded sequences, in real time, beside processes that only load the machine, or
// watched by viewers that discard their messages: numbers of skipped and lost frames and of maps,
// the largest gap between two poses, the error, the shed work, the time from an image to its pose,
// processor time and memory.
//
//   live_under_load [--loops 0,2,4,8] [--viewers none,0,1] [--runs 5] [--sequence NAME]...
//                   [--data DIR] [--program FILE] [--processors 2] [--set KEY=VALUE]...
//
// --viewers none is a run without --view (the default), 0 a viewer without clients. Variants run
// alternately.
//
// Prints a Markdown table. Meaning of the numbers, and results: docs/benchmarks.md.
#include "lab/bench/discarding_viewer.h"
#include "lab/bench/run_bench.h"
#include "plumbline/base/error.h"

#include "tests/support/free_port.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <list>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Load beside one run.
struct Variant {
  int loops = 0;
  std::optional<int> viewers;  // nullopt: the run cannot be looked at
};

struct Setup {
  std::vector<int> loops = {0, 2, 4, 8};
  std::vector<std::optional<int>> viewers = {std::nullopt};
  int runs = 5;
  std::vector<std::string> sequences;
  fs::path data = PLUMBLINE_DATA_BESIDE_SOURCE;
  fs::path program = PLUMBLINE_BINARY;
  int processors = 2;
  std::vector<std::string> settings;
};

int ParseNumber(const std::string& name, const std::string& text, int least) {
  std::size_t used = 0;
  int value = least - 1;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || text.empty() || value < least) {
    throw InputError(fmt::format("{} {}: expected a number from {} on", name, text, least));
  }
  return value;
}

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) parts.push_back(part);
  return parts;
}

Setup ReadSetup(int count, char** arguments) {
  Setup setup;
  if (const char* data = std::getenv("PLUMBLINE_DATA")) setup.data = data;  // NOLINT
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i];
    if (i + 1 == count) throw InputError(name + ": expected a value after it");
    const std::string value = arguments[i + 1];
    if (name == "--loops") {
      setup.loops.clear();
      for (const std::string& part : SplitAtCommas(value)) {
        setup.loops.push_back(ParseNumber(name, part, 0));
      }
    } else if (name == "--viewers") {
      setup.viewers.clear();
      for (const std::string& part : SplitAtCommas(value)) {
        setup.viewers.emplace_back(part == "none" ? std::nullopt
                                                  : std::optional(ParseNumber(name, part, 0)));
      }
    } else if (name == "--runs") {
      setup.runs = ParseNumber(name, value, 1);
    } else if (name == "--sequence") {
      setup.sequences.push_back(value);
    } else if (name == "--data") {
      setup.data = value;
    } else if (name == "--program") {
      setup.program = value;
    } else if (name == "--processors") {
      setup.processors = ParseNumber(name, value, 1);
    } else if (name == "--set") {
      setup.settings.push_back(value);
    } else {
      throw InputError(name + ": no such option");
    }
  }
  if (setup.sequences.empty()) {
    setup.sequences = {"euroc/MH_01_easy_first250",
                       "kitti/06_first51",
                       "tum/rgbd_dataset_freiburg1_floor_first90"};
  }
  return setup;
}

// This process and all that it starts.
void KeepTo(int processors) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) return;
  cpu_set_t kept;
  CPU_ZERO(&kept);
  for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&kept) < processors; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) CPU_SET(cpu, &kept);
  }
  sched_setaffinity(0, sizeof(kept), &kept);
}

// Child processes that are never done.
class BusyLoops {
 public:
  explicit BusyLoops(int count) {
    for (int i = 0; i < count; ++i) {
      const pid_t child = ::fork();
      if (child < 0) throw InputError(fmt::format("cannot fork: {}", std::strerror(errno)));
      if (child == 0) Spin();
      children_.push_back(child);
    }
  }
  ~BusyLoops() {
    for (const pid_t child : children_) ::kill(child, SIGKILL);
    for (const pid_t child : children_) ::waitpid(child, nullptr, 0);
  }
  BusyLoops(const BusyLoops&) = delete;
  BusyLoops& operator=(const BusyLoops&) = delete;

 private:
  [[noreturn]] static void Spin() {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::atomic<unsigned> number = 0;
    while (true) number.fetch_add(1, std::memory_order_relaxed);
  }

  std::vector<pid_t> children_;
};

// Removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "live_under_load.XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw InputError(name + ": cannot be made: " + std::strerror(errno));
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Figures {
  int in = 0, dropped = 0, lost = 0, maps = 0, keyframes = 0, demoted = 0;
  double median_ms = 0, p95_ms = 0, p99_ms = 0;  // from an image to its pose
  double cpu_ms = 0, peak_mb = 0;                // processor time a frame, of all threads
  double gap_seconds = 0;             // between two poses, before the first and after the last
  std::optional<double> ate, causal;  // metres
  int lighter = 0;                    // frames for which something was shed, but not left out

  double DroppedShare() const { return in > 0 ? static_cast<double>(dropped) / in : 1; }
  double LostShare() const { return in > 0 ? static_cast<double>(lost) / in : 1; }
};

// The largest time without a pose, from the table of frames (its columns go by name).
double LargestGap(const fs::path& table) {
  std::ifstream file(table);
  std::string row;
  std::getline(file, row);
  double last = -1, largest = 0, stamp = 0;
  while (std::getline(file, row)) {
    std::istringstream cells(row);
    std::string frame, time, state;
    std::getline(cells, frame, ',');
    std::getline(cells, time, ',');
    std::getline(cells, state, ',');
    stamp = std::stod(time);
    if (last < 0) last = stamp;
    if (state != "tracked") continue;
    largest = std::max(largest, stamp - last);
    last = stamp;
  }
  return std::max(largest, stamp - last);
}

Figures ReadFigures(const fs::path& folder) {
  std::ifstream file(folder / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file);
  Figures figures;
  figures.in = summary["frames"]["in"];
  figures.dropped = summary["frames"]["dropped"];
  figures.lost = summary["frames"]["lost"];
  figures.maps = summary["maps"];
  figures.keyframes = summary["keyframes"];
  const auto ate = [&](const char* name) -> std::optional<double> {
    if (summary[name].is_null()) return std::nullopt;
    return summary[name]["ate"]["rmse"].get<double>();
  };
  figures.ate = ate("accuracy");
  figures.causal = ate("accuracy_causal");
  if (summary.contains("shed")) {
    const auto& shed = summary["shed"];
    figures.demoted = shed["keyframes"];
    for (const char* what : {"mapping", "lines", "points"})
      figures.lighter += shed[what].get<int>();
  }
  figures.median_ms = summary["timing"]["total"]["median_ms"];
  figures.p95_ms = summary["timing"]["total"]["p95_ms"];
  figures.p99_ms = summary["timing"]["total"]["p99_ms"];
  figures.cpu_ms = 1e3 * summary["cpu_seconds"].get<double>() / figures.in;
  figures.peak_mb = summary["peak_memory_mb"];
  figures.gap_seconds = LargestGap(folder / "frames.csv");
  return figures;
}

Figures Run(const Setup& setup, const std::string& sequence, std::optional<int> viewers) {
  const TemporaryFolder folder;
  const std::uint16_t port = viewers ? FreePort() : 0;
  std::vector<std::string> words = {setup.program.string(),
                                    "run",
                                    (setup.data / sequence).string(),
                                    "--mode",
                                    "live",
                                    "--imu",
                                    "off",
                                    "--quiet",
                                    "--out",
                                    (folder.path() / "run").string()};
  if (viewers) words.insert(words.end(), {"--view", std::to_string(port)});
  for (const std::string& setting : setup.settings) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int null = ::open("/dev/null", O_WRONLY);
    ::dup2(null, STDERR_FILENO);  // it names every frame that it leaves out
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  std::list<DiscardingViewer> watching;
  for (int i = 0; i < viewers.value_or(0); ++i) watching.emplace_back(port);
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0) {
    throw InputError(fmt::format("{} run {}: failed", setup.program.string(), sequence));
  }
  for (const DiscardingViewer& viewer : watching) {
    if (viewer.bytes() == 0) throw InputError("a viewer was sent nothing");
  }
  return ReadFigures(folder.path() / "run");
}

std::string Millimetres(const std::optional<double>& metres) {
  return metres ? fmt::format("{:.1f}", 1e3 * *metres) : std::string("-");
}

void Print(const std::string& sequence,
           const Variant& variant,
           const std::string& run,
           const Figures& f) {
  fmt::print("| {} | {} | {} | {} | {:.0f} % | {:.1f} % | {} | {:.2f} s | {} | {} | {} | {} | {} ",
             sequence,
             variant.loops,
             variant.viewers ? std::to_string(*variant.viewers) : "none",
             run,
             100 * f.DroppedShare(),
             100 * f.LostShare(),
             f.maps,
             f.gap_seconds,
             Millimetres(f.ate),
             Millimetres(f.causal),
             f.keyframes,
             f.demoted,
             f.lighter);
  fmt::print("| {:.1f}, {:.1f}, {:.1f} | {:.1f} | {:.0f} |\n",
             f.median_ms,
             f.p95_ms,
             f.p99_ms,
             f.cpu_ms,
             f.peak_mb);
  std::fflush(stdout);
}

// The largest of each.
Figures Worst(const std::vector<Figures>& runs) {
  Figures worst = runs.front();
  for (const Figures& run : runs) {
    worst.dropped = std::max(worst.dropped, run.dropped);
    worst.lost = std::max(worst.lost, run.lost);
    worst.maps = std::max(worst.maps, run.maps);
    worst.keyframes = std::max(worst.keyframes, run.keyframes);
    worst.demoted = std::max(worst.demoted, run.demoted);
    worst.lighter = std::max(worst.lighter, run.lighter);
    worst.gap_seconds = std::max(worst.gap_seconds, run.gap_seconds);
    worst.median_ms = std::max(worst.median_ms, run.median_ms);
    worst.p95_ms = std::max(worst.p95_ms, run.p95_ms);
    worst.p99_ms = std::max(worst.p99_ms, run.p99_ms);
    worst.cpu_ms = std::max(worst.cpu_ms, run.cpu_ms);
    worst.peak_mb = std::max(worst.peak_mb, run.peak_mb);
    worst.ate = !worst.ate || !run.ate ? std::nullopt : std::max(worst.ate, run.ate);
    worst.causal = !worst.causal || !run.causal ? std::nullopt : std::max(worst.causal, run.causal);
  }
  return worst;
}

// All variants of a sequence in turn, as often as asked, then the worst of each.
void MeasureSequence(const Setup& setup, const std::string& sequence, int loops) {
  const BusyLoops busy(loops);
  std::vector<std::vector<Figures>> runs(setup.viewers.size());
  for (int run = 0; run < setup.runs; ++run) {
    for (std::size_t v = 0; v < setup.viewers.size(); ++v) {
      runs[v].push_back(Run(setup, sequence, setup.viewers[v]));
      Print(sequence, {loops, setup.viewers[v]}, std::to_string(run + 1), runs[v].back());
    }
  }
  for (std::size_t v = 0; v < setup.viewers.size(); ++v) {
    Print(sequence, {loops, setup.viewers[v]}, "worst", Worst(runs[v]));
  }
}

void Measure(const Setup& setup) {
  fmt::print(
      "| sequence | busy loops | viewers | run | left out | lost | maps | largest gap | ATE [mm] | "
      "causal [mm] | keyframes | given up | frames with less work | image to pose: median, p95, "
      "p99 [ms] | CPU a frame [ms] | memory [MB] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& sequence : setup.sequences) {
    for (const int loops : setup.loops) MeasureSequence(setup, sequence, loops);
  }
}

}  // namespace
}  // namespace plumbline

int main(int count, char** arguments) {
  return plumbline::bench::RunBench("live_under_load", [&] {
    const plumbline::Setup setup = plumbline::ReadSetup(count, arguments);
    plumbline::KeepTo(setup.processors);
    plumbline::Measure(setup);
  });
}
