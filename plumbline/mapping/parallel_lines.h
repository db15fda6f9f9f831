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

// Direction of a line: a unit vector of either sense, and its covariance across the direction
// (rad^2).
struct LineDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// A direction shared by many lines: unit vector of either sense, and its standard deviation in rad.
struct CommonDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double sigma = 0;
};

// Returns the standard deviation of parallel lines from their common direction, in rad per
// component: built, drawn and printed lines are not exactly parallel.
double ParallelSigma();

// Returns the direction of a line and its covariance, given the line's information (Lambda, of the
// orthonormal tangent): J Lambda^-1 J^T with J = [u3, 0, -u1, 0] from eq. 19. Returns nullopt if
// Lambda is singular.
std::optional<LineDirection> DirectionOf(const PluckerLine& line,
                                         const Eigen::Matrix4d& information);

// Returns the directions shared by at least five of the lines known to 1 deg, the most frequent
// first. Each starts at the line with most others within 2 deg. It becomes the mean, weighted with
// covariance and ParallelSigma(), of the lines consistent with it by chi2 at 95 %. Cost: each line
// is compared with those that have about the same component along one axis, at worst with all.
std::vector<CommonDirection> CommonDirections(const std::vector<LineDirection>& lines);

// Returns the common directions, in the world, of the lines of a map observed by at least three
// keyframes. A map outlives the window of bundle adjustment, so that earlier directions stabilize
// the heading. In a map of more than 200 keyframes only lines of 200 keyframes, evenly spread over
// it, are used, and in any map at most 1500 lines. Cost: that of CommonDirections for these lines.
std::vector<CommonDirection> CommonDirections(const Map& map);

// Returns the index of the direction to which a line is parallel by chi2 at 95 %. Returns nullopt
// if none passes, if several pass, or if the line is so uncertain that one direction in 200 would
// pass by chance.
std::optional<std::size_t> ParallelTo(const LineDirection& line,
                                      const std::vector<CommonDirection>& directions);

}  // namespace plumbline
