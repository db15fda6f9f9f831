// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/joint_optimizers.h"
#include "lab/cutting_testbed/scene.h"

#include <cstdint>
#include <limits>
#include <map>

namespace plumbline {

struct JointOutcome {
  double log_determinant = 0;
  double microseconds = 0;  // wall time
};

// All optimizers on one scene, and the best known value: the best of theirs, of ascents from the
// result of greedy_sweeps, and of ascents from eight random starts.
struct JointTrial {
  std::map<JointOptimizer, JointOutcome> outcomes;
  double best = -std::numeric_limits<double>::infinity();
};
JointTrial TryJointly(const CuttingScene& scene,
                      CuttingInformation information,
                      std::uint64_t index);

}  // namespace plumbline
