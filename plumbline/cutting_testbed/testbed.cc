// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/cutting_testbed/testbed.h"

#include "plumbline/base/options.h"

#include <algorithm>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr int kPoseTrialsPerRepeat = 4;
constexpr int kPrintedScenes = 20;

std::vector<SceneOptions> Cells(std::initializer_list<SceneKind> kinds) {
  std::vector<SceneOptions> cells;
  for (const SceneKind kind : kinds) {
    for (const double noise : {0.005, 0.015}) {
      for (const int lines : {6, 10, 15, 20, 30}) {
        const double scale = kind == SceneKind::kStereo ? 10 : 1;
        cells.push_back({kind, scale * noise, lines});
      }
    }
  }
  return cells;
}

SingleLineCell TrySingle(const SceneOptions& options,
                         CuttingInformation information,
                         AscentStarts starts,
                         int repeats) {
  const bool printed = information == CuttingInformation::kPrinted;
  SingleLineCell cell;
  cell.options = options;
  cell.information = information;
  cell.starts = starts;
  for (int i = 0; i < (printed ? std::min(repeats, kPrintedScenes) : repeats); ++i) {
    const auto trials = TrySingleLines(MakeCuttingScene(options, static_cast<std::uint64_t>(i)),
                                       information,
                                       starts,
                                       printed ? 1 : static_cast<std::size_t>(options.lines));
    cell.trials.insert(cell.trials.end(), trials.begin(), trials.end());
  }
  return cell;
}

// The work as a list of steps, each of about a cell.
std::vector<std::function<void()>> Steps(int repeats, TestbedTrials& out) {
  using enum SceneKind;
  std::vector<std::function<void()>> steps;
  const auto cuboid = Cells({kHomogeneousPoints, kInverseDepthPoints});
  for (const SceneOptions& options : cuboid) {
    for (const auto& [starts, name] : EnumNames(std::type_identity<AscentStarts>{})) {
      steps.emplace_back([=, &out, kind = starts] {
        out.single.push_back(TrySingle(options, CuttingInformation::kIndependent, kind, repeats));
      });
    }
    steps.emplace_back([=, &out] {
      out.single.push_back(
          TrySingle(options, CuttingInformation::kPrinted, AscentStarts::kThree, repeats));
    });
    steps.emplace_back([=, &out] {
      TrialCell<JointTrial> cell{options, {}};
      for (int i = 0; i < repeats; ++i) {
        const auto index = static_cast<std::uint64_t>(i);
        cell.trials.push_back(
            TryJointly(MakeCuttingScene(options, index), CuttingInformation::kIndependent, index));
      }
      out.joint.push_back(std::move(cell));
    });
  }
  for (const SceneOptions& options : Cells({kHomogeneousPoints, kInverseDepthPoints, kStereo})) {
    steps.emplace_back([=, &out] {
      TrialCell<PoseTrial> cell{options, {}};
      for (int i = 0; i < kPoseTrialsPerRepeat * repeats; ++i) {
        cell.trials.push_back(TryPoses(options, static_cast<std::uint64_t>(i)));
      }
      out.poses.push_back(std::move(cell));
    });
  }
  for (const double noise : {0.005, 0.015}) {
    steps.emplace_back([=, &out] {
      const SceneOptions options{kHomogeneousPoints, noise, 10};
      out.paths.push_back({options, TryCameraPath(options, repeats)});
    });
  }
  for (const auto shape : {SurfaceShape::kFullLength, SurfaceShape::kPiece, SurfaceShape::kPoint}) {
    steps.emplace_back([=, &out] {
      out.surfaces.push_back(FindSurface({kHomogeneousPoints, 0.005, 10}, shape));
    });
  }
  return steps;
}

}  // namespace

std::string NameOf(const SceneOptions& options) {
  return fmt::format("{}/{}/{}", NameOf(options.kind), options.noise, options.lines);
}

TestbedTrials RunTestbed(int repeats,
                         const std::function<bool(std::size_t, std::size_t)>& progress) {
  TestbedTrials out;
  const auto steps = Steps(repeats, out);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i]();
    if (!progress(i + 1, steps.size())) break;
  }
  return out;
}

}  // namespace plumbline
