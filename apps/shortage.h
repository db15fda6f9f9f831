// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

namespace plumbline {

// Returns the resource that an exception reports as exhausted, for a sentence: "out of memory", "no
// further thread can be started"; null for any other.
const char* ShortageOf(const std::exception& error);

}  // namespace plumbline
