// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/random.h"
#include "plumbline/line_cutting/cutting_problem.h"

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Origin and errors of lines (second paper, 4.2 and 5.1).
enum class SceneKind {
  // Edges and chords of the faces of a cuboid, seen from around it. The ends have errors in column,
  // row and inverse depth, independent and of equal size `noise` (column and row in units of the
  // focal length, inverse depth in 1/m). Homogeneous points: of the present camera; inverse-depth
  // points: of an anchor camera half a metre away, which saw them first. The paper gives no more
  // details of the two.
  kHomogeneousPoints,
  kInverseDepthPoints,
  // Lines 2 to 7 m ahead from a stereo pair 0.3 m behind, as in frame-to-frame odometry: 1 px, and
  // `noise` times the disparity.
  kStereo,
};
constexpr auto EnumNames(std::type_identity<SceneKind>) {
  return std::array{std::pair{SceneKind::kHomogeneousPoints, "hp"},
                    std::pair{SceneKind::kInverseDepthPoints, "idp"},
                    std::pair{SceneKind::kStereo, "stereo"}};
}

struct SceneOptions {
  SceneKind kind = SceneKind::kHomogeneousPoints;
  double noise = 0.005;
  int lines = 10;
};

struct CuttingScene {
  CuttingProblem problem;            // as known to a program: ends with their errors
  std::vector<Segment3> true_lines;  // in the same camera
  // Stereo: direction of the translation of present_from_earlier; otherwise zero.
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
};

// Scene `index` of these options. The measured lines have errors of 1 px at each end of the true
// image. Deterministic.
CuttingScene MakeCuttingScene(const SceneOptions& options, std::uint64_t index);

// One edge of a cuboid among nine random lines of it, seen by a camera whose optical axis has this
// angle (radians) to the edge: 0 parallel, pi/2 at right angles. The edge is the first line.
CuttingScene MakeEdgeScene(const SceneOptions& options, double angle, std::uint64_t index);

}  // namespace plumbline
