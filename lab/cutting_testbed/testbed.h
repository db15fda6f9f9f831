// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/camera_path_trials.h"
#include "lab/cutting_testbed/choice_trials.h"
#include "lab/cutting_testbed/joint_trials.h"
#include "lab/cutting_testbed/pose_trials.h"
#include "lab/cutting_testbed/single_line_trials.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace plumbline {

// Trials of one kind of scenes. "hp/0.005/15": kind, noise, lines.
template <class Trial>
struct TrialCell {
  SceneOptions options;
  std::vector<Trial> trials;
};
std::string NameOf(const SceneOptions& options);

struct SingleLineCell : TrialCell<SingleLineTrial> {
  CuttingInformation information = CuttingInformation::kIndependent;
  AscentStarts starts = AscentStarts::kThree;
};

// All trials of the testbed of the second paper (4.2, 5.1, 5.2, Figures 2 to 4), and in addition
// the errors of the poses.
struct TestbedTrials {
  std::vector<SingleLineCell> single;  // independent from each set of starts, printed from kThree
  std::vector<TrialCell<JointTrial>> joint;
  std::vector<TrialCell<PoseTrial>> poses;  // four times as many trials
  struct Choice {
    ChoiceOptions options;
    std::vector<ChoiceTrial> trials;
  };
  std::vector<Choice> choices;  // of few features with all subsets tried, of many
  struct Path {
    SceneOptions options;
    std::vector<CameraPathPoint> points;
  };
  std::vector<Path> paths;
  std::vector<SurfaceExample> surfaces;  // full length, piece, point
};

// Selected trials.
enum class TestbedParts {
  kAll,
  kFigures,  // Figures 2 to 4: single lines, joint optimizers, camera paths, surfaces
};

// `repeats` scenes for each kind, noise (0.005, 0.015; stereo 0.05, 0.15) and number of lines (6,
// 10, 15, 20, 30; printed information: at most 20 scenes, one line of each). One thread; 100
// repeats take some five minutes, most of it in Ipopt. `progress(done, total)` is called after each
// cell; false ends the run with the results so far.
TestbedTrials RunTestbed(int repeats,
                         TestbedParts parts,
                         const std::function<bool(std::size_t, std::size_t)>& progress);

}  // namespace plumbline
