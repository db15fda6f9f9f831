// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/laboratory_methods.h"

#include "lab/line_rivals/rival_method.h"
#include "lab/rivals/choose_features.h"
#include "lab/rivals/klt_initializer.h"
#include "lab/rivals/two_view.h"

#include <array>
#include <utility>

namespace plumbline {
namespace {

constexpr std::size_t kBudget = 80;  // number of features that best_80 keeps

std::unique_ptr<Initializer> MakeAnyInitializer(const CameraAndPyramid& imaging,
                                                const InitializationOptions& options,
                                                std::uint64_t seed,
                                                HelperThread* helper) {
  if (options.method == "rank1_klt") {
    return std::make_unique<KltInitializer>(imaging.camera, options, seed, helper);
  }
  if (options.method == "two_view") {
    return std::make_unique<TwoViewInitializer>(imaging.camera, seed);
  }
  if (options.method == "two_view_images") {
    return std::make_unique<TwoViewImagesInitializer>(imaging, seed, helper);
  }
  return MakeInitializer(imaging, options, seed, helper);
}

ChosenFeatures ChooseByAnyMethod(const CuttingProblem& problem,
                                 std::span<const PointRows> points,
                                 const CuttingOptions& options) {
  struct Choice {
    const char* name;
    CuttingMethod method;
    bool all;
  };
  constexpr std::array kChoices = {Choice{"greedy_sweeps", CuttingMethod::kGreedySweeps, true},
                                   Choice{"joint", CuttingMethod::kJoint, true},
                                   Choice{"drop", CuttingMethod::kDrop, true},
                                   Choice{"best_80", CuttingMethod::kNone, false},
                                   Choice{"best_80_greedy", CuttingMethod::kGreedy, false}};
  for (const auto& [name, method, all] : kChoices) {
    if (options.method != name) continue;
    const std::size_t budget = all ? points.size() + problem.lines.size() : kBudget;
    return ChooseFeatures(problem, points, budget, {method, options.information});
  }
  if (options.method == "trim") {
    ChosenFeatures whole = ChooseFeatures(
        problem, points, points.size() + problem.lines.size(), {CuttingMethod::kNone});
    whole.trim = true;
    return whole;
  }
  return ChooseAll(problem, points, options);
}

SystemMethods MakeLaboratoryMethods() {
  const std::string start = "initialization.method", cutting = "cutting.method";
  SystemMethods methods{
      {{start, "rank1_klt", "of tracks alive in all frames"},
       {start,
        "two_view",
        "fundamental matrix or homography of two frames as ORB-SLAM decides, points matched by "
        "descriptor"},
       {start, "two_view_images", "the same from the matches and with the patience of rank1"},
       {cutting, "greedy_sweeps", "greedy again until nothing changes"},
       {cutting, "joint", "all at once"},
       {cutting, "trim", "to the measured segment, as lines are before a cut, and no further"},
       {cutting, "drop", "leaves out the 30 % of the lines that are most uncertain"},
       {cutting, "best_80", "the 80 points and whole lines that tell most about the pose"},
       {cutting, "best_80_greedy", "the same, with lines cut"}},
      MakeAnyInitializer,
      MethodFor,
      ChooseByAnyMethod};
  for (AddedMethod& method : AddedLineMethods()) methods.added.push_back(std::move(method));
  return methods;
}

}  // namespace

const SystemMethods& LaboratoryMethods() {
  static const SystemMethods methods = MakeLaboratoryMethods();
  return methods;
}

}  // namespace plumbline
