// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <functional>

namespace plumbline::python {

// Does long work in a thread of its own, without the GIL, while the calling thread, which holds it,
// lets other Python threads run and checks for signals twenty times a second. At Ctrl-C the work is
// told to stop, and after its return KeyboardInterrupt is raised. Rethrows exceptions of the work.
// The work must not use Python. Cost: that of a thread.
void RunInterruptibly(const std::function<void(const StopCheck&)>& work);

}  // namespace plumbline::python
