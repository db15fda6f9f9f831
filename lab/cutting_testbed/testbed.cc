// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/testbed.h"

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

using Steps = std::vector<std::function<void()>>;

TrialCell<JointTrial> TryJoint(const SceneOptions& options, int repeats) {
  TrialCell<JointTrial> cell{options, {}};
  for (int i = 0; i < repeats; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    cell.trials.push_back(
        TryJointly(MakeCuttingScene(options, index), CuttingInformation::kIndependent, index));
  }
  return cell;
}

TrialCell<PoseTrial> TryPoseCell(const SceneOptions& options, int repeats) {
  TrialCell<PoseTrial> cell{options, {}};
  for (int i = 0; i < kPoseTrialsPerRepeat * repeats; ++i) {
    cell.trials.push_back(TryPoses(options, static_cast<std::uint64_t>(i)));
  }
  return cell;
}

TestbedTrials::Choice TryChoiceCell(const ChoiceOptions& options, int repeats) {
  TestbedTrials::Choice choice{options, {}};
  for (int i = 0; i < repeats; ++i) {
    choice.trials.push_back(TryChoices(options, static_cast<std::uint64_t>(i)));
  }
  return choice;
}

void AddLogDeterminants(const SceneOptions& options,
                        int repeats,
                        TestbedTrials& out,
                        Steps& steps) {
  const auto single = [=, &out, &steps](CuttingInformation information, AscentStarts starts) {
    steps.emplace_back(
        [=, &out] { out.single.push_back(TrySingle(options, information, starts, repeats)); });
  };
  for (const auto& [starts, name] : EnumNames(std::type_identity<AscentStarts>{})) {
    single(CuttingInformation::kIndependent, starts);
  }
  single(CuttingInformation::kPrinted, AscentStarts::kThree);
  steps.emplace_back([=, &out] { out.joint.push_back(TryJoint(options, repeats)); });
}

void AddPosesAndChoices(int repeats, TestbedTrials& out, Steps& steps) {
  using enum SceneKind;
  for (const SceneOptions& options : Cells({kHomogeneousPoints, kInverseDepthPoints, kStereo})) {
    steps.emplace_back([=, &out] { out.poses.push_back(TryPoseCell(options, repeats)); });
  }
  for (const ChoiceOptions& options : {ChoiceOptions{5, 5, 6, true}, {100, 30, 40, false}}) {
    steps.emplace_back([=, &out] { out.choices.push_back(TryChoiceCell(options, repeats)); });
  }
}

// The work as a list of steps, each of about a cell.
Steps MakeSteps(int repeats, TestbedParts parts, TestbedTrials& out) {
  using enum SceneKind;
  Steps steps;
  for (const SceneOptions& options : Cells({kHomogeneousPoints, kInverseDepthPoints})) {
    AddLogDeterminants(options, repeats, out, steps);
  }
  if (parts == TestbedParts::kAll) AddPosesAndChoices(repeats, out, steps);
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
                         TestbedParts parts,
                         const std::function<bool(std::size_t, std::size_t)>& progress) {
  TestbedTrials out;
  const Steps steps = MakeSteps(repeats, parts, out);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i]();
    if (!progress(i + 1, steps.size())) break;
  }
  return out;
}

}  // namespace plumbline
