// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bench {

// Prints the matching precision of our LBD and of OpenCV's on the same lines.
void PrintDescriptorPrecision(const std::string& data);

}  // namespace plumbline::bench
