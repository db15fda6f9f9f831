// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace plumbline {

// Asked again and again by what may take long, in whatever thread that runs; true: end now. Once
// true it stays true. An empty one never stops anything. A call should take no more than a
// microsecond.
using StopCheck = std::function<bool()>;

inline bool IsToStop(const StopCheck& stop) { return stop && stop(); }

}  // namespace plumbline
