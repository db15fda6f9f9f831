// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/pair_figures.h"

#include "lab/line_maps/run_trajectory.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {
namespace {

constexpr std::size_t kMostFrames = 1000;
constexpr double kMillimetres = 1000;
constexpr const char *kName = "rpe_pairs", *kOfStart = "start_rpe";

// Of all of them, or of as many as are allowed.
std::vector<EvaluatedPose> Evenly(const std::vector<EvaluatedPose>& poses) {
  const std::size_t count = std::min(poses.size(), kMostFrames);
  std::vector<EvaluatedPose> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(poses[i * poses.size() / count]);
  return chosen;
}

// Metres; the poses are at least two.
double ErrorOfPairs(const std::vector<EvaluatedPose>& poses) {
  double sum = 0;
  std::size_t pairs = 0;
  for (std::size_t a = 0; a < poses.size(); ++a) {
    const Rigid3 reference = Inverse(poses[a].reference), estimate = Inverse(poses[a].estimate);
    for (std::size_t b = a + 1; b < poses.size(); ++b) {
      const Rigid3 error = Inverse(reference * poses[b].reference) * (estimate * poses[b].estimate);
      sum += error.translation.squaredNorm();
      ++pairs;
    }
  }
  return std::sqrt(sum / static_cast<double>(pairs));
}

// Number of frames up to that of this stamp; nullopt if it is not in the list.
std::optional<int> CountFrames(const std::filesystem::path& list, const std::string& stamp) {
  std::ifstream file(list);
  std::string line;
  std::getline(file, line);  // the names of the columns
  for (int frames = 1; std::getline(file, line); ++frames) {
    const auto begin = line.find(',') + 1;
    if (line.substr(begin, line.find(',', begin) - begin) == stamp) return frames;
  }
  return std::nullopt;
}

// start_rpe: as rpe_pairs, and a metre for a run without a pose, as the first paper has it in
// figure 8.
void AddStartError(RunFigures& figures) {
  constexpr double kErrorWithoutMap = 1;  // metres
  const auto of_pairs = figures.values.find(kName);
  const auto tracked = figures.values.find("tracked");
  figures.reasons.erase(kOfStart);
  if (of_pairs != figures.values.end()) {
    figures.values[kOfStart] = of_pairs->second;
  } else if (tracked != figures.values.end() && tracked->second == 0) {
    figures.values[kOfStart] = kMillimetres * kErrorWithoutMap;
  } else {
    figures.reasons[kOfStart] = figures.reasons[kName];
  }
}

}  // namespace

void AddStartFigure(const std::filesystem::path& run, RunFigures& figures) {
  constexpr const char* kStart = "start_frames";
  std::ifstream poses(run / "trajectory_causal.txt");
  std::string stamp;
  const auto frames =
      poses >> stamp ? CountFrames(run / "frames.csv", stamp) : std::optional<int>();
  if (frames) {
    figures.reasons.erase(kStart);
    figures.values[kStart] = *frames;
  } else {
    figures.reasons[kStart] = "no frame has a pose";
  }
}

void AddPairFigures(const std::filesystem::path& sequence,
                    const std::filesystem::path& run,
                    RunFigures& figures) {
  try {
    const auto error = CompareRunWithTruth(sequence, run);
    if (!error || error->poses.size() < 2) {
      figures.reasons[kName] = "no ground truth of two poses";
    } else {
      figures.reasons.erase(kName);
      figures.values[kName] = kMillimetres * ErrorOfPairs(Evenly(error->poses));
    }
  } catch (const InputError&) {
    figures.reasons[kName] = "the trajectories cannot be read";
  }
  AddStartError(figures);
}

}  // namespace plumbline
