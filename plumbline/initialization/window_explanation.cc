// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/window_explanation.h"

#include "plumbline/base/chi2.h"
#include "plumbline/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline {

bool IsSame(const WindowSolution& a, const WindowSolution& b) {
  const Rigid3& pose_a = a.cam_from_reference.back();
  const Rigid3& pose_b = b.cam_from_reference.back();
  const Eigen::Vector3d centre_a = Inverse(pose_a).translation;
  const Eigen::Vector3d centre_b = Inverse(pose_b).translation;
  const double angle = math::Atan2(centre_a.cross(centre_b).norm(), centre_a.dot(centre_b));
  return AngularDistance(pose_a.rotation, pose_b.rotation) < kSameRotation &&
         angle < kSameDirection;
}

void InsertExplanation(Explanation explanation, std::vector<Explanation>& explanations) {
  const auto same =
      std::find_if(explanations.begin(), explanations.end(), [&](const Explanation& other) {
        return IsSame(other.solution, explanation.solution);
      });
  if (same == explanations.end()) {
    explanations.push_back(std::move(explanation));
  } else if (explanation.cost < same->cost) {
    *same = std::move(explanation);
  }
}

void SortByCost(std::vector<Explanation>& explanations) {
  std::stable_sort(explanations.begin(), explanations.end(), [](const auto& a, const auto& b) {
    return a.cost < b.cost;
  });
}

void AdjustExplanation(const WindowTracks& tracks, Explanation& explanation) {
  constexpr int kIterations = 6;
  explanation.solution = AdjustWindow(tracks, explanation.solution, kIterations);
  explanation.fit = EvaluateWindow(tracks, explanation.solution, kChi2TwoDof99);
  explanation.cost = explanation.fit.cost;
}

}  // namespace plumbline
