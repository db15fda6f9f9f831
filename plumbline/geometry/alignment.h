// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/sim3.h"

#include <array>
#include <span>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

namespace plumbline {

struct RotationFit {
  Eigen::Matrix3d rotation;
  // Singular values of the correlation, the largest first. The last one is negative if a reflection
  // fits better than any rotation. The rotation is determined only if the sum of the last two is
  // positive.
  Eigen::Vector3d singular_values;
};

// Returns the rotation R that best aligns vectors s_i with t_i, from their correlation sum w_i t_i
// s_i^T. It maximises trace(R^T correlation), and so minimises sum w_i |t_i - R s_i|^2.
//
// Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI
// 1991, eq. 40 and 43.
RotationFit FitRotation(const Eigen::Matrix3d& correlation);

enum class AlignmentFailure {
  kTooFewPoints,  // fewer than three points with a positive weight
  // All points of a set coincide: neither rotation nor scale is determined.
  kCoincident,
  // All points are on one line: the rotation about it is free.
  kCollinear,
};
constexpr auto EnumNames(std::type_identity<AlignmentFailure>) {
  return std::array{std::pair{AlignmentFailure::kTooFewPoints, "fewer than three poses"},
                    std::pair{AlignmentFailure::kCoincident, "all positions in one place"},
                    std::pair{AlignmentFailure::kCollinear, "all positions on a line"}};
}

struct Alignment {
  Similarity3 target_from_source;
  double rmse = 0;  // root mean square distance after alignment, metres
};

enum class AlignmentScale { kFixed, kFree };

// Returns the rigid motion (kFixed) or similarity (kFree) that minimises sum |target - S source|^2.
//
// Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI
// 1991, eq. 40-42.
//
//   source, target  corresponding points, same length
//   fails           degenerate sets. A set counts as collinear if its second standard deviation
//                   is below 1e-6 of its first: its rotation is then not determined
//   cost            O(n)
Expected<Alignment, AlignmentFailure> AlignPoints(std::span<const Eigen::Vector3d> source,
                                                  std::span<const Eigen::Vector3d> target,
                                                  AlignmentScale scale);

}  // namespace plumbline
