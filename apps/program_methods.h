// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/system_methods.h"

namespace plumbline {

// Returns the methods of this program: the product's, and those of the laboratory if it is built.
const SystemMethods& ProgramMethods();

}  // namespace plumbline
