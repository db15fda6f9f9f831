// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
// Gates on sequences that are played backwards, which the laboratory writes.
#include "lab/experiments/reversed_sequence.h"

#include "tests/e2e/gate_run.h"

namespace plumbline {
namespace {

TEST(Accuracy, MachineHallFastBackwardsStereo) {
  Gate gate = kMachineHallFastBack;
  const auto data = FindData(gate.sequence);
  if (!data) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
  const ScratchFolder folder;
  const std::filesystem::path backwards = folder / "backwards";
  WriteReversedSequence(*data, backwards);
  const std::string settings =
      std::string(gate.settings) + " --ground-truth " + Quoted(backwards / kReversedTruth);
  gate.settings = settings.c_str();
  CheckGate(gate, backwards);
}

}  // namespace
}  // namespace plumbline
