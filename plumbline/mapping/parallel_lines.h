// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/map/map.h"

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// The direction of a line as far as it is known: a unit vector of either sense, and its covariance
// across the direction (rad^2).
struct LineDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// A direction that many lines share: unit vector of either sense, and its standard deviation in
// rad.
struct CommonDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double sigma = 0;
};

// Returns by how much parallel lines differ from their common direction, in rad per component: what
// is built, drawn and printed is not exactly parallel.
double ParallelSigma();

// Returns the direction of a line and the covariance that its information (Lambda, of the
// orthonormal tangent) gives it: J Lambda^-1 J^T with J = [u3, 0, -u1, 0] from eq. 19. Returns
// nullopt when Lambda is singular.
std::optional<LineDirection> DirectionOf(const PluckerLine& line,
                                         const Eigen::Matrix4d& information);

// Returns the directions that at least five of the lines known to 1 deg share, the most frequent
// first. Each starts at the line with most others within 2 deg. It becomes the mean, weighted with
// covariance and ParallelSigma(), of the lines that agree with it by chi2 at 95 %. Cost: each line
// is compared with those that have about the same component along one axis, at worst with all.
std::vector<CommonDirection> CommonDirections(const std::vector<LineDirection>& lines);

// Returns the common directions, in the world, of the lines of a map that at least three keyframes
// show. A map outlives the window of bundle adjustment, so that directions seen before hold the
// heading. In a map of more than 200 keyframes only lines that 200 keyframes, evenly spread over
// it, show are used, and in any map at most 1500 lines. Cost: that of CommonDirections of so many
// lines.
std::vector<CommonDirection> CommonDirections(const Map& map);

// Returns the index of the direction that a line is parallel to by chi2 at 95 %. Returns nullopt
// where none is, and where the test means little: several directions pass, or the line is known so
// badly that one direction in 200 would pass by chance.
std::optional<std::size_t> ParallelTo(const LineDirection& line,
                                      const std::vector<CommonDirection>& directions);

}  // namespace plumbline
