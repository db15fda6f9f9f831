// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// From now on SIGINT and SIGTERM do not end the program: they make StopRequested() true.
void CatchStopSignals();
bool StopRequested();

}  // namespace plumbline
