// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system_methods.h"

namespace plumbline {

// Returns the product's methods and those of the laboratory, for System and whoever reads options:
//   initialization.method   rank1_klt, two_view, two_view_images
//   lines.residual, lines.reconstruction   those of AddedLineMethods; projected_ends with a map,
//   too cutting.method          greedy_sweeps, joint, drop, best_80, best_80_greedy
const SystemMethods& LaboratoryMethods();

}  // namespace plumbline
