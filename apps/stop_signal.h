// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <optional>
#include <string>

namespace plumbline {

// From now on SIGINT, SIGTERM and SIGHUP do not end the program: they make StopRequested() true. A
// SIGHUP that is ignored (nohup) stays so.
void CatchStopSignals();
bool StopRequested();

// From now on writing to a pipe that nobody reads any more is an error, and does not end the
// program.
void IgnoreBrokenPipes();

// The first signal that came: "SIGINT" and the code of a program that it ended, 130; 143 for both
// SIGTERM and SIGHUP.
struct StopSignal {
  std::string name;
  int exit_code = 0;
};
std::optional<StopSignal> FirstStopSignal();

// For a step that comes after what a signal stopped: says stop when a signal comes during the step,
// and a second after this call when one had come before; with the second signal at once.
StopCheck StepStop();

}  // namespace plumbline
