// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/optimization/pose_graph.h"

#include <span>
#include <vector>

namespace plumbline {

// Returns the inconsistency of two loops by way of odometry: the squared Mahalanobis norm of the
// cycle candidate, query, other query, other candidate and back (Mangelson, Dominic, Eustice and
// Vasudevan, ICRA 2018, eq. 7). Returns 0 if odometry does not connect them, since nothing
// contradicts them then. Cost: two paths.
double CycleChi2(OdometryWays& odometry, const PoseGraphEdge& a, const PoseGraphEdge& b);

// Returns a largest set of mutually consistent members (a clique of the graph), ascending; of
// several such sets the first in the order of their members. consistent[i][j] must equal
// consistent[j][i].
//
//   cost  exponential at worst; some microseconds for 30 mostly consistent members
std::vector<int> LargestConsistentSet(const std::vector<std::vector<bool>>& consistent);

}  // namespace plumbline
