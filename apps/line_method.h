// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/options.h"

namespace plumbline {

// Has lines done as the options say. Without the laboratory they stay with the method of the
// product, and CheckOptions refuses options that ask for another one.
void ChooseLineMethod(SlamOptions& options);

}  // namespace plumbline
