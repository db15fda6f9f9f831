// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace plumbline {

// Returns true if work must end now. Long work calls it repeatedly, in its own thread. Once true it
// must stay true. An empty function never stops anything. A call should take at most a microsecond.
using StopCheck = std::function<bool()>;

inline bool IsToStop(const StopCheck& stop) { return stop && stop(); }

}  // namespace plumbline
