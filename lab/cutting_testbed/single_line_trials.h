// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/scene.h"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// Starts of the gradient ascents of a single line.
enum class AscentStarts {
  kFull,   // (0, 1) alone
  kPaper,  // (0, 1), (0, 0), (1, 1)
  kThree,  // those of CutSingleLine
};
constexpr auto EnumNames(std::type_identity<AscentStarts>) {
  return std::array{std::pair{AscentStarts::kFull, "full_length"},
                    std::pair{AscentStarts::kPaper, "exact_ends"},
                    std::pair{AscentStarts::kThree, "three_starts"}};
}

// Gradient ascent against brute force, for one line while the others keep their full length.
struct SingleLineTrial {
  Eigen::Vector2d grid, ascent;  // ratios, lesser first
  double shortfall = 0;          // log det of the grid's best minus that of the ascent's

  bool RatiosAgree() const { return (grid - ascent).lpNorm<Eigen::Infinity>() <= 0.01 + 1e-9; }
  // Returns true also if the surface is so flat that the difference is irrelevant, or the grid is
  // too coarse to be better.
  bool Agrees() const { return RatiosAgree() || shortfall <= 1e-3; }
};

inline constexpr int kGridSteps = 100;

// For the first `max_lines` lines of a scene; independent information takes some 0.2 ms each,
// printed 20 ms.
std::vector<SingleLineTrial> TrySingleLines(const CuttingScene& scene,
                                            CuttingInformation information,
                                            AscentStarts starts,
                                            std::size_t max_lines);

// An example for a figure of the surface.
struct SurfaceExample {
  Eigen::MatrixXd surface;  // as of SurfaceOf
  Eigen::Vector2d best;     // ratios of the greatest value
};
enum class SurfaceShape { kFullLength, kPiece, kPoint };
// Returns the first scene of these options with a line whose best cut has this shape: both ends
// kept, a piece (first end kept, second between 0.5 and 0.9), a point.
SurfaceExample FindSurface(const SceneOptions& options, SurfaceShape shape);

}  // namespace plumbline
