// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <exception>
#include <functional>

#include <fmt/core.h>

namespace plumbline::bench {

// Runs a benchmark. Returns the exit status of its program: 0, or 2 if `run` throws; the message is
// then printed to standard error after `name`.
inline int RunBench(const char* name, const std::function<void()>& run) {
  try {
    run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 2;
  }
  return 0;
}

}  // namespace plumbline::bench
