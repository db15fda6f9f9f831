// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <functional>

namespace plumbline::python {

// Does work that takes long in a thread of its own, without the GIL, while this one, which holds
// it, lets other Python threads run and asks for signals twenty times a second. With Ctrl-C the
// work is told to stop, and when it has come back KeyboardInterrupt is raised. Rethrows what the
// work throws. The work must not touch Python. Cost: that of a thread.
void RunInterruptibly(const std::function<void(const StopCheck&)>& work);

}  // namespace plumbline::python
