// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/stop_check.h"

#include <optional>
#include <string>

namespace plumbline {

// Makes SIGINT, SIGTERM and SIGHUP set StopRequested() from now on instead of ending the program.
// An ignored SIGHUP (nohup) stays ignored.
void CatchStopSignals();
bool StopRequested();

// Makes writing to a closed pipe an error from now on, instead of ending the program.
void IgnoreBrokenPipes();

// The first signal received: "SIGINT" and the exit code of a program ended by it, 130; 143 for both
// SIGTERM and SIGHUP.
struct StopSignal {
  std::string name;
  int exit_code = 0;
};
std::optional<StopSignal> FirstStopSignal();

// Returns the stop check of a step after an interrupted one: it stops at a signal during the step;
// if one came before, a second after this call, and with the second signal at once.
StopCheck StepStop();

}  // namespace plumbline
