// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/options.h"

namespace plumbline {

// Sets the line method by the options. Without the laboratory the product's own method is used, and
// CheckOptions refuses options that request another one.
void ChooseLineMethod(SlamOptions& options);

}  // namespace plumbline
