// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace plumbline {

// Returns true when work is to end now. Work that may take long asks it again and again, in the
// thread that does it. Once true it must stay true. An empty function never stops anything. A call
// should take no more than a microsecond.
using StopCheck = std::function<bool()>;

inline bool IsToStop(const StopCheck& stop) { return stop && stop(); }

}  // namespace plumbline
