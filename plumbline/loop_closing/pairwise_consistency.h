// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/loop_closing/essential_graph.h"
#include "plumbline/optimization/pose_graph.h"

#include <span>
#include <vector>

namespace plumbline {

// Returns how far two loops are from agreeing with each other by way of odometry: the squared
// Mahalanobis norm of the cycle candidate, query, other query, other candidate and back (Mangelson,
// Dominic, Eustice and Vasudevan, ICRA 2018, eq. 7). Returns 0 where odometry does not tie them,
// since nothing contradicts the two then. Cost: two ways.
double CycleChi2(OdometryWays& odometry, const PoseGraphEdge& a, const PoseGraphEdge& b);

// Returns a largest set whose members are all consistent with each other (a clique of the graph),
// ascending; of several such sets the first in the order of their members. consistent[i][j] must
// equal consistent[j][i].
//
//   cost  exponential at worst; some microseconds for 30 members of which most agree
std::vector<int> LargestConsistentSet(const std::vector<std::vector<bool>>& consistent);

}  // namespace plumbline
