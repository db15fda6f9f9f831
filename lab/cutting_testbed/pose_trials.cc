// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/pose_trials.h"

#include "lab/cutting_testbed/pose_from_lines.h"
#include "lab/rivals/cutting_methods.h"
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/cut_lines.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

enum class Weights { kNone, kScalar, kIndependent, kCorrelated };

struct Recipe {
  CuttingRecipe cutting;
  Weights weights = Weights::kNone;
  bool adjust_points = false;
  bool lengthen = false;
};

Recipe RecipeOf(PoseVariant variant) {
  const CuttingRecipe greedy{CuttingMethod::kGreedy};
  const CuttingRecipe drop{CuttingMethod::kDrop};
  switch (variant) {
    case PoseVariant::kFull:
      return {};
    case PoseVariant::kCut:
      return {greedy};
    case PoseVariant::kCutSweeps:
      return {{CuttingMethod::kGreedySweeps}};
    case PoseVariant::kCutPrinted:
      return {{CuttingMethod::kGreedy, CuttingInformation::kPrinted}};
    case PoseVariant::kDrop:
      return {drop};
    case PoseVariant::kScalar:
      return {{}, Weights::kScalar};
    case PoseVariant::kWeighted:
      return {{}, Weights::kIndependent};
    case PoseVariant::kCutWeighted:
      return {greedy, Weights::kIndependent};
    case PoseVariant::kCutCorrelated:
      return {greedy, Weights::kCorrelated};
    case PoseVariant::kLongCutCorrelated:
      return {greedy, Weights::kCorrelated, false, true};
    case PoseVariant::kDropWeighted:
      return {drop, Weights::kIndependent};
    case PoseVariant::kAdjusted:
      return {{}, Weights::kNone, true};
    case PoseVariant::kCutAdjusted:
      return {greedy, Weights::kNone, true};
  }
  throw BugError("no such variant");
}

Eigen::Matrix2d WeightOf(const RectifiedCamera& camera,
                         const CuttableLine& line,
                         const LineCut& cut,
                         Weights weights) {
  const auto weight = [&](CuttingInformation information) {
    return CutWeight(camera, line, cut, information);
  };
  switch (weights) {
    case Weights::kNone:
      return Eigen::Matrix2d::Identity();
    case Weights::kIndependent:
      return weight(CuttingInformation::kIndependent);
    case Weights::kCorrelated:
      return weight(CuttingInformation::kCorrelated);
    case Weights::kScalar: {
      const Eigen::Matrix2d variance = weight(CuttingInformation::kIndependent).inverse();
      return Eigen::Matrix2d::Identity() / (0.5 * variance.trace());
    }
  }
  throw BugError("no such weights");
}

// A cut about as long as a point, made longer.
LineCut Lengthened(const LineCut& cut) {
  constexpr double kShort = 0.05;
  if (cut.second - cut.first >= kShort) return cut;
  return {std::max(0.0, cut.first - kShort), std::min(1.0, cut.second + kShort), cut.used};
}

std::vector<WeightedCut> Prepare(const CuttingProblem& problem, const Recipe& recipe) {
  const std::vector<LineCut> cuts = CutLinesBy(recipe.cutting, problem);
  std::vector<WeightedCut> out;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const CuttableLine& line = problem.lines[i];
    const LineCut cut = recipe.lengthen ? Lengthened(cuts[i]) : cuts[i];
    out.push_back({line, cut, WeightOf(problem.camera, line, cut, recipe.weights)});
  }
  return out;
}

// The problem at a wrong prediction of the pose; nullopt if an end comes too near.
std::optional<CuttingProblem> At(const Rigid3& predicted_from_true, CuttingProblem problem) {
  const Eigen::Matrix3d rotation = predicted_from_true.rotation.toRotationMatrix();
  for (CuttableLine& line : problem.lines) {
    for (auto* end : {&line.segment_in_cam.start, &line.segment_in_cam.end}) {
      *end = predicted_from_true * *end;
      if (end->z() < 0.1) return std::nullopt;
    }
    line.start_covariance = rotation * line.start_covariance * rotation.transpose();
    line.end_covariance = rotation * line.end_covariance * rotation.transpose();
  }
  return problem;
}

Rigid3 WrongPrediction(Rng& rng) {
  Vector6d tangent;
  for (int i = 0; i < 6; ++i) tangent(i) = rng.Normal(i < 3 ? 1 / kDegrees : 0.05);
  return ExpSe3(tangent);
}

}  // namespace

PoseTrial TryPoses(const SceneOptions& options, std::uint64_t index) {
  const CuttingScene scene = MakeCuttingScene(options, index);
  Rng rng(index, "prediction");
  Rigid3 predicted_from_true = WrongPrediction(rng);
  std::optional<CuttingProblem> problem = At(predicted_from_true, scene.problem);
  while (!problem) {
    predicted_from_true = WrongPrediction(rng);
    problem = At(predicted_from_true, scene.problem);
  }
  PoseTrial trial;
  for (const auto& [variant, name] : EnumNames(std::type_identity<PoseVariant>{})) {
    const Recipe recipe = RecipeOf(variant);
    const std::vector<WeightedCut> lines = Prepare(*problem, recipe);
    const Rigid3 found = recipe.adjust_points ? SolvePoseAndPoints(problem->camera, lines)
                                              : SolvePoseFromLines(problem->camera, lines);
    const Rigid3 error = found * predicted_from_true;
    trial[variant] = {error.translation.norm(),
                      kDegrees * AngularDistance(error.rotation, Eigen::Quaterniond::Identity()),
                      error.translation.dot(scene.motion)};
  }
  return trial;
}

}  // namespace plumbline
