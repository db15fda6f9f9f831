// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace plumbline {

// A step of mapping and its wall-clock time.
struct MappingStep {
  std::string name;
  double milliseconds = 0;
};

// Runs a step, and adds its time under this name.
template <class Step>
void Timed(const char* name, std::vector<MappingStep>& times, const Step& step) {
  const auto start = std::chrono::steady_clock::now();
  step();
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  times.push_back({name, taken.count()});
}

}  // namespace plumbline
